#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "codec/layer_codec.h"
#include "codec/octahedron.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

constexpr std::int32_t kUnit = kOctahedronUnit;
constexpr AttributeOf kOwners[] = {AttributeOf::vertex, AttributeOf::corner, AttributeOf::face};

LayerShape directions_of(AttributeOf of) { return {of, 2, kDirectionBits, ValueKind::direction}; }

/// Points of everywhere: a coarse grid with both rims and the axes, where rules change.
std::vector<OctahedronPoint> points() {
  std::vector<OctahedronPoint> all{OctahedronPoint::none()};
  std::vector<std::int32_t> steps{-kUnit, -kUnit + 1, -1, 0, 1, kUnit - 1, kUnit};
  for (std::int32_t at = -kUnit; at <= kUnit; at += 509) steps.push_back(at);
  for (const std::int32_t u : steps)
    for (const std::int32_t v : steps)
      if (is_octahedron_point({u, v})) all.push_back({u, v});
  return all;
}

TEST(Octahedron, EveryPointIsADirectionOfItsOwn) {
  for (const OctahedronPoint p : points()) {
    const OctahedronVector d = octahedron_vector(p);
    EXPECT_EQ(octahedron_point(d), p) << p.u << ' ' << p.v;
    EXPECT_EQ(std::abs(d.x) + std::abs(d.y) + std::abs(d.z), p == OctahedronPoint::none() ? 0 : kUnit);
    EXPECT_EQ(octahedron_point({7 * d.x, 7 * d.y, 7 * d.z}), p);
  }
  EXPECT_EQ(octahedron_vector({0, 0}).z, kUnit);
  EXPECT_EQ(octahedron_vector({kUnit, kUnit}).z, -kUnit);
  EXPECT_EQ(octahedron_vector({-kUnit, 0}).x, -kUnit);
}

TEST(Octahedron, PlacesNearADirectionAreNearInTheSquareAsSeenFromIt) {
  for (const OctahedronPoint guess : points())
    for (const OctahedronPoint p : points()) {
      const OctahedronPoint seen = seen_from(guess, p);
      ASSERT_TRUE(in_octahedron_square(seen));
      ASSERT_EQ(without_twins(seen_from(guess, seen)), p) << guess.u << ' ' << guess.v << ' ' << p.u << ' ' << p.v;
      if (guess == OctahedronPoint::none() || p == OctahedronPoint::none()) continue;
      const OctahedronVector a = octahedron_vector(guess), b = octahedron_vector(p), way = a - b;
      const std::int64_t far = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
      if (far > kUnit / 8) continue;
      const OctahedronPoint from = seen_from(guess, guess);
      // The way in the square is no longer than the one through space, but where the way crosses the equator it is
      // mirrored at its edge.
      ASSERT_LE(std::max(std::abs(seen.u - from.u), std::abs(seen.v - from.v)), 2 * far)
          << guess.u << ' ' << guess.v << ' ' << p.u << ' ' << p.v;
    }
}

/// Directions from the middle of a chart to its vertices, some of them random, none or absent.
LayerValues sample(const Chart& chart, AttributeOf of, unsigned odd, std::uint32_t seed) {
  std::mt19937 random(seed);
  const LatticeBox box = testing::box_of(chart);
  LayerValues values;
  const std::size_t count = value_count(chart, of);
  const std::vector<OctahedronPoint> any = points();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t v = of == AttributeOf::vertex   ? i
                          : of == AttributeOf::corner ? chart.faces[i / 3][i % 3]
                                                      : chart.faces[i][0];
    OctahedronVector d{chart.positions[v].x, chart.positions[v].y, chart.positions[v].z};
    d = d + d - OctahedronVector{box.lo.x, box.lo.y, box.lo.z} - OctahedronVector{box.hi.x, box.hi.y, box.hi.z};
    const bool is_odd = random() % 100 < odd, absent = is_odd && random() % 2;
    OctahedronPoint p = is_odd ? any[random() % any.size()] : octahedron_point(d);
    if (absent) p = {0, 0};
    if (odd) values.absent.push_back(absent);
    for (const std::int32_t x : {p.u, p.v})
      values.numbers.push_back(static_cast<std::uint64_t>(std::int64_t{x}) & 0xffff);
  }
  if (std::find(values.absent.begin(), values.absent.end(), true) == values.absent.end()) values.absent.clear();
  return values;
}

TEST(DirectionLayer, ComesBackOnEveryChart) {
  std::vector<testing::NamedChart> charts = testing::manifold_charts();
  for (testing::NamedChart& chart : testing::broken_charts()) charts.push_back(std::move(chart));
  for (const auto& [name, chart] : charts) {
    const LayerOrder order(chart);
    for (const AttributeOf of : kOwners)
      for (const unsigned odd : {0U, 20U, 100U}) {
        const LayerValues values = sample(chart, of, odd, odd + 1);
        const Buffer blob = encode_layer(values, directions_of(of), chart, order);
        ASSERT_TRUE(decode_layer(blob, directions_of(of), chart, order) == values) << name << ' ' << odd;
      }
  }
}

/// All around a sphere, seams of the square included, beside three numbers per vertex of half the accuracy.
TEST(DirectionLayer, TakesFewerBitsThanThreeNumbers) {
  const Chart chart = testing::cut(testing::sphere(5, kUnit / 2));
  const LayerOrder order(chart);
  const auto bits = [&](AttributeOf of) {
    return 8 * encode_layer(sample(chart, of, 0, 1), directions_of(of), chart, order).size();
  };
  LayerValues numbers;
  for (const LatticePoint p : chart.positions)
    for (const std::int32_t x : {p.x, p.y, p.z})
      numbers.numbers.push_back(static_cast<std::uint64_t>(std::int64_t{x}) & 0xffff);
  const std::size_t as_numbers = 8 * encode_layer(numbers, {AttributeOf::vertex, 3, 16}, chart, order).size();
  const std::size_t of_vertices = bits(AttributeOf::vertex);
  EXPECT_LT(of_vertices, as_numbers * 4 / 5);
  EXPECT_LT(bits(AttributeOf::corner), of_vertices + 4 * chart.positions.size());
}

TEST(DirectionLayer, RefusesWhatIsNoDirection) {
  const Chart chart = testing::cut(testing::torus(9, 6, 900));
  const LayerOrder order(chart);
  for (const AttributeOf of : kOwners) {
    const LayerShape shape = directions_of(of);
    const auto decode = [&](Bytes b) { (void)decode_layer(b, shape, chart, order); };
    LayerValues values = sample(chart, of, 20, 3);
    const Buffer blob = encode_layer(values, shape, chart, order);
    for (std::size_t size = 0; size < blob.size(); ++size)
      EXPECT_TRUE(testing::refuses(decode, Bytes(blob).first(size))) << size;
    for (std::size_t bit = 0; bit < 8 * blob.size(); ++bit) {
      Buffer damaged = blob;
      damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
      EXPECT_TRUE(testing::refuses(decode, damaged)) << bit;
    }
    values.absent.clear();
    values.numbers[0] = kUnit + 1, values.numbers[1] = 0;  // outside
    EXPECT_THROW((void)encode_layer(values, shape, chart, order), Error);
    values.numbers[0] = kUnit, values.numbers[1] = 0xffff;  // the other one of twins
    EXPECT_THROW((void)encode_layer(values, shape, chart, order), Error);
    EXPECT_THROW((void)encode_layer(values, {of, 2, 15, ValueKind::direction}, chart, order), Error);
  }
}

}  // namespace
}  // namespace ramcdb::codec
