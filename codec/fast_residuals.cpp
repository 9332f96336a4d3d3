#include "codec/fast_residuals.h"

namespace ramcdb::codec {

std::uint8_t typical_token(std::span<const FastResidual> residuals) {
  std::uint64_t sum = 0;
  for (const FastResidual& r : residuals)
    for (int a = 0; a < 3; ++a) sum += static_cast<std::uint64_t>(std::abs(std::int64_t{r[a]}));
  const std::uint64_t mean = 2 * sum / (3 * residuals.size());
  return static_cast<std::uint8_t>(std::min(token_of(static_cast<std::uint32_t>(mean)), kWideToken - 1));
}

// ---- encoding ----

namespace {

/// A token and the distribution that it has.
struct Token {
  const RansTable* table = nullptr;
  std::uint32_t token = 0;
};

Token take_token(const RansTable& table, std::uint32_t number, RawBitWriter& raw) {
  std::uint32_t token = token_of(number);
  if (table.frequency(token) == 0) token = kWideToken;
  if (token < kWideToken) {
    raw.put(number - kTokenRanges[token].base, kTokenRanges[token].bits);
  } else {
    const auto size = static_cast<std::uint32_t>(std::bit_width(number));
    raw.put(size, kWideSize);
    raw.put(number, size);
  }
  return {&table, token};
}

}  // namespace

Buffer encode_residuals(const FastPlan& plan, std::uint32_t border, std::span<const FastResidual> residuals,
                        const MissTables& tables) {
  if (residuals.empty()) return {};
  const std::uint8_t typical = typical_token(residuals);
  NearTokens near(border, residuals.size(), typical);
  std::vector<std::array<Token, kResidualStates>> tokens;
  tokens.reserve(residuals.size());
  RawBitWriter raw;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (plan.places[i].predictor == kFreePlace) continue;
    const std::uint32_t sums = near.sums(plan.places[i]);
    std::array<Token, kResidualStates>& taken = tokens.emplace_back();
    for (std::size_t a = 0; a < kResidualStates; ++a)
      taken[a] = take_token(*tables[sums >> 8 * a & 0xff], zigzag(residuals[i][a]), raw);
    near.set(border + i, taken[0].token | taken[1].token << 8 | taken[2].token << 16);
  }

  std::array<RansEncoder, kResidualStates> states;
  std::vector<std::uint16_t> words;
  for (std::size_t i = tokens.size(); i-- > 0;)
    for (std::size_t a = kResidualStates; a-- > 0;) states[a].push(*tokens[i][a].table, tokens[i][a].token, words);

  Buffer out{typical};
  for (const RansEncoder& state : states) put_fixed32(out, state.state());
  put_words(out, words);
  const Buffer bits = raw.backwards();
  out.insert(out.end(), bits.begin(), bits.end());
  return out;
}

// ---- decoding ----

namespace {

constexpr std::string_view kStream = "chart's residual stream";

/// Without vertices there is nothing at all.
std::uint8_t take_typical(ByteReader& reader, bool any) {
  if (!any) {
    reader.expect_end();
    return 0;
  }
  const std::uint8_t typical = reader.byte();
  if (typical >= kWideToken) reader.fail("has numbers beyond any lattice");
  return typical;
}

}  // namespace

ResidualReader::ResidualReader(Bytes bytes, const FastPlan& plan, std::uint32_t border, const MissTables& tables)
    : tables_(&tables), near_(0, 0, 0) {
  ByteReader reader(bytes, kStream);
  const bool any = !plan.places.empty();
  near_ = NearTokens(border, plan.places.size(), take_typical(reader, any));
  for (RansDecoder& state : states_) state = RansDecoder(any ? reader.fixed32() : kRansLow);
  words_ = WordReader(reader.rest());
  raw_ = RawBitReader(reader.rest());
  size_ = reader.rest().size();
}

Unsigned4 ResidualReader::with_wide_bits(const std::array<std::uint32_t, kResidualStates>& tokens) {
  Unsigned4 numbers{};
  for (std::size_t a = 0; a < kResidualStates; ++a) {
    const bool wide = tokens[a] == kWideToken;
    const std::uint32_t size = wide ? std::min(raw_.take(kWideSize), 32u) : kTokenRanges[tokens[a]].bits;
    numbers[a] = kTokenRanges[tokens[a]].base + raw_.take(size);
  }
  return numbers;
}

void ResidualReader::finish() {
  const bool padded = raw_.padding() == 0;
  const bool ended =
      std::all_of(states_.begin(), states_.end(), [](const RansDecoder& state) { return state.at_end(); });
  if (!padded || !ended || words_.position() + raw_.bytes_taken() != size_)
    throw Error(Errc::corrupt, "a chart's residual stream is damaged, or longer or shorter than it says");
}

}  // namespace ramcdb::codec
