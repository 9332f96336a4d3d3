#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "codec/octahedron.h"
#include "codec/range_coder.h"

/// Numbers of a layer's component: arithmetic modulo 2^bits, prediction, and the models of what prediction misses.
namespace ramcdb::codec {

/// Whole numbers modulo 2^bits, 1 <= bits <= 64.
class Ring {
 public:
  explicit Ring(unsigned bits) : bits_(bits), mask_(~std::uint64_t{0} >> (64 - bits)) {}

  [[nodiscard]] std::uint64_t wrap(std::uint64_t x) const { return x & mask_; }
  /// The least way from b to a, of two the negative one.
  [[nodiscard]] std::int64_t difference(std::uint64_t a, std::uint64_t b) const {
    return static_cast<std::int64_t>((a - b) << (64 - bits_)) >> (64 - bits_);
  }

 private:
  unsigned bits_;
  std::uint64_t mask_;
};

[[nodiscard]] inline std::uint64_t magnitude(std::int64_t x) {
  return x < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
}

/// A direction from the two numbers that stand for it.
[[nodiscard]] inline OctahedronPoint direction_of(std::uint64_t u, std::uint64_t v, const Ring& ring) {
  return {static_cast<std::int32_t>(ring.difference(u, 0)), static_cast<std::int32_t>(ring.difference(v, 0))};
}

/// A miss, a signed number of up to 64 bits: the bit width of its magnitude in unary, its sign, the second and third
/// highest bit of the magnitude modelled, the rest raw.
class MissNumber {
 public:
  MissNumber() {
    for (std::size_t c = 0; c < kContexts; ++c)
      for (std::size_t j = 0; j < kWidths; ++j) {
        static constexpr std::array<std::uint16_t, 9> kMore{64000, 63000, 61000, 56000, 45000,
                                                            30000, 15000, 7000,  3000};
        const auto from_expected = static_cast<int>(j) - static_cast<int>(c);
        width_[c][j] = AdaptiveBit(kMore[static_cast<std::size_t>(std::clamp(from_expected, -4, 4) + 4)], 4);
      }
  }

  /// \param expected the bit width that the miss is likely to have
  template <class Coder>
  std::int64_t code(Coder& coder, unsigned expected, std::int64_t miss = 0) {
    const std::uint64_t size = magnitude(miss);
    const unsigned actual = static_cast<unsigned>(std::bit_width(size));
    // Beyond what contexts tell apart, widths count from the expected one.
    const unsigned far = expected < kContexts ? 0 : expected - static_cast<unsigned>(kContexts) + 1;
    auto& width_bits = width_[std::min<std::size_t>(expected, kContexts - 1)];
    unsigned width = 0;
    while (width < 64) {
      const unsigned at = width < far ? 0 : std::min<unsigned>(width - far, kWidths - 1);
      if (!coder.code(width_bits[at], actual > width)) break;
      ++width;
    }
    if (width == 0) return 0;
    const bool negative = coder.code(negative_, miss < 0);
    std::uint64_t x = 1;
    unsigned left = width - 1;
    const std::size_t row = std::min<std::size_t>(width, kWidths - 1);
    for (int top = 0; top < 2 && left > 0; ++top) x = 2 * x + coder.code(high_[row][x & 3], (size >> --left) & 1);
    for (; left > 16; left -= 16)
      x = x << 16 | coder.code_raw(static_cast<std::uint32_t>((size >> (left - 16)) & 0xffff), 16);
    const auto low = static_cast<std::uint32_t>(size & ((std::uint64_t{1} << left) - 1));
    x = x << left | coder.code_raw(low, static_cast<int>(left));
    return static_cast<std::int64_t>(negative ? std::uint64_t{0} - x : x);
  }

 private:
  static constexpr std::size_t kContexts = 16, kWidths = 33;
  std::array<std::array<AdaptiveBit, kWidths>, kContexts> width_;
  std::array<std::array<AdaptiveBit, 4>, kWidths> high_;
  AdaptiveBit negative_;
};

/// Which of several predictors did best lately: by misses that fade.
template <std::size_t N>
class BestOf {
 public:
  [[nodiscard]] std::size_t best() const {
    return static_cast<std::size_t>(std::min_element(misses_.begin(), misses_.end()) - misses_.begin());
  }
  void learn(std::size_t predictor, std::uint64_t size) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 56;
    std::uint64_t& m = misses_[predictor];
    m = m - m / 16 + std::min(size, kMost);
  }

 private:
  std::array<std::uint64_t, N> misses_{};
};

}  // namespace ramcdb::codec
