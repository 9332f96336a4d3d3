#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_rans.h"
#include "codec/fast_vector.h"

namespace ramcdb::codec {

inline constexpr std::uint32_t kDirectTokens = 32;
inline constexpr std::uint32_t kWideToken = 60;
inline constexpr std::uint32_t kTokens = 61;

/// Distribution number s > 0 is that of numbers with a mean magnitude of 2^((s-1)/2) / 8, about; 0: smaller ones.
inline constexpr std::uint32_t kScales = 35;
[[nodiscard]] const std::array<RansTable, kScales>& scale_tables();

/// 2 log2(x), rounded down to where x has its second highest bit, for 0 < x < 2^24: exponent and first fraction bit of
/// a float, which holds such numbers exactly.
[[nodiscard]] RAMCDB_INLINE std::int32_t half_octave(std::int32_t x) {
  const auto number = static_cast<float>(x);
  return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(number) >> 22) - 2 * 127;
}

/// The middle of what half_octave() maps to `number`, in 1/4.
[[nodiscard]] inline std::uint32_t quarters_of(std::uint32_t number) { return (5 + 2 * (number % 2)) << number / 2; }

/// Which distribution each number is coded with, for encoder and decoder alike.
///
/// A number's context is how large the numbers of the same coordinate were at the pivot and the vertices before and
/// behind it, together, and how many parallelograms its prediction had. A context keeps a running mean of magnitudes.
class FastScales {
 public:
  /// \param typical the distribution of all of the chart's numbers: what border vertices pass for
  FastScales(std::uint32_t border, std::uint32_t inner, std::uint32_t typical) : sizes_(std::size_t{border} + inner) {
    const std::uint32_t mean = typical == 0 ? 0 : quarters_of(typical - 1) / 32;
    const std::int32_t size = std::min(static_cast<std::int32_t>(mean), kMostSize);
    std::fill_n(sizes_.begin(), border, Int4{} + size);
    for (int trust = 0; trust < kTrusts; ++trust)
      for (int sum = 0; sum < kSums; ++sum) {
        const std::uint32_t expected =
            trust == kFastFree ? 4 * mean : (quarters_of(static_cast<std::uint32_t>(sum)) - 4) / 6;
        means_[at(trust * kSums + sum)] = std::max(kUnit / 4 * static_cast<std::int32_t>(expected), kUnit / 16);
      }
  }

  /// Contexts of the three numbers of a vertex.
  [[nodiscard]] RAMCDB_INLINE Int4 contexts(const FastPlace& place) const {
    const Int4 sum = sizes_[place.pivot] + sizes_[place.around[0]] + sizes_[place.around[1]];
    const Int4 half_octaves = std::bit_cast<Int4>(__builtin_convertvector(2 * sum + 1, Float4)) >> 22;
    return half_octaves + (place.trust * kSums - 2 * 127);
  }

  [[nodiscard]] RAMCDB_INLINE std::uint32_t scale(std::int32_t context) const {
    return static_cast<std::uint32_t>(std::max(0, half_octave(means_[at(context)]) - kLowest));
  }

  /// \param zigzag the three numbers with their signs in the lowest bits
  RAMCDB_INLINE void learn(std::uint32_t vertex, Int4 contexts, Unsigned4 zigzag) {
    const Int4 halves = std::bit_cast<Int4>((zigzag >> 1) + (zigzag & 1));
    const Int4 sizes = halves < 0 || halves > kMostSize ? Int4{} + kMostSize : halves;
    sizes_[vertex] = sizes;
    for (int a = 0; a < 3; ++a) {
      std::int32_t& mean = means_[at(contexts[a])];
      mean += (kUnit * sizes[a] - mean) >> kRate;
    }
  }

 private:
  static constexpr std::int32_t kMostSize = 0x3fff;
  static constexpr int kTrusts = 5;
  static constexpr std::int32_t kSums = 36;  ///< half-octaves of twice a sum of three sizes, plus one
  static constexpr std::int32_t kUnit = 1024;
  static constexpr int kLowest = 13;  ///< one less than half_octave(kUnit / 8)
  static constexpr int kRate = 5;
  static std::size_t at(std::int32_t context) { return static_cast<std::size_t>(context); }

  std::vector<Int4> sizes_;  ///< per vertex: magnitudes of its numbers, up to kMostSize
  std::array<std::int32_t, kTrusts * kSums> means_{};
};

}  // namespace ramcdb::codec
