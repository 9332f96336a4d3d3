#include "codec/range_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "ramcdb/error.h"

namespace ramcdb::codec {
namespace {

/// One coding decision of a made-up format.
struct Symbol {
  int kind = 0;  // 0: bit, 1: raw, 2: unsigned, 3: signed
  std::uint32_t value = 0;
  int bits = 0;
  friend bool operator==(const Symbol&, const Symbol&) = default;
};

struct Models {
  std::array<AdaptiveBit, 4> bits;
  AdaptiveUnsigned unsigned_numbers;
  AdaptiveSigned signed_numbers;
};

template <class Coder>
std::uint32_t code_symbol(Coder& coder, Models& models, const Symbol& s) {
  switch (s.kind) {
    case 0:
      return coder.code(models.bits[static_cast<std::size_t>(s.bits) % 4], s.value != 0);
    case 1:
      return coder.code_raw(s.value, s.bits);
    case 2:
      return models.unsigned_numbers.code(coder, s.value);
    default:
      return static_cast<std::uint32_t>(models.signed_numbers.code(coder, static_cast<std::int32_t>(s.value)));
  }
}

std::vector<Symbol> random_symbols(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  const std::uint32_t one_in = 2 + seed % 50;
  std::vector<Symbol> symbols;
  for (int i = 0; i < count; ++i) {
    Symbol s{static_cast<int>(random() % 4), 0, static_cast<int>(random() % 33)};
    const int width = static_cast<int>(random() % 33);
    const auto number = static_cast<std::uint32_t>(random() & ((std::uint64_t{1} << width) - 1));
    if (s.kind == 0) s.value = random() % one_in == 0;
    if (s.kind == 1) s.value = static_cast<std::uint32_t>(number & ((std::uint64_t{1} << s.bits) - 1));
    if (s.kind == 2) s.value = number;
    if (s.kind == 3) s.value = number == 0x80000000u ? 0 : number;
    symbols.push_back(s);
  }
  return symbols;
}

struct Encoded {
  Buffer bytes;
  std::vector<std::uint64_t> positions;
};

Encoded encode(const std::vector<Symbol>& symbols) {
  RangeEncoder encoder;
  Models models;
  Encoded result;
  for (const Symbol& s : symbols) {
    code_symbol(encoder, models, s);
    result.positions.push_back(encoder.position());
  }
  result.bytes = encoder.finish();
  return result;
}

/// Decodes from a heap buffer of exactly the right size, so that an address sanitizer sees one byte too far.
void decode(Bytes bytes, const std::vector<Symbol>& expected, const std::vector<std::uint64_t>& positions) {
  const auto exact = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  RangeDecoder decoder({exact.get(), bytes.size()});
  Models models;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    Symbol blank = expected[i];
    blank.value = 0;
    if (code_symbol(decoder, models, blank) != expected[i].value) throw Error(Errc::corrupt, "another value");
    if (decoder.position() != positions[i]) throw Error(Errc::corrupt, "another position");
  }
  decoder.finish();
}

TEST(RangeCoder, RoundTripsAnyMixAndCountsTheSameBits) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const auto symbols = random_symbols(seed, static_cast<int>(seed * seed / 30));
    const auto encoded = encode(symbols);
    EXPECT_NO_THROW(decode(encoded.bytes, symbols, encoded.positions)) << "seed " << seed;
  }
}

TEST(RangeCoder, RefusesEveryTruncationAndEveryExtraByte) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const auto symbols = random_symbols(seed, 1 + static_cast<int>(seed) / 4);
    const auto encoded = encode(symbols);
    const Bytes bytes(encoded.bytes);
    for (std::size_t n = 0; n < bytes.size(); ++n)
      EXPECT_THROW(decode(bytes.first(n), symbols, encoded.positions), Error) << "seed " << seed << " cut at " << n;
    for (const int extra : {0, 1, 128, 255}) {
      Buffer longer = encoded.bytes;
      longer.push_back(static_cast<std::uint8_t>(extra));
      EXPECT_THROW(decode(longer, symbols, encoded.positions), Error) << "seed " << seed;
    }
  }
}

TEST(RangeCoder, PropagatesCarriesThroughManyBytes) {
  // The upper end of every interval keeps low just below a power of 256 until the last symbol decides.
  for (int ones = 0; ones < 40; ++ones) {
    std::vector<Symbol> symbols(static_cast<std::size_t>(ones), Symbol{1, 0xffffffffu, 32});
    symbols.push_back({1, 0, 7});
    symbols.push_back({1, 127, 7});
    const auto encoded = encode(symbols);
    EXPECT_NO_THROW(decode(encoded.bytes, symbols, encoded.positions));
  }
}

TEST(RangeCoder, CodesNothingToNoBytes) {
  EXPECT_TRUE(encode({}).bytes.empty());
  EXPECT_NO_THROW(decode({}, {}, {}));
  EXPECT_THROW(decode(Buffer{0}, {}, {}), Error);
}

TEST(RangeCoder, PositionsMeasureTheStream) {
  const auto encoded = encode(random_symbols(77, 5000));
  const double bits = static_cast<double>(encoded.positions.back()) / 256;
  EXPECT_NEAR(bits, 8.0 * static_cast<double>(encoded.bytes.size()), 8);
}

TEST(RangeCoder, EndsOnAnyInput) {
  std::mt19937 random(5);
  for (int run = 0; run < 200; ++run) {
    Buffer bytes(random() % 20);
    for (auto& b : bytes) b = run % 3 == 0 ? 0 : run % 3 == 1 ? 255 : static_cast<std::uint8_t>(random());
    RangeDecoder decoder(bytes);
    AdaptiveBit bit;
    EXPECT_THROW(
        {
          for (int i = 0; i < 1'000'000; ++i) decoder.code(bit);
        },
        Error);
  }
}

TEST(RangeCoder, LearnsSkewedBits) {
  RangeEncoder encoder;
  AdaptiveBit bit;
  std::mt19937 random(1);
  for (int i = 0; i < 80000; ++i) encoder.code(bit, random() % 16 == 0);
  const double entropy = 80000 * (std::log2(16.0) / 16 + 15 * std::log2(16.0 / 15) / 16);
  EXPECT_LT(8.0 * static_cast<double>(encoder.finish().size()), entropy * 1.02);
}

TEST(RangeCoder, GoldenBytes) {
  // Bytes of format 1: never to change.
  const auto encoded = encode(random_symbols(42, 12));
  std::string hex;
  for (const auto b : encoded.bytes) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += {kDigits[b >> 4], kDigits[b & 15]};
  }
  EXPECT_EQ(hex, "00000006deb221e03bb0c6fa993fbf9229b6e25f34120a0961c63b197e");
}

}  // namespace
}  // namespace ramcdb::codec
