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
#include "codec/fast_vector.h"
#include "codec/raw_bits.h"
#include "codec/varint.h"
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

/// The tokens of each vertex, in a byte each: what those that are fixed to it look at.
class NearTokens {
 public:
  NearTokens(std::uint32_t border, std::size_t inner, std::uint8_t typical)
      : tokens_(border + inner, typical * 0x010101u) {}

  /// For each coordinate the sum at the three vertices around a place.
  [[nodiscard]] RAMCDB_INLINE std::uint32_t sums(const FastPlace& place) const {
    return tokens_[place.pivot] + tokens_[place.around[0]] + tokens_[place.around[1]];
  }
  RAMCDB_INLINE void set(std::size_t vertex, std::uint32_t tokens) { tokens_[vertex] = tokens; }

 private:
  std::vector<std::uint32_t> tokens_;
};

/// The numbers of all places but free ones, as bytes.
[[nodiscard]] Buffer encode_residuals(const FastPlan& plan, std::uint32_t border,
                                      std::span<const FastResidual> residuals, const MissTables& tables);

/// Takes them from a stream, in the same order.
class ResidualReader {
 public:
  /// Throws corrupt when `bytes` cannot be of a plan.
  ResidualReader(Bytes bytes, const FastPlan& plan, std::uint32_t border, const MissTables& tables);

  /// The three numbers of vertex number `vertex`, which has this place.
  [[nodiscard]] RAMCDB_INLINE FastResidual take(const FastPlace& place, std::size_t vertex) {
    const std::uint32_t sums = near_.sums(place);
    const std::array<const RansTable*, kResidualStates> tables{(*tables_)[sums & 0xff], (*tables_)[sums >> 8 & 0xff],
                                                               (*tables_)[sums >> 16 & 0xff]};
    std::array<std::uint32_t, kResidualStates> tokens;
    if (words_.has(kResidualStates)) [[likely]]
      for (std::size_t a = 0; a < kResidualStates; ++a) tokens[a] = states_[a].pop_sure(*tables[a], words_);
    else
      for (std::size_t a = 0; a < kResidualStates; ++a) tokens[a] = states_[a].pop(*tables[a], words_);
    near_.set(vertex, tokens[0] | tokens[1] << 8 | tokens[2] << 16);
    const bool all_direct = (tokens[0] | tokens[1] | tokens[2]) < kDirectTokens;
    const Unsigned4 numbers = all_direct ? Unsigned4{tokens[0], tokens[1], tokens[2], 0} : with_raw_bits(tokens);
    return std::bit_cast<Int4>(numbers >> 1 ^ -(numbers & 1));
  }

  /// Throws corrupt unless all was taken as an encoder leaves it.
  void finish();

 private:
  RAMCDB_INLINE Unsigned4 with_raw_bits(const std::array<std::uint32_t, kResidualStates>& tokens) {
    if (tokens[0] == kWideToken || tokens[1] == kWideToken || tokens[2] == kWideToken) return with_wide_bits(tokens);
    const TokenRange x = kTokenRanges[tokens[0]], y = kTokenRanges[tokens[1]], z = kTokenRanges[tokens[2]];
    const std::uint64_t window = raw_.window();  // three numbers need 51 bits at most
    raw_.skip(x.bits + y.bits + z.bits);
    return Unsigned4{x.base + RawBitReader::top(window, x.bits), y.base + RawBitReader::top(window << x.bits, y.bits),
                     z.base + RawBitReader::top(window << x.bits << y.bits, z.bits), 0};
  }
  [[gnu::noinline]] Unsigned4 with_wide_bits(const std::array<std::uint32_t, kResidualStates>& tokens);

  const MissTables* tables_;
  NearTokens near_;
  std::array<RansDecoder, kResidualStates> states_;
  WordReader words_{{}};
  RawBitReader raw_{{}};
  std::size_t size_ = 0;
};

}  // namespace ramcdb::codec
