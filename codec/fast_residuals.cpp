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

Unsigned4 zigzag4(Int4 values) { return std::bit_cast<Unsigned4>(values << 1 ^ values >> 31); }
RAMCDB_INLINE Int4 unzigzag4(Unsigned4 values) { return std::bit_cast<Int4>(values >> 1 ^ -(values & 1)); }

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

  /// The next bits, highest first: 57 at least.
  [[nodiscard]] std::uint64_t window() const {
    const std::size_t skip = at_ / 8;
    if (skip + 8 > bytes_.size()) return window_at_end(skip) << at_ % 8;
    return load_le64(bytes_.data() + (bytes_.size() - skip - 8)) << at_ % 8;
  }
  void skip(std::uint32_t count) { at_ += count; }

  /// Up to 32 bits.
  std::uint32_t take(std::uint32_t count) {
    const std::uint64_t bits = window();
    skip(count);
    return static_cast<std::uint32_t>(bits >> 32 >> (32 - count));
  }
  /// Bytes that were read of, the last one perhaps in part; what is left of that must be zeros.
  [[nodiscard]] std::size_t bytes_taken() const { return (at_ + 7) / 8; }
  [[nodiscard]] std::uint32_t padding() { return take(static_cast<std::uint32_t>(8 * bytes_taken() - at_)); }

 private:
  [[nodiscard]] std::uint64_t window_at_end(std::size_t skip) const {
    std::uint64_t window = 0;
    for (std::size_t i = 0; i < 8; ++i)
      window = window << 8 | (skip + i < bytes_.size() ? bytes_[bytes_.size() - 1 - skip - i] : 0u);
    return window;
  }

  Bytes bytes_;
  std::size_t at_ = 0;  ///< bits taken
};

/// The distribution of all numbers together.
std::uint8_t typical_scale(std::span<const FastResidual> residuals) {
  std::uint64_t sum = 0;
  for (const FastResidual& r : residuals)
    for (int a = 0; a < 3; ++a) sum += static_cast<std::uint64_t>(std::abs(std::int64_t{r[a]}));
  const std::uint64_t eighths = residuals.empty() ? 0 : 8 * sum / (3 * residuals.size());
  const auto capped = static_cast<std::uint32_t>(std::min<std::uint64_t>(eighths, (1u << 17) - 1));
  return capped == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(half_octave(static_cast<std::int32_t>(capped)) + 1);
}

struct Token {
  std::uint8_t scale = 0;
  std::uint8_t token = 0;
};

}  // namespace

// ---- encoding ----

