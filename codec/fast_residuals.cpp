#include "codec/fast_residuals.h"

#include <algorithm>
#include <bit>

#include "codec/fast_scales.h"
#include "codec/varint.h"

namespace ramcdb::codec {

namespace {

constexpr std::size_t kStates = 3;
constexpr int kWideSize = 6;  ///< raw bits that tell the size of a wide number

/// What a token below kWideToken stands for: the least number, and how many raw bits are added to it.
struct TokenRange {
  std::uint32_t base = 0;
  std::uint32_t bits = 0;
};

constexpr auto kRanges = [] {
  std::array<TokenRange, RansTable::kMostSymbols> ranges{};
  for (std::uint32_t token = 0; token < kWideToken; ++token) {
    const std::uint32_t half = token < kDirectTokens ? 0 : token - kDirectTokens;
    ranges[token] =
        token < kDirectTokens ? TokenRange{token, 0} : TokenRange{(2 + half % 2) << (4 + half / 2), 4 + half / 2};
  }
  return ranges;
}();

std::uint32_t token_of(std::uint32_t number) {
  if (number < kDirectTokens) return number;
  const auto top = static_cast<std::uint32_t>(std::bit_width(number)) - 1;
  return std::min(kDirectTokens + 2 * (top - 5) + (number >> (top - 1) & 1), kWideToken);
}

std::uint32_t zigzag32(std::int32_t value) {
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}
std::int32_t unzigzag32(std::uint32_t value) { return static_cast<std::int32_t>(value >> 1 ^ (0u - (value & 1))); }

/// Bits, highest first; the bytes are turned around at the end.
class RawBitWriter {
 public:
  void put(std::uint32_t value, std::uint32_t count) {
    for (std::uint32_t i = count; i-- > 0;) {
      if (filled_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1) << (7 - filled_ % 8));
      ++filled_;
    }
  }
  [[nodiscard]] Buffer backwards() const { return {bytes_.rbegin(), bytes_.rend()}; }

 private:
  Buffer bytes_;
  std::size_t filled_ = 0;
};

/// Reads them from the end of `bytes`. Before the beginning come zeros.
class RawBitReader {
 public:
  explicit RawBitReader(Bytes bytes) : bytes_(bytes) {}

  /// Up to 32 bits.
  std::uint32_t take(std::uint32_t count) {
    const std::size_t skip = at_ / 8;
    std::uint64_t window = 0;
    if (skip + 8 <= bytes_.size()) {
      const std::uint8_t* from = bytes_.data() + (bytes_.size() - skip - 8);
      for (int i = 8; i-- > 0;) window = window << 8 | from[i];
    } else {
      for (std::size_t i = 0; i < 8; ++i)
        window = window << 8 | (skip + i < bytes_.size() ? bytes_[bytes_.size() - 1 - skip - i] : 0u);
    }
    window <<= at_ % 8;
    at_ += count;
    return static_cast<std::uint32_t>(window >> 32 >> (32 - count));
  }
  /// Bytes that were read of, the last one perhaps in part; what is left of that must be zeros.
  [[nodiscard]] std::size_t bytes_taken() const { return (at_ + 7) / 8; }
  [[nodiscard]] std::uint32_t padding() { return take(static_cast<std::uint32_t>(8 * bytes_taken() - at_)); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;  ///< bits taken
};

/// What all vertices have in common: half-octave of eight times the mean magnitude.
std::uint8_t mean_of(std::span<const FastResidual> residuals) {
  std::uint64_t sum = 0;
  for (const FastResidual& r : residuals)
    for (const std::int32_t x : r) sum += static_cast<std::uint64_t>(std::abs(std::int64_t{x}));
  const std::uint64_t mean = residuals.empty() ? 0 : 8 * sum / (3 * residuals.size());
  return static_cast<std::uint8_t>(
      std::min(half_octave(static_cast<std::uint32_t>(std::min<std::uint64_t>(mean, ~0u))), kScales - 1));
}

struct Token {
  std::uint8_t scale = 0;
  std::uint8_t token = 0;
};

}  // namespace

// ---- encoding ----

Buffer encode_residuals(const FastPlan& plan, std::uint32_t border, std::span<const FastResidual> residuals) {
  const std::uint8_t mean = mean_of(residuals);
  FastScales scales(border, static_cast<std::uint32_t>(residuals.size()), mean);
  std::vector<std::array<Token, kStates>> tokens(residuals.size());
  RawBitWriter raw;
  for (std::uint32_t i = 0; i < residuals.size(); ++i) {
    const auto contexts = scales.contexts(plan.places[i]);
    for (std::size_t a = 0; a < kStates; ++a) {
      const std::uint32_t number = zigzag32(residuals[i][a]);
      const std::uint32_t scale = scales.scale(contexts[a]);
      std::uint32_t token = token_of(number);
      if (scale_tables()[scale].frequency(token) == 0) token = kWideToken;
      tokens[i][a] = {static_cast<std::uint8_t>(scale), static_cast<std::uint8_t>(token)};
      if (token < kWideToken) {
        raw.put(number - kRanges[token].base, kRanges[token].bits);
      } else {
        const auto size = static_cast<std::uint32_t>(std::bit_width(number));
        raw.put(size, kWideSize);
        raw.put(number, size);
      }
    }
    scales.learn(border + i, contexts, residuals[i]);
  }

  std::array<RansEncoder, kStates> states;
  std::vector<std::uint16_t> words;
  for (std::size_t i = tokens.size(); i-- > 0;)
    for (std::size_t a = kStates; a-- > 0;)
      states[a].push(scale_tables()[tokens[i][a].scale], tokens[i][a].token, words);

  Buffer out{mean};
  for (const RansEncoder& state : states) put_fixed32(out, state.state());
  for (std::size_t i = words.size(); i-- > 0;) {
    out.push_back(static_cast<std::uint8_t>(words[i]));
    out.push_back(static_cast<std::uint8_t>(words[i] >> 8));
  }
  const Buffer bits = raw.backwards();
  out.insert(out.end(), bits.begin(), bits.end());
  return out;
}

// ---- decoding ----

std::vector<FastResidual> decode_residuals(Bytes bytes, const FastPlan& plan, std::uint32_t border) {
  ByteReader reader(bytes, "chart's residual stream");
  const std::uint8_t mean = reader.byte();
  if (mean >= kScales) reader.fail("has numbers beyond any lattice");
  std::array<RansDecoder, kStates> states;
  for (RansDecoder& state : states) state = RansDecoder(reader.fixed32());
  WordReader words(reader.rest());
  RawBitReader raw(reader.rest());

  std::vector<FastResidual> residuals(plan.places.size());
  FastScales scales(border, static_cast<std::uint32_t>(residuals.size()), mean);
  const auto& tables = scale_tables();
  for (std::uint32_t i = 0; i < residuals.size(); ++i) {
    const auto contexts = scales.contexts(plan.places[i]);
    for (std::size_t a = 0; a < kStates; ++a) {
      const std::uint32_t token = states[a].pop(tables[scales.scale(contexts[a])], words);
      std::uint32_t number = kRanges[token].base + raw.take(kRanges[token].bits);
      if (token == kWideToken) number = raw.take(std::min(raw.take(kWideSize), 32u));
      residuals[i][a] = unzigzag32(number);
    }
    scales.learn(border + i, contexts, residuals[i]);
  }
  for (const RansDecoder& state : states)
    if (!state.at_end()) reader.fail("is damaged");
  if (raw.padding() != 0 || words.position() + raw.bytes_taken() != reader.rest().size())
    reader.fail("is longer or shorter than it says");
  return residuals;
}

}  // namespace ramcdb::codec
