#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ramcdb::chartify {

/// J. Skilling, "Programming the Hilbert curve" (2004), as a machine that takes one bit of each coordinate a step, from
/// the highest on. What he does to all lower bits at once - turning the axes, and the Gray code - is its state.
class HilbertMachine {
 public:
  struct Step {
    std::uint8_t digit;  ///< the next three bits of the key
    std::uint8_t next;   ///< the state behind it
  };

  constexpr HilbertMachine() {
    std::array<State, kMostStates> states{};
    std::size_t known = 1;
    for (std::size_t s = 0; s < known; ++s)
      for (std::uint32_t bits = 0; bits < 8; ++bits) {
        State state = states[s];
        const std::uint8_t digit = state.take(bits);
        const auto same = std::find(states.begin(), states.begin() + known, state);
        if (same == states.begin() + known) states[known++] = state;
        steps_[s][bits] = {digit, static_cast<std::uint8_t>(same - states.begin())};
      }
  }

  /// \param bits of x, y and z, x's the highest
  [[nodiscard]] constexpr Step step(std::uint8_t state, std::uint32_t bits) const { return steps_[state][bits]; }

 private:
  static constexpr std::size_t kMostStates = 96;  // signed turns of the axes, and a bit

  struct State {
    std::array<std::uint8_t, 3> axis{0, 1, 2};  ///< that coordinate i is by now
    std::array<bool, 3> flipped{};
    bool odd = false;  ///< the Gray code so far

    constexpr std::uint8_t take(std::uint32_t bits) {
      std::array<bool, 3> set{};
      for (std::size_t i = 0; i < 3; ++i) set[i] = ((bits >> (2 - axis[i]) & 1) != 0) != flipped[i];
      for (std::size_t i = 0; i < 3; ++i) {
        if (set[i]) {
          flipped[0] = !flipped[0];
        } else {
          std::swap(axis[0], axis[i]);
          std::swap(flipped[0], flipped[i]);
        }
      }
      std::uint32_t digit = 0;
      bool gray = false;
      for (const bool bit : set) {
        gray = gray != bit;
        digit = digit << 1 | (gray != odd ? 1U : 0U);
      }
      odd = odd != gray;
      return static_cast<std::uint8_t>(digit);
    }
    constexpr bool operator==(const State&) const = default;
  };

  std::array<std::array<Step, 8>, kMostStates> steps_{};
};

/// Position along a Hilbert curve through a cube of 2^bits cells a side; 1 <= bits <= 21.
inline std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& x, int bits) {
  static constexpr HilbertMachine kMachine;
  std::uint64_t key = 0;
  std::uint8_t state = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const HilbertMachine::Step step =
        kMachine.step(state, (x[0] >> bit & 1) << 2 | (x[1] >> bit & 1) << 1 | (x[2] >> bit & 1));
    key = key << 3 | step.digit;
    state = step.next;
  }
  return key;
}

}  // namespace ramcdb::chartify
