#include "codec/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codec/fast_scales.h"
#include "ramcdb/error.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

FastTables changed_fast(std::mt19937& random, std::uint32_t one_in) {
  FastNumbers numbers = FastTables().numbers();
  for (auto& context : numbers.steps)
    if (random() % one_in == 0)
      std::swap(*std::max_element(context.begin(), context.end()), context[2 + random() % 14]);
  for (PlaceWeights& of_class : numbers.weights)
    if (random() % one_in == 0)
      for (std::int16_t& w : of_class)
        w = static_cast<std::int16_t>(static_cast<int>(random() % (2 * kMostPlaceWeight + 1)) - kMostPlaceWeight);
  for (std::uint8_t& scale : numbers.scales)
    if (random() % one_in == 0) scale = static_cast<std::uint8_t>(random() % kScales);
  return FastTables(numbers);
}

CoderTables changed(std::uint32_t seed) {
  std::mt19937 random(seed);
  const std::uint32_t one_in = 1 + seed % 20;
  const auto weight = [&] {
    return static_cast<std::int16_t>(static_cast<int>(random() % (2 * kMaxWeight + 1)) - kMaxWeight);
  };
  CoderTables tables;
  for (FanWeights& weights : tables.fan)
    if (random() % one_in == 0)
      for (std::int16_t& w : weights) w = weight();
  for (PlaneWeights& weights : tables.plane)
    if (random() % one_in == 0)
      for (std::int16_t& w : weights) w = weight();
  if (seed % 2 == 1) tables.fast = changed_fast(random, one_in);
  return tables;
}

CoderTables filled_with(int weight) {
  CoderTables tables;
  for (FanWeights& weights : tables.fan) weights.fill(static_cast<std::int16_t>(weight));
  for (PlaneWeights& weights : tables.plane) weights.fill(static_cast<std::int16_t>(weight));
  return tables;
}

TEST(CoderTables, ComeBack) {
  for (std::uint32_t seed = 0; seed < 200; ++seed)
    EXPECT_EQ(decode_tables(encode_tables(changed(seed))), changed(seed)) << "seed " << seed;
  for (const int weight : {0, kMaxWeight, -kMaxWeight})
    EXPECT_EQ(decode_tables(encode_tables(filled_with(weight))), filled_with(weight));
}

TEST(CoderTables, RefusesWeightsBeyondReason) {
  for (const int weight : {kMaxWeight + 1, -kMaxWeight - 1, 32767, -32768})
    EXPECT_THROW((void)encode_tables(filled_with(weight)), Error);
}

TEST(CoderTables, RefusesFastTablesThatCannotCodeEveryChart) {
  const auto refused = [](const FastNumbers& numbers) {
    CoderTables tables;
    tables.fast = FastTables(numbers);
    try {
      (void)encode_tables(tables);
    } catch (const Error& e) {
      return e.code() == Errc::invalid_argument;
    }
    return false;
  };
  FastNumbers numbers = FastTables().numbers();
  numbers.weights[0][0] = kMostPlaceWeight + 1;
  EXPECT_TRUE(refused(numbers));
  numbers = FastTables().numbers();
  numbers.steps[0][6] = static_cast<std::uint16_t>(numbers.steps[0][6] + numbers.steps[0][15]);
  numbers.steps[0][15] = 0;
  EXPECT_TRUE(refused(numbers));
  EXPECT_FALSE(refused(FastTables().numbers()));
}

TEST(CoderTables, OtherLengthsAreRefused) {
  for (const std::uint32_t seed : {0u, 1u, 19u})
    testing::expect_refuses_other_lengths([](Bytes bytes) { (void)decode_tables(bytes); },
                                          encode_tables(changed(seed)));
}

TEST(CoderTables, DamagedBytesAreRefused) {
  for (const std::uint32_t seed : {0u, 1u, 7u, 19u})
    EXPECT_EQ(testing::count_taken_when_damaged([](Bytes bytes) { (void)decode_tables(bytes); },
                                                encode_tables(changed(seed))),
              0);
}

TEST(CoderTables, UnknownFormatsAreRefused) {
  Buffer blob = encode_tables({});
  const auto code_with = [&](int format) {
    blob[0] = static_cast<std::uint8_t>(format);
    try {
      (void)decode_tables(blob);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::cancelled;  // stands for "took it"
  };
  EXPECT_EQ(code_with(0), Errc::corrupt);
  EXPECT_EQ(code_with(2), Errc::unsupported_version);
}

TEST(CoderTables, GoldenBytes) {
  // Bytes of format 1: never to change.
  CoderTables tables;
  EXPECT_EQ(testing::hex(encode_tables(tables)), "016f4d8123ffe3");
  tables.fan[9] = {1, -2, 300, -16384, 16384, 0};
  tables.plane[15] = {64, 64, 0};
  EXPECT_EQ(testing::hex(encode_tables(tables)), "018069c0febe52b49781bac6fc968213431366b624ece094");
}

TEST(CoderTables, BuiltInFastTablesNeverChange) {
  EXPECT_EQ(FastTables().digest(), 16696042078507936271u) << "codec/built_in_fast.h is part of the format";
}

TEST(CoderTables, BuiltInWeightsNeverChange) {
  // The sum that every chart's check would show, too; here it says which file to put back.
  std::uint64_t sum = 0;
  const CoderTables tables;
  for (const FanWeights& weights : tables.fan)
    for (const std::int16_t w : weights) sum = sum * 1000003 + static_cast<std::uint16_t>(w);
  for (const PlaneWeights& weights : tables.plane)
    for (const std::int16_t w : weights) sum = sum * 1000003 + static_cast<std::uint16_t>(w);
  EXPECT_EQ(sum, 7160460506519239829u) << "codec/built_in_weights.h is part of the format";
}

}  // namespace
}  // namespace ramcdb::codec
