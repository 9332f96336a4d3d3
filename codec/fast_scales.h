#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_rans.h"

namespace ramcdb::codec {

inline constexpr std::uint32_t kDirectTokens = 32;
inline constexpr std::uint32_t kWideToken = 60;
inline constexpr std::uint32_t kTokens = 61;

/// Distribution number s is that of numbers with a mean magnitude of 2^(s/2 - 3), about.
inline constexpr std::uint32_t kScales = 44;
[[nodiscard]] const std::array<RansTable, kScales>& scale_tables();

/// 2 log2(x) + 1 rounded down to where x has its second highest bit; 0 for 0.
[[nodiscard]] inline std::uint32_t half_octave(std::uint32_t x) {
  if (x == 0) return 0;
  const auto top = static_cast<std::uint32_t>(std::bit_width(x)) - 1;
  return 2 * top + (top > 0 ? x >> (top - 1) & 1 : 0) + 1;
}

/// Which distribution each number is coded with, for encoder and decoder alike.
class FastScales {
 public:
  static constexpr std::uint32_t kBlock = 64;

  /// \param mean half-octave of the chart's mean magnitude in 1/8, what border vertices pass for
  FastScales(std::uint32_t border, std::uint32_t inner, std::uint32_t mean) {
    const std::uint32_t typical = mean == 0 ? 0 : magnitude_of(mean);
    sizes_.resize(std::size_t{border} + inner);
    std::fill_n(sizes_.begin(), border, Sizes{size_of(typical), size_of(typical), size_of(typical)});
    contexts_.resize(5 * kSizes);
    for (std::uint32_t trust = 0; trust < 5; ++trust)
      for (std::uint32_t size = 0; size < kSizes; ++size) {
        Context& context = contexts_[trust * kSizes + size];
        // Sums of sizes are 48 times the mean magnitude.
        const std::uint64_t expected = trust == kFastFree ? typical : size == 0 ? 0 : magnitude_of(size) / 6;
        context.sum = static_cast<std::uint32_t>(expected * kPrior);
        context.count = kPrior;
        renew(context);
      }
  }

  /// Contexts of the three numbers of a vertex.
  [[nodiscard]] std::array<std::uint16_t, 3> contexts(const FastPlace& place) const {
    const Sizes &v = sizes_[place.pivot], &p = sizes_[place.around[0]], &n = sizes_[place.around[1]],
                &c = sizes_[place.around[2]];
    std::array<std::uint16_t, 3> numbers{};
    std::array<std::uint32_t, 3> sums{};
    for (std::size_t a = 0; a < 3; ++a) sums[a] = 2u * (v[a] + p[a]) + n[a] + c[a];
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t sum = 6 * sums[a] + sums[0] + sums[1] + sums[2] - sums[a];
      numbers[a] = static_cast<std::uint16_t>(place.trust * kSizes + half_octave(sum));
    }
    return numbers;
  }

  [[nodiscard]] std::uint32_t scale(std::uint16_t context) const { return contexts_[context].scale; }

  void learn(std::uint32_t vertex, const std::array<std::uint16_t, 3>& contexts,
             const std::array<std::int32_t, 3>& residual) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto magnitude = static_cast<std::uint32_t>(std::abs(std::int64_t{residual[a]}));
      sizes_[vertex][a] = size_of(magnitude);
      Context& context = contexts_[contexts[a]];
      context.sum += 8 * sizes_[vertex][a];
      ++context.count;
    }
  }

  /// After every kBlock vertices.
  void renew_all() {
    for (Context& context : contexts_)
      if (context.count != context.known) renew(context);
  }

 private:
  /// Half-octaves that a context's sum of sizes can have: sums stay below 48 * 2^16.
  static constexpr std::uint32_t kSizes = 48;
  static constexpr std::uint32_t kPrior = 4;
  using Sizes = std::array<std::uint16_t, 4>;

  struct Context {
    std::uint32_t sum = 0;  ///< of magnitudes, in 1/8
    std::uint32_t count = 0;
    std::uint32_t known = 0;  ///< count when the scale was chosen
    std::uint32_t scale = 0;
  };

  static std::uint16_t size_of(std::uint32_t magnitude) {
    return static_cast<std::uint16_t>(std::min(magnitude, 0xffffu));
  }
  /// The middle of what half_octave() maps to `number` > 0.
  static std::uint32_t magnitude_of(std::uint32_t number) {
    const std::uint32_t top = (number - 1) / 2;
    return static_cast<std::uint32_t>((std::uint64_t{5} + 2 * ((number - 1) % 2)) << top >> 2);
  }

  static void renew(Context& context) {
    const std::uint32_t mean = context.sum / context.count;
    context.scale = std::min(half_octave(mean), kScales - 1);
    if (context.count >= 256) {
      context.sum /= 2;
      context.count /= 2;
    }
    context.known = context.count;
  }

  std::vector<Sizes> sizes_;  ///< per vertex: magnitudes of its numbers, up to 65535
  std::vector<Context> contexts_;
};

}  // namespace ramcdb::codec
