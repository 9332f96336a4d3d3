#include "codec/adaptive_symbol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ramcdb/error.h"

namespace ramcdb::codec {
namespace {

/// The rule of codec/FORMAT.md in plain numbers.
struct PlainSymbol {
  std::array<std::uint32_t, 17> limits{};
  std::uint32_t seen = 0;

  explicit PlainSymbol(const AdaptiveSymbol& model) : seen(model.lanes()[15]) {
    for (std::size_t i = 0; i < 15; ++i) limits[i + 1] = model.lanes()[i];
    limits[16] = 65536;
  }
  std::uint32_t find(std::uint32_t number) const {
    std::uint32_t symbol = 0;
    while (limits[symbol + 1] <= number) ++symbol;
    return symbol;
  }
  void learn(std::uint32_t symbol) {
    const std::uint32_t rate = 655360 / (10 * seen + 16);
    for (std::uint32_t i = 1; i < 16; ++i) {
      const std::uint32_t target = i <= symbol ? 8 * i : 65536 - 8 * (16 - i);
      if (target > limits[i])
        limits[i] += (target - limits[i]) * rate / 65536;
      else
        limits[i] -= (limits[i] - target) * rate / 65536;
    }
    if (seen < 250) ++seen;
  }
};

TEST(AdaptiveSymbol, LearnsAsTheFormatSays) {
  std::mt19937 random(3);
  for (std::uint32_t run = 0; run < 20; ++run) {
    AdaptiveSymbol model;
    PlainSymbol plain(model);
    for (int i = 0; i < 1000; ++i) {
      const auto symbol = static_cast<std::uint32_t>(random() % (1 + run % 16));
      const auto number = static_cast<std::uint32_t>(random() % 65536);
      model.learn(symbol);
      plain.learn(symbol);
      ASSERT_EQ(PlainSymbol(model).limits, plain.limits);
      ASSERT_EQ(model.lanes()[15], plain.seen);
      ASSERT_EQ(model.find(number), plain.find(number));
    }
  }
}

TEST(AdaptiveSymbol, EverySymbolKeepsAShare) {
  for (std::uint32_t often = 0; often < 16; ++often) {
    AdaptiveSymbol model;
    for (int i = 0; i < 5000; ++i) model.learn(often);
    for (std::uint32_t symbol = 0; symbol < 15; ++symbol) EXPECT_GE(model.end(symbol), model.begin(symbol) + 8);
    EXPECT_LE(model.begin(15), 65536u - 8);
    EXPECT_EQ(model.find(0), 0u);
    EXPECT_EQ(model.find(65535), 15u);
  }
}

TEST(AdaptiveSymbol, ComesBackAmongBitsAndRawNumbers) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const auto code_all = [&](auto& coder, std::mt19937 random, std::vector<std::uint32_t> told) {
      std::array<AdaptiveSymbol, 3> symbols;
      AdaptiveBit bit;
      for (auto& value : told) {
        const auto wanted = static_cast<std::uint32_t>(random());
        switch (wanted % 5) {
          case 0:
            value = coder.code(bit, wanted & 64);
            break;
          case 1:
            value = coder.code_raw(wanted >> 16, 16);
            break;
          default:
            value = coder.code_symbol(symbols[wanted % 5 - 2], std::min(wanted >> 16 & 15, wanted >> 20 & 15));
        }
        told.back() = static_cast<std::uint32_t>(coder.position());
      }
      return told;
    };
    RangeEncoder encoder;
    const std::vector<std::uint32_t> told =
        code_all(encoder, std::mt19937(seed), std::vector<std::uint32_t>(40 * seed));
    const Buffer bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    EXPECT_EQ(code_all(decoder, std::mt19937(seed), std::vector<std::uint32_t>(40 * seed)), told);
    EXPECT_NO_THROW(decoder.finish());
  }
}

TEST(AdaptiveSymbol, TakesAboutTheEntropy) {
  RangeEncoder encoder;
  AdaptiveSymbol model;
  std::mt19937 random(1);
  double entropy = 0;
  for (int i = 0; i < 50000; ++i) {
    const auto symbol = static_cast<std::uint32_t>(std::countr_zero((random() & 0xff) | 0x8000U));
    entropy += symbol < 8 ? symbol + 1 : 8;
    encoder.code_symbol(model, symbol);
  }
  EXPECT_LT(8.0 * static_cast<double>(encoder.finish().size()), entropy * 1.02);
}

TEST(AdaptiveSymbol, EndsOnAnyInput) {
  for (const unsigned byte : {0U, 85U, 255U}) {
    const Buffer bytes(20, static_cast<std::uint8_t>(byte));
    RangeDecoder decoder(bytes);
    AdaptiveSymbol model;
    EXPECT_THROW(
        {
          for (int i = 0; i < 1'000'000; ++i) decoder.code_symbol(model);
        },
        Error);
  }
}

}  // namespace
}  // namespace ramcdb::codec
