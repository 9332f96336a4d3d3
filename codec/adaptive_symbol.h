#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "codec/range_coder.h"

namespace ramcdb::codec {

namespace adaptive_symbol_detail {

inline constexpr std::uint16_t kLeast = 8;  ///< of 65536, the share that every symbol keeps
inline constexpr std::uint32_t kSymbolLimit = 250;

/// 65536 / (n + 1.6): how far the n-th observation moves the limits.
inline constexpr auto kRates = [] {
  std::array<std::uint16_t, kSymbolLimit + 1> rates{};
  for (std::size_t n = 0; n < rates.size(); ++n) rates[n] = static_cast<std::uint16_t>(655360 / (10 * n + 16));
  return rates;
}();

using Lanes = std::array<std::uint16_t, 16>;

/// Where the limits would be if nothing but one symbol ever came, by symbol.
inline constexpr auto kTargets = [] {
  std::array<Lanes, 16> targets{};
  for (unsigned symbol = 0; symbol < 16; ++symbol)
    for (unsigned i = 0; i < 15; ++i)
      targets[symbol][i] = static_cast<std::uint16_t>(i < symbol ? (i + 1) * kLeast : 65536 - (15 - i) * kLeast);
  return targets;
}();

}  // namespace adaptive_symbol_detail

/// One of sixteen symbols, with shares of 65536 that are learned while coding, as those of an AdaptiveBit are: quickly
/// at first, then over the last 250 symbols or so. One such decision takes the place of four or five binary ones. Its
/// numbers are the same with and without vector instructions.
class alignas(32) AdaptiveSymbol {
 public:
  static constexpr std::uint32_t kSymbols = 16;
  /// The limits between the symbols (the share of the first i + 1 of them), then how many earlier symbols they stand
  /// for (at most 250).
  using Lanes = adaptive_symbol_detail::Lanes;

  /// All alike.
  constexpr AdaptiveSymbol() {
    for (std::size_t i = 0; i < 15; ++i) lanes_[i] = static_cast<std::uint16_t>(4096 * (i + 1));
  }
  /// REQUIRES: every symbol has a share of 8 at least.
  explicit constexpr AdaptiveSymbol(const Lanes& lanes) : lanes_(lanes) {}

  [[nodiscard]] const Lanes& lanes() const { return lanes_; }
  /// Where the share of a symbol begins.
  [[nodiscard]] std::uint32_t begin(std::uint32_t symbol) const { return symbol == 0 ? 0 : lanes_[symbol - 1]; }
  /// Where it ends; of the last symbol anything.
  [[nodiscard]] std::uint32_t end(std::uint32_t symbol) const { return lanes_[symbol]; }

  /// The symbol in whose share a number below 65536 lies.
  [[nodiscard]] std::uint32_t find(std::uint32_t number) const;
  void learn(std::uint32_t symbol);

 private:
  Lanes lanes_{};
};

#if defined(__SSE2__)

inline std::uint32_t AdaptiveSymbol::find(std::uint32_t number) const {
  const auto* lanes = reinterpret_cast<const __m128i*>(lanes_.data());
  const __m128i wanted = _mm_set1_epi16(static_cast<std::int16_t>(number)), zero = _mm_setzero_si128();
  const __m128i low = _mm_cmpeq_epi16(_mm_subs_epu16(_mm_load_si128(lanes), wanted), zero);
  const __m128i high = _mm_cmpeq_epi16(_mm_subs_epu16(_mm_load_si128(lanes + 1), wanted), zero);
  const int reached = _mm_movemask_epi8(_mm_packs_epi16(low, high));  // ones below, zeros above; the last means nothing
  return static_cast<std::uint32_t>(std::countr_one(static_cast<std::uint32_t>(reached & 0x7fff)));
}

inline void AdaptiveSymbol::learn(std::uint32_t symbol) {
  auto* lanes = reinterpret_cast<__m128i*>(lanes_.data());
  const auto* targets = reinterpret_cast<const __m128i*>(adaptive_symbol_detail::kTargets[symbol].data());
  const std::uint16_t seen = lanes_[15];
  const __m128i rate = _mm_set1_epi16(static_cast<std::int16_t>(adaptive_symbol_detail::kRates[seen]));
  for (int half = 0; half < 2; ++half) {
    const __m128i limit = _mm_load_si128(lanes + half), target = _mm_loadu_si128(targets + half);
    const __m128i up = _mm_mulhi_epu16(_mm_subs_epu16(target, limit), rate);
    const __m128i down = _mm_mulhi_epu16(_mm_subs_epu16(limit, target), rate);
    _mm_store_si128(lanes + half, _mm_sub_epi16(_mm_add_epi16(limit, up), down));
  }
  lanes_[15] = static_cast<std::uint16_t>(seen + (seen < adaptive_symbol_detail::kSymbolLimit));
}

#else

inline std::uint32_t AdaptiveSymbol::find(std::uint32_t number) const {
  std::uint32_t symbol = 0;
  for (std::size_t i = 0; i < 15; ++i) symbol += lanes_[i] <= number;
  return symbol;
}

inline void AdaptiveSymbol::learn(std::uint32_t symbol) {
  const Lanes& targets = adaptive_symbol_detail::kTargets[symbol];
  const std::uint32_t rate = adaptive_symbol_detail::kRates[lanes_[15]];
  for (std::size_t i = 0; i < 15; ++i) {
    const std::uint32_t limit = lanes_[i], target = targets[i];
    lanes_[i] = static_cast<std::uint16_t>(target > limit ? limit + ((target - limit) * rate >> 16)
                                                          : limit - ((limit - target) * rate >> 16));
  }
  lanes_[15] = static_cast<std::uint16_t>(lanes_[15] + (lanes_[15] < adaptive_symbol_detail::kSymbolLimit));
}

#endif

}  // namespace ramcdb::codec
