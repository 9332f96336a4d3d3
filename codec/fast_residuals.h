#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_scales.h"
#include "codec/fast_tables.h"
#include "codec/raw_array.h"
#include "codec/raw_bits.h"
#include "codec/varint.h"
#include "codec/vectors.h"
#include "ramcdb/bytes.h"

/// How far predictions missed, three numbers per inner vertex with neighbours, as bytes.
///
///   residuals = [typical:1 state:4 state:4 state:4 word* raw bits]     nothing for no inner vertices
///   typical   = a usual token of the chart: what vertices pass for whose misses are not known
///   number    = token [raw bits]                                       signs in the lowest bit: 0, -1, 1, -2, 2 ...
///
/// Tokens below kDirectTokens are the number; above, two tokens share each octave, and raw bits tell the rest; the last
/// token says that kWideSize raw bits with the size of the number follow, and the number. Which distribution a token
/// has: see fast_scales.h. Each coordinate has a state of its own; the three take their words from one stream,
/// forwards. The raw bits begin with the highest bit of the last byte and run backwards until they meet the words.
namespace ramcdb::codec {

/// The fourth number is 0.
using FastResidual = Int4;

inline constexpr std::size_t kResidualStates = 3;
inline constexpr int kWideSize = 6;  ///< raw bits that tell the size of a wide number

/// What a token below kWideToken stands for: the least number, and how many raw bits are added to it.
struct TokenRange {
  std::uint32_t base = 0;
  std::uint32_t bits = 0;
};

inline constexpr auto kTokenRanges = [] {
  std::array<TokenRange, RansTable::kMostSymbols> ranges{};
  for (std::uint32_t token = 0; token < kWideToken; ++token) {
    const std::uint32_t half = token < kDirectTokens ? 0 : token - kDirectTokens;
    ranges[token] =
        token < kDirectTokens ? TokenRange{token, 0} : TokenRange{(2 + half % 2) << (4 + half / 2), 4 + half / 2};
  }
  return ranges;
}();

[[nodiscard]] inline std::uint32_t token_of(std::uint32_t number) {
  if (number < kDirectTokens) return number;
  return std::min(kDirectTokens + half_octave(number) - 10, kWideToken);
}

[[nodiscard]] inline std::uint32_t zigzag(std::int32_t value) {
  return static_cast<std::uint32_t>(value << 1 ^ value >> 31);
}

/// A usual token of these misses, by the mean of their sizes.
[[nodiscard]] std::uint8_t typical_token(std::span<const FastResidual> residuals);

/// The tokens of a vertex are three bytes of a number. For each coordinate the sum at the three vertices that a place
/// is fixed to.
[[nodiscard]] RAMCDB_INLINE std::uint32_t near_sums(const FastPlace& place, const std::uint32_t* tokens) {
  return tokens[place.pivot] + tokens[place.around[1]] + tokens[place.around[0]];  // the newest last
}
[[nodiscard]] inline std::uint32_t spread_token(std::uint8_t token) { return token * 0x010101u; }

/// The numbers of all places but free ones, as bytes.
[[nodiscard]] Buffer encode_residuals(const FastPlan& plan, std::uint32_t border,
                                      std::span<const FastResidual> residuals, const MissTables& tables);

/// A residual stream whose tokens were taken; raw bits are left, since nothing waits for them.
struct ResidualTokens {
  RawArray<std::uint32_t> of_vertex;  ///< three bytes each; border first
  RawBitReader raw;
  std::size_t raw_size = 0;  ///< bytes of all raw bits
};

/// Throws corrupt when `bytes` cannot be of such a plan.
[[nodiscard]] ResidualTokens decode_tokens(Bytes bytes, const FastPlan& plan, std::uint32_t border,
                                           const MissTables& tables);

/// Throws corrupt unless all raw bits were taken as an encoder leaves them.
void finish_raw_bits(ResidualTokens& tokens);

/// The three numbers of these tokens when one of them is wide.
[[nodiscard]] Unsigned4 wide_numbers(RawBitReader& raw, std::uint32_t tokens);

/// The three numbers of these tokens.
[[nodiscard]] RAMCDB_INLINE Unsigned4 take_numbers(RawBitReader& raw, std::uint32_t tokens) {
  const std::uint32_t x = tokens & 0xff, y = tokens >> 8 & 0xff, z = tokens >> 16;
  if (((x | y | z) & kDirectTokens) == 0) return Unsigned4{x, y, z, 0};
  if (x == kWideToken || y == kWideToken || z == kWideToken) [[unlikely]] {
    RawBitReader copy = raw;  // so that the other one may live in registers
    const Unsigned4 numbers = wide_numbers(copy, tokens);
    raw = copy;
    return numbers;
  }
  const TokenRange rx = kTokenRanges[x], ry = kTokenRanges[y], rz = kTokenRanges[z];
  const std::uint64_t window = raw.window();  // three numbers need 51 bits at most
  raw.skip(rx.bits + ry.bits + rz.bits);
  return Unsigned4{rx.base + RawBitReader::top(window, rx.bits),
                   ry.base + RawBitReader::top(window << rx.bits, ry.bits),
                   rz.base + RawBitReader::top(window << rx.bits << ry.bits, rz.bits), 0};
}

}  // namespace ramcdb::codec
