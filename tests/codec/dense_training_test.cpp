#include "codec/dense_training.h"

#include <gtest/gtest.h>

#include "codec/chart_codec.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"

namespace ramcdb::codec {
namespace {

CoderTables trained_on(const Chart& chart, std::uint64_t vertices) {
  const Chart* charts[] = {&chart};
  return train_dense(charts, vertices);
}

std::size_t size_of(const Chart& chart, const CoderTables& tables) {
  return encode_chart(chart, Profile::dense, tables, testing::box_of(chart)).blob.size();
}

TEST(DenseTraining, MakesChartsSmallerByMoreThanTheTable) {
  for (const testing::TestMesh& mesh :
       {testing::terrain(60, 200, 1), testing::torus(60, 40, 9000), testing::sphere(5, 20000)}) {
    const Chart chart = testing::cut(mesh);
    const CoderTables tables = trained_on(chart, chart.positions.size());
    EXPECT_FALSE(tables == CoderTables{});
    EXPECT_LT(size_of(chart, tables) + encode_tables(tables).size(), size_of(chart, {}));
  }
}

TEST(DenseTraining, GivesTheSameTableHoweverTheChartIsNumbered) {
  const Chart chart = testing::cut(testing::terrain(40, 90, 3));
  EXPECT_EQ(trained_on(chart, 10'000), trained_on(testing::shuffled(chart, 5), 10'000));
}

TEST(DenseTraining, KeepsTheBuiltInWeightsWhereOthersWouldNotPay) {
  const CoderTables built_in;
  EXPECT_EQ(train_dense({}, 1000), built_in);
  EXPECT_EQ(trained_on(testing::one_triangle(), 3), built_in);
  EXPECT_EQ(trained_on(testing::cut(testing::sphere(2, 1000)), 60), built_in);
  for (const testing::NamedChart& broken : testing::broken_charts())
    EXPECT_EQ(trained_on(broken.chart, 1'000'000), built_in) << broken.name;
}

TEST(DenseTraining, EveryChartTeachesATableThatCodesIt) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    const CoderTables tables = trained_on(chart, 1'000'000);
    EXPECT_EQ(decode_tables(encode_tables(tables)), tables) << name;
    const EncodedChart encoded = encode_chart(chart, Profile::dense, tables, testing::box_of(chart));
    const auto border = std::span(chart.positions).first(chart.border_count());
    EXPECT_TRUE(decode_chart(encoded.blob, border, chart.loop_sizes, tables, testing::box_of(chart)).chart ==
                encoded.decoded)
        << name;
  }
}

/// Weights are part of what a repository holds: the same on every machine.
TEST(DenseTraining, GoldenTable) {
  const CoderTables tables = trained_on(testing::cut(testing::terrain(40, 90, 3)), 1681);
  std::uint64_t sum = 0;
  for (const FanWeights& weights : tables.fan)
    for (const std::int16_t w : weights) sum = sum * 1000003 + static_cast<std::uint16_t>(w);
  for (const PlaneWeights& weights : tables.plane)
    for (const std::int16_t w : weights) sum = sum * 1000003 + static_cast<std::uint16_t>(w);
  EXPECT_EQ(sum, 15249483738554808179U);
}

}  // namespace
}  // namespace ramcdb::codec
