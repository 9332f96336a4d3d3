#include "api/layers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Attribute normals(std::vector<double> values) {
  Attribute attribute;
  attribute.info = {"normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal, {}, {}};
  attribute.values = std::move(values);
  return attribute;
}

std::array<double, 3> back(const Layer& layer, std::span<const double> value) {
  std::array<std::uint64_t, 2> numbers;
  EXPECT_TRUE(to_numbers(layer, value, numbers));
  std::array<double, 3> there;
  from_numbers(layer, numbers, there);
  std::array<std::uint64_t, 2> same;
  EXPECT_TRUE(to_numbers(layer, there, same));
  EXPECT_EQ(same, numbers);
  return there;
}

TEST(Directions, AreKeptWithinTheStatedError) {
  const Layer layer = layer_for(normals({0, 0, 1}), 1, false);
  ASSERT_EQ(layer.coding, LayerCoding::direction);
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  double worst = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::array<double, 3> d{any(random), any(random), any(random)};
    if (round % 4 == 1) d[static_cast<std::size_t>(round / 4 % 3)] = 0;
    if (round % 64 == 2) d[0] = d[1] = 0;
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (double& x : d) x /= length;
    const std::array<double, 3> kept = back(layer, d);
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(kept[k] - d[k]));
  }
  EXPECT_LE(worst, layer.max_error());
  EXPECT_LE(layer.max_error(), 0.00025);
}

TEST(Directions, AxesAndZeroAreExact) {
  const Layer layer = layer_for(normals({0, 0, 1, 0, 0, 0}), 1, false);
  for (const std::array<double, 3> d :
       {std::array<double, 3>{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
    EXPECT_EQ(back(layer, d), d);
}

TEST(Directions, OnlyWhereLengthsSayNothing) {
  EXPECT_EQ(layer_for(normals({0, 0, 1, kNaN, kNaN, kNaN}), 1, false).coding, LayerCoding::direction);
  EXPECT_EQ(layer_for(normals({0, 0, 1, 0, 0, 2}), 1, false).coding, LayerCoding::grid);
  EXPECT_EQ(layer_for(normals({0, 0, 0.99}), 1, false).coding, LayerCoding::grid);
  EXPECT_EQ(layer_for(normals({0, 0, 1}), 1, true).coding, LayerCoding::float_bits);
  EXPECT_EQ(layer_for(normals({0, 0, 1e30}), 1, false).coding, LayerCoding::float_bits);
  EXPECT_EQ(layer_for(normals({0, kNaN, 1}), 1, false).coding, LayerCoding::float_bits);
  EXPECT_EQ(layer_for(normals({0, 0, 1, 0, 0, std::numeric_limits<double>::infinity()}), 1, false).coding,
            LayerCoding::float_bits);
}

TEST(Directions, RefuseLengthsThatTheyWouldLose) {
  const Layer layer = layer_for(normals({0, 0, 1}), 1, false);
  std::array<std::uint64_t, 2> numbers;
  for (const std::array<double, 3> d : {std::array<double, 3>{0, 0, 2}, {0, kNaN, 1}, {1e300, 1e300, 1e300}})
    EXPECT_THROW((void)to_numbers(layer, d, numbers), Error);
  EXPECT_FALSE(to_numbers(layer, std::array{kNaN, kNaN, kNaN}, numbers));
}

}  // namespace
}  // namespace ramcdb::detail
