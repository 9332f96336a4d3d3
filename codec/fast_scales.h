#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/fast_rans.h"

/// The distributions that misses are coded with, from narrow to wide, and which one a miss has.
///
/// A miss becomes a token and, if it is large, raw bits (fast_residuals.h). Which distribution its token has depends on
/// the sum of three tokens, those of the same coordinate at the vertices that the new one is fixed to.
namespace ramcdb::codec {

inline constexpr std::uint32_t kDirectTokens = 32;
inline constexpr std::uint32_t kWideToken = 60;
inline constexpr std::uint32_t kTokens = 61;

/// Distribution number s > 0 is that of numbers with a mean magnitude of 2^((s-1)/2) / 8, about; 0: smaller ones.
inline constexpr std::uint32_t kScales = 35;
[[nodiscard]] const std::array<RansTable, kScales>& scale_tables();

/// 2 log2(x), rounded down to where x has its second highest bit. REQUIRES: x > 1
[[nodiscard]] constexpr std::uint32_t half_octave(std::uint32_t x) {
  const auto top = static_cast<std::uint32_t>(std::bit_width(x)) - 1;
  return 2 * top + (x >> (top - 1) & 1);
}

/// The middle of what half_octave() maps to `number`, in 1/4.
[[nodiscard]] inline std::uint32_t quarters_of(std::uint32_t number) { return (5 + 2 * (number % 2)) << number / 2; }

/// The class of a sum of three tokens. Tokens are numbers up to 31, and above about logarithms.
[[nodiscard]] constexpr std::uint32_t miss_class(std::uint32_t sum) {
  if (sum < 8) return sum;
  if (sum < 64) return half_octave(sum) + 2;
  return std::min(14 + (sum - 64) / 4, 43u);
}

}  // namespace ramcdb::codec
