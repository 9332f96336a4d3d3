#include "codec/polygon_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

using testing::refuses;

/// Each polygon as its vertices, begun at the least sequence; all of them sorted.
std::vector<std::vector<std::uint32_t>> cycles(const Polygons& polygons, const Chart& chart) {
  std::vector<std::vector<std::uint32_t>> all;
  std::size_t corner = 0;
  for (const std::uint32_t size : polygons.sizes) {
    std::vector<std::uint32_t> cycle, least;
    for (std::uint32_t i = 0; i < size; ++i, ++corner)
      cycle.push_back(chart.faces[polygons.corners[corner] / 3][polygons.corners[corner] % 3]);
    least = cycle;
    for (std::uint32_t i = 0; i < size; ++i) {
      std::rotate(cycle.begin(), cycle.begin() + 1, cycle.end());
      least = std::min(least, cycle);
    }
    all.push_back(least);
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Joins faces to polygons at random, across edges that no vertex closes up around.
Polygons random_polygons(const Chart& chart, std::uint32_t seed, std::uint32_t most) {
  const LayerOrder order(chart);
  std::mt19937 random(seed);
  std::vector<bool> taken(chart.faces.size(), false);
  Polygons polygons;
  polygons.of_face.assign(chart.faces.size(), 0);
  for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
    if (taken[f]) continue;
    taken[f] = true;
    std::vector<std::uint32_t> around{3 * f, 3 * f + 1, 3 * f + 2};
    std::set<std::uint32_t> vertices(chart.faces[f].begin(), chart.faces[f].end());
    const auto p = static_cast<std::uint32_t>(polygons.sizes.size());
    polygons.of_face[f] = p;
    for (std::size_t i = 0, size = 1; i < around.size() && size < most; ++i) {
      const std::uint32_t t = order.twin(around[i]);
      if (t == LayerOrder::kNone || taken[t / 3] || random() % 3 == 0) continue;
      const std::uint32_t apex = chart.faces[t / 3][LayerOrder::prev(t) % 3];
      if (!vertices.insert(apex).second) continue;
      taken[t / 3] = true;
      polygons.of_face[t / 3] = p;
      around[i] = LayerOrder::next(t);
      around.insert(around.begin() + static_cast<std::ptrdiff_t>(i) + 1, LayerOrder::prev(t));
      ++size;
    }
    polygons.sizes.push_back(static_cast<std::uint32_t>(around.size()));
    polygons.corners.insert(polygons.corners.end(), around.begin(), around.end());
  }
  return polygons;
}

void expect_round_trip(const Polygons& polygons, const Chart& chart, const std::string& name) {
  const LayerOrder order(chart);
  const Buffer blob = encode_polygons(polygons, chart, order);
  const Polygons decoded = decode_polygons(blob, chart, order);
  EXPECT_TRUE(cycles(decoded, chart) == cycles(polygons, chart)) << name;
  EXPECT_EQ(encode_polygons(decoded, chart, order), blob) << name;
}

TEST(PolygonBlob, PolygonsComeBackOnEveryChart) {
  std::vector<testing::NamedChart> charts = testing::manifold_charts();
  for (auto& chart : testing::broken_charts()) charts.push_back(std::move(chart));
  for (const auto& [name, chart] : charts)
    for (const std::uint32_t most : {1U, 2U, 3U, 40U})
      expect_round_trip(random_polygons(chart, most, most), chart, name);
}

TEST(PolygonBlob, PolygonsThatAreNoTreeAreListed) {
  // A ring of four triangles around a vertex, said to be a polygon of six corners that walks a slit twice; and two
  // triangles that share no edge.
  const Chart chart = testing::wheel(4, false);
  Polygons slit;
  slit.of_face = {0, 0, 0, 0};
  slit.sizes = {6};
  for (std::uint32_t c = 0; c < 6; ++c) slit.corners.push_back(c);
  expect_round_trip(slit, chart, "slit");
  Polygons apart;
  apart.of_face = {0, 1, 0, 2};
  apart.sizes = {4, 3, 3};
  apart.corners = {0, 1, 6, 7, 3, 4, 5, 9, 10, 11};
  expect_round_trip(apart, chart, "apart");
  Polygons other_way = random_polygons(chart, 1, 2);
  std::reverse(other_way.corners.begin(), other_way.corners.begin() + other_way.sizes[0]);
  expect_round_trip(other_way, chart, "other way round");
}

TEST(PolygonBlob, QuadsTakeLessThanHalfABitPerEdge) {
  const Chart chart = testing::cut(testing::terrain(60, 30, 1));
  const Buffer blob = encode_polygons(random_polygons(chart, 3, 2), chart, LayerOrder(chart));
  EXPECT_LT(16 * blob.size(), 3 * chart.faces.size());
}

TEST(PolygonBlob, RefusesDamage) {
  const Chart chart = testing::cut(testing::torus(9, 6, 900));
  const LayerOrder order(chart);
  Polygons polygons = random_polygons(chart, 7, 4);
  std::reverse(polygons.corners.begin(), polygons.corners.begin() + polygons.sizes[0]);  // one that is listed
  const Buffer blob = encode_polygons(polygons, chart, order);
  for (std::size_t size = 0; size < blob.size(); ++size)
    EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_polygons(b, chart, order); }, Bytes(blob).first(size))) << size;
  for (std::size_t bit = 0; bit < 8 * blob.size(); ++bit) {
    Buffer damaged = blob;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_polygons(b, chart, order); }, damaged)) << bit;
  }
  std::mt19937 random(4);
  for (int round = 0; round < 300; ++round) {
    Buffer bytes{1};
    for (std::size_t i = 0, size = random() % 200; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(random()));
    EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_polygons(b, chart, order); }, bytes));
  }
  polygons.sizes[0] += 1;
  EXPECT_THROW((void)encode_polygons(polygons, chart, order), Error);
}

}  // namespace
}  // namespace ramcdb::codec