Buffer encode_residuals(const FastPlan& plan, std::uint32_t border, std::span<const FastResidual> residuals) {
  if (residuals.empty()) return {};
  const std::uint8_t typical = typical_scale(residuals);
  FastScales scales(border, static_cast<std::uint32_t>(residuals.size()), typical);
  std::vector<std::array<Token, kStates>> tokens(residuals.size());
  RawBitWriter raw;
  for (std::uint32_t i = 0; i < residuals.size(); ++i) {
    const Int4 contexts = scales.contexts(plan.places[i]);
    const Unsigned4 numbers = zigzag4(residuals[i]);
    for (std::size_t a = 0; a < kStates; ++a) {
      const std::uint32_t number = numbers[a];
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
    scales.learn(border + i, contexts, numbers);
  }

  std::array<RansEncoder, kStates> states;
  std::vector<std::uint16_t> words;
  for (std::size_t i = tokens.size(); i-- > 0;)
    for (std::size_t a = kStates; a-- > 0;)
      states[a].push(scale_tables()[tokens[i][a].scale], tokens[i][a].token, words);

  Buffer out{typical};
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

namespace {

/// Where the three numbers of a vertex come from.
class NumberReader {
 public:
  NumberReader(const std::array<RansDecoder, kStates>& states, Bytes bytes)
      : states_(states), words_(bytes), raw_(bytes), size_(bytes.size()) {}

  RAMCDB_INLINE Unsigned4 take(const std::array<const RansTable*, kStates>& tables) {
    std::array<std::uint32_t, kStates> tokens;
    if (words_.has(kStates))
      for (std::size_t a = 0; a < kStates; ++a) tokens[a] = states_[a].pop_sure(*tables[a], words_);
    else
      for (std::size_t a = 0; a < kStates; ++a) tokens[a] = states_[a].pop(*tables[a], words_);
    if (tokens[0] == kWideToken || tokens[1] == kWideToken || tokens[2] == kWideToken) return take_wide(tokens);

    const TokenRange x = kRanges[tokens[0]], y = kRanges[tokens[1]], z = kRanges[tokens[2]];
    const std::uint64_t window = raw_.window();  // three numbers need 51 bits at most
    raw_.skip(x.bits + y.bits + z.bits);
    return Unsigned4{x.base + top(window, x.bits), y.base + top(window << x.bits, y.bits),
                     z.base + top(window << x.bits << y.bits, z.bits), 0};
  }

  /// Whether all was taken as an encoder leaves it.
  [[nodiscard]] bool ends_well() {
    const bool padded = raw_.padding() == 0;
    return padded && words_.position() + raw_.bytes_taken() == size_ &&
           std::all_of(states_.begin(), states_.end(), [](const RansDecoder& state) { return state.at_end(); });
  }

 private:
  static std::uint32_t top(std::uint64_t window, std::uint32_t bits) {
    return static_cast<std::uint32_t>(window >> 1 >> (63 - bits));
  }

  [[gnu::noinline]] Unsigned4 take_wide(const std::array<std::uint32_t, kStates>& tokens) {
    Unsigned4 numbers{};
    for (std::size_t a = 0; a < kStates; ++a) {
      const std::uint32_t size =
          tokens[a] == kWideToken ? std::min(raw_.take(kWideSize), 32u) : kRanges[tokens[a]].bits;
      numbers[a] = kRanges[tokens[a]].base + raw_.take(size);
    }
    return numbers;
  }

  std::array<RansDecoder, kStates> states_;
  WordReader words_;
  RawBitReader raw_;
  std::size_t size_;
};

/// The loop over all vertices; nothing in it depends on a position.
RAMCDB_FAST_CLONES
void take_all(NumberReader& reader, FastScales& scales, const FastPlan& plan, std::uint32_t border,
              std::vector<FastResidual>& residuals) {
  NumberReader numbers = reader;  // so that its states may live in registers
  const auto& tables = scale_tables();
  for (std::uint32_t i = 0; i < residuals.size(); ++i) {
    const Int4 contexts = scales.contexts(plan.places[i]);
    const Unsigned4 taken = numbers.take(
        {&tables[scales.scale(contexts[0])], &tables[scales.scale(contexts[1])], &tables[scales.scale(contexts[2])]});
    residuals[i] = unzigzag4(taken);
    scales.learn(border + i, contexts, taken);
  }
  reader = numbers;
}

}  // namespace

std::vector<FastResidual> decode_residuals(Bytes bytes, const FastPlan& plan, std::uint32_t border) {
  ByteReader reader(bytes, "chart's residual stream");
  if (plan.places.empty()) {
    reader.expect_end();
    return {};
  }
  const std::uint8_t typical = reader.byte();
  if (typical >= kScales) reader.fail("has numbers beyond any lattice");
  std::array<RansDecoder, kStates> states;
  for (RansDecoder& state : states) state = RansDecoder(reader.fixed32());
  NumberReader numbers(states, reader.rest());

  std::vector<FastResidual> residuals(plan.places.size());
  FastScales scales(border, static_cast<std::uint32_t>(residuals.size()), typical);
  take_all(numbers, scales, plan, border, residuals);
  if (!numbers.ends_well()) reader.fail("is damaged, or longer or shorter than it says");
  return residuals;
}

}  // namespace ramcdb::codec
