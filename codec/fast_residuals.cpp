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
  std::vector<std::uint32_t> near(border + residuals.size(), spread_token(typical));
  std::vector<std::array<Token, kResidualStates>> tokens;
  tokens.reserve(residuals.size());
  RawBitWriter raw;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (plan.places[i].predictor == kFreePlace) continue;
    const std::uint32_t sums = near_sums(plan.places[i], near.data());
    std::array<Token, kResidualStates>& taken = tokens.emplace_back();
    for (std::size_t a = 0; a < kResidualStates; ++a)
      taken[a] = take_token(*tables[sums >> 8 * a & 0xff], zigzag(residuals[i][a]), raw);
    near[border + i] = taken[0].token | taken[1].token << 8 | taken[2].token << 16;
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

/// The loop over all tokens; nothing in it depends on a position.
RAMCDB_FAST_CLONES
void take_tokens(const FastPlan& plan, std::size_t vertex, std::uint32_t typical, const MissTables& tables,
                 std::array<RansDecoder, kResidualStates>& all_states, WordReader& all_words, std::uint32_t* tokens) {
  std::array<RansDecoder, kResidualStates> states = all_states;  // so that they may live in registers
  WordReader words = all_words;
  for (const FastPlace& place : plan.places) {
    if (place.predictor == kFreePlace) [[unlikely]] {
      tokens[vertex++] = typical;
      continue;
    }
    const std::uint32_t sums = near_sums(place, tokens);
    const RansTable &tx = *tables[sums & 0xff], &ty = *tables[sums >> 8 & 0xff], &tz = *tables[sums >> 16];
    std::uint32_t x, y, z;
    if (words.has(kResidualStates)) [[likely]] {
      x = states[0].pop_sure(tx, words);
      y = states[1].pop_sure(ty, words);
      z = states[2].pop_sure(tz, words);
    } else {
      x = states[0].pop(tx, words);
      y = states[1].pop(ty, words);
      z = states[2].pop(tz, words);
    }
    tokens[vertex++] = x | y << 8 | z << 16;
  }
  all_states = states;
  all_words = words;
}

}  // namespace

ResidualTokens decode_tokens(Bytes bytes, const FastPlan& plan, std::uint32_t border, const MissTables& tables) {
  ByteReader reader(bytes, "chart's residual stream");
  ResidualTokens tokens;
  tokens.of_vertex = RawArray<std::uint32_t>(border + plan.places.size());
  if (plan.places.size() == 0) {
    reader.expect_end();
    return tokens;
  }
  const std::uint8_t typical = reader.byte();
  if (typical >= kWideToken) reader.fail("has numbers beyond any lattice");
  std::array<RansDecoder, kResidualStates> states;
  for (RansDecoder& state : states) state = RansDecoder(reader.fixed32());
  WordReader words(reader.rest());
  std::fill_n(tokens.of_vertex.begin(), border, spread_token(typical));
  take_tokens(plan, border, spread_token(typical), tables, states, words, tokens.of_vertex.data());
  const bool ended = std::all_of(states.begin(), states.end(), [](const RansDecoder& state) { return state.at_end(); });
  if (!ended || words.over()) reader.fail("is damaged or cut short");
  (void)reader.take(words.position());
  tokens.raw = RawBitReader(reader.rest());
  tokens.raw_size = reader.rest().size();
  return tokens;
}

Unsigned4 wide_numbers(RawBitReader& raw, std::uint32_t tokens) {
  Unsigned4 numbers{};
  for (std::size_t a = 0; a < kResidualStates; ++a) {
    const std::uint32_t token = tokens >> 8 * a & 0xff;
    const std::uint32_t size = token == kWideToken ? std::min(raw.take(kWideSize), 32u) : kTokenRanges[token].bits;
    numbers[a] = kTokenRanges[token].base + raw.take(size);
  }
  return numbers;
}

void finish_raw_bits(ResidualTokens& tokens) {
  const bool padded = tokens.raw.padding() == 0;
  if (!padded || tokens.raw.bytes_taken() != tokens.raw_size)
    throw Error(Errc::corrupt, "a chart's residual stream is damaged, or longer or shorter than it says");
}

}  // namespace ramcdb::codec
