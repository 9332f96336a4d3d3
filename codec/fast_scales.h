#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_rans.h"

namespace ramcdb::codec {

inline constexpr std::uint32_t kDirectTokens = 32;
inline constexpr std::uint32_t kWideToken = 60;
inline constexpr std::uint32_t kTokens = 61;

/// Distribution number s > 0 is that of numbers with a mean magnitude of 2^((s-1)/2) / 8, about; 0: smaller ones.
inline constexpr std::uint32_t kScales = 40;
[[nodiscard]] const std::array<RansTable, kScales>& scale_tables();

/// 2 log2(x) + 1, rounded down to where x has its second highest bit; 0 for 0.
[[nodiscard]] inline std::uint32_t half_octave(std::uint32_t x) {
  const auto top = static_cast<std::uint32_t>(std::bit_width(x | 1)) - 1;
  return x == 0 ? 0 : 2 * top + 1 + (2 * x >> top & 1);
}

/// The middle of what half_octave() maps to `number`, in 1/4.
[[nodiscard]] inline std::uint32_t quarters_of(std::uint32_t number) {
  return number == 0 ? 0 : (5 + 2 * ((number - 1) % 2)) << (number - 1) / 2;
}

/// Which distribution each number is coded with, for encoder and decoder alike.
///
/// A number's context is how large the numbers of the same coordinate were at the pivot and the vertices before and
/// behind it, together, and how many parallelograms its prediction had. A context keeps a running mean of magnitudes.
class FastScales {
 public:
  /// \param typical half-octave of eight times the chart's mean magnitude: what border vertices pass for
  FastScales(std::uint32_t border, std::uint32_t inner, std::uint32_t typical) : sizes_(std::size_t{border} + inner) {
    const std::uint32_t mean = quarters_of(typical) / 32;
    const auto size = static_cast<std::uint16_t>(std::min(mean, kMostSize));
    std::fill_n(sizes_.begin(), border, Sizes{size, size, size, 0});
    for (std::uint32_t trust = 0; trust < kTrusts; ++trust)
      for (std::uint32_t sum = 0; sum < kSums; ++sum) {
        const std::uint32_t expected = trust == kFastFree ? kUnit * mean : kUnit / 4 * quarters_of(sum) / 3;
        means_[trust * kSums + sum] = std::max(expected, kUnit / 16);
      }
  }

  /// Contexts of the three numbers of a vertex.
  [[nodiscard]] std::array<std::uint32_t, 3> contexts(const FastPlace& place) const {
    const Sizes &v = sizes_[place.pivot], &p = sizes_[place.around[0]], &n = sizes_[place.around[1]];
    std::array<std::uint32_t, 3> numbers{};
    for (std::size_t a = 0; a < 3; ++a)
      numbers[a] = place.trust * kSums + half_octave(std::uint32_t{v[a]} + p[a] + n[a]);
    return numbers;
  }

  [[nodiscard]] std::uint32_t scale(std::uint32_t context) const { return half_octave(means_[context] / (kUnit / 8)); }

  void learn(std::uint32_t vertex, const std::array<std::uint32_t, 3>& contexts,
             const std::array<std::int32_t, 3>& numbers) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto bits = static_cast<std::uint32_t>(numbers[a]);
      const std::uint32_t size = std::min(numbers[a] < 0 ? 0 - bits : bits, kMostSize);
      sizes_[vertex][a] = static_cast<std::uint16_t>(size);
      std::uint32_t& mean = means_[contexts[a]];
      mean = static_cast<std::uint32_t>(
          static_cast<std::int32_t>(mean) +
          ((static_cast<std::int32_t>(kUnit * size) - static_cast<std::int32_t>(mean)) >> kRate));
    }
  }

 private:
  static constexpr std::uint32_t kMostSize = 0xffff;
  static constexpr std::uint32_t kTrusts = 5;
  static constexpr std::uint32_t kSums = 40;  ///< half-octaves of a sum of three sizes
  static constexpr std::uint32_t kUnit = 1024;
  static constexpr int kRate = 5;
  using Sizes = std::array<std::uint16_t, 4>;

  std::vector<Sizes> sizes_;  ///< per vertex: magnitudes of its numbers, up to kMostSize
  std::array<std::uint32_t, kTrusts * kSums> means_{};
};

}  // namespace ramcdb::codec
