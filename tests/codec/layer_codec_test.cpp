#include "codec/layer_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "codec/chart_codec.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

using testing::NamedChart;
using testing::refuses;

constexpr AttributeOf kKinds[] = {AttributeOf::vertex, AttributeOf::corner, AttributeOf::face};

std::vector<NamedChart> all_charts() {
  std::vector<NamedChart> charts = testing::manifold_charts();
  for (NamedChart& chart : testing::broken_charts()) charts.push_back(std::move(chart));
  for (std::uint32_t seed = 1; seed < 6; ++seed)
    charts.push_back({"soup " + std::to_string(seed), testing::triangle_soup(seed)});
  return charts;
}

std::uint64_t mask(unsigned bits) { return ~std::uint64_t{0} >> (64 - bits); }

/// Numbers that follow position, with noise of so many bits, and some absent.
LayerValues sample(const Chart& chart, const LayerShape& shape, unsigned noise, unsigned absent, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  LayerValues values;
  const std::size_t count = value_count(chart, shape.of);
  const auto at = [&](std::size_t i) -> LatticePoint {
    const std::size_t v = shape.of == AttributeOf::vertex   ? i
                          : shape.of == AttributeOf::corner ? chart.faces[i / 3][i % 3]
                                                            : chart.faces[i][0];
    return chart.positions[v];
  };
  for (std::size_t i = 0; i < count; ++i)
    for (unsigned k = 0; k < shape.components; ++k)
      values.numbers.push_back((static_cast<std::uint64_t>(std::int64_t{at(i)[static_cast<int>(k % 3)]} * (k + 1)) +
                                (noise ? random() & mask(noise) : 0)) &
                               mask(shape.bits));
  if (absent) {
    for (std::size_t i = 0; i < count; ++i) {
      values.absent.push_back(random() % 100 < absent);
      if (values.absent[i])
        std::fill_n(values.numbers.begin() + static_cast<std::ptrdiff_t>(i * shape.components), shape.components, 0);
    }
    if (std::find(values.absent.begin(), values.absent.end(), true) == values.absent.end()) values.absent.clear();
  }
  return values;
}

TEST(Layer, ComesBackOnEveryChart) {
  constexpr std::pair<int, int> kSizes[] = {{1, 1}, {3, 8}, {2, 20}, {4, 32}, {16, 64}};
  constexpr unsigned kAbsent[] = {0, 30, 100};
  std::uint32_t round = 0;
  for (const auto& [name, chart] : all_charts()) {
    const LayerOrder order(chart);
    for (const AttributeOf of : kKinds)
      for (int again = 0; again < 3; ++again, ++round) {
        const auto [components, bits] = kSizes[round % 5];
        const LayerShape shape{of, static_cast<std::uint8_t>(components), static_cast<std::uint8_t>(bits),
                               components == 3 ? ValueKind::color : ValueKind::numbers};
        const LayerValues values = sample(chart, shape, static_cast<unsigned>(bits) / 2, kAbsent[round % 3], round);
        const Buffer blob = encode_layer(values, shape, chart, order);
        ASSERT_TRUE(decode_layer(blob, shape, chart, order) == values) << name << ' ' << components << ' ' << bits;
        ASSERT_EQ(encode_layer(values, shape, chart, order), blob) << name;
      }
  }
}

TEST(Layer, ExtremeNumbersComeBack) {
  const Chart chart = testing::cut(testing::terrain(9, 30, 1));
  const LayerOrder order(chart);
  for (unsigned bits = 1; bits <= 64; ++bits) {
    const LayerShape shape{AttributeOf::vertex, 1, static_cast<std::uint8_t>(bits)};
    LayerValues values;
    for (std::size_t v = 0; v < chart.positions.size(); ++v)
      values.numbers.push_back(v % 3 == 0 ? mask(bits) : v % 3 == 1 ? 0 : mask(bits) / 2 + 1);
    EXPECT_TRUE(decode_layer(encode_layer(values, shape, chart, order), shape, chart, order) == values) << bits;
  }
}

/// The same surface, other inner positions: decoded charts number inner vertices and faces otherwise.
TEST(Layer, MovedVerticesLeaveTheBytesAlone) {
  const LatticeBox range{{-4000, -4000, -4000}, {4000, 4000, 4000}};
  std::mt19937 random(9);
  for (const testing::TestMesh& mesh : {testing::terrain(24, 200, 1), testing::terrain(31, 10, 2)}) {
    const Chart before = encode_chart(testing::cut(mesh), Profile::dense, {}, range).decoded;
    Chart moved = before;
    for (std::size_t v = moved.border_count(); v < moved.positions.size(); ++v)
      for (int a = 0; a < 3; ++a) moved.positions[v][a] += static_cast<std::int32_t>(random() % 400);
    const EncodedChart after = encode_chart(moved, Profile::dense, {}, range);
    ASSERT_NE(after.decoded.faces, before.faces) << "the walk should differ, or this shows nothing";
    const LayerShape shape{AttributeOf::vertex, 1, 32};
    LayerValues values = sample(before, shape, 5, 0, 1), same = values;
    for (std::size_t v = 0; v < after.source_vertex.size(); ++v)
      same.numbers[v] = values.numbers[after.source_vertex[v]];
    EXPECT_TRUE(encode_layer(values, shape, before, LayerOrder(before)) ==
                encode_layer(same, shape, after.decoded, LayerOrder(after.decoded)));
  }
}

std::size_t bits_of(const LayerValues& values, const LayerShape& shape, const Chart& chart) {
  return 8 * encode_layer(values, shape, chart, LayerOrder(chart)).size();
}

TEST(Layer, SmoothAndEqualValuesAreCheap) {
  const Chart chart = testing::cut(testing::terrain(60, 3, 1));
  const std::size_t vertices = chart.positions.size();
  LayerValues equal{std::vector<std::uint64_t>(3 * vertices, 77), {}};
  EXPECT_LT(bits_of(equal, {AttributeOf::vertex, 3, 8, ValueKind::color}, chart), vertices / 5);
  // Linear in the plane: the neighbours' mean says it all.
  const LayerShape plane{AttributeOf::vertex, 1, 32};
  EXPECT_LT(bits_of(sample(chart, plane, 0, 0, 1), plane, chart), 6 * vertices);
  // Texture coordinates per corner without a seam cost as much as per vertex and a little more.
  const LayerShape corners{AttributeOf::corner, 2, 20}, smooth{AttributeOf::vertex, 2, 20};
  EXPECT_LT(bits_of(sample(chart, corners, 0, 0, 1), corners, chart),
            bits_of(sample(chart, smooth, 0, 0, 1), smooth, chart) + 3 * vertices);
  // Two materials, half and half.
  LayerValues halves;
  for (const Triangle& face : chart.faces) halves.numbers.push_back(chart.positions[face[0]].x > 0);
  EXPECT_LT(bits_of(halves, {AttributeOf::face, 1, 32}, chart), chart.faces.size() / 3);
}

TEST(Layer, RefusesEveryPrefixAndEveryFlippedBit) {
  const Chart chart = testing::cut(testing::torus(9, 6, 900));
  const LayerOrder order(chart);
  for (const AttributeOf of : kKinds) {
    const LayerShape shape{of, 3, 12, ValueKind::color};
    const LayerValues values = sample(chart, shape, 3, 20, 1);
    const Buffer blob = encode_layer(values, shape, chart, order);
    for (std::size_t size = 0; size < blob.size(); ++size)
      EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_layer(b, shape, chart, order); }, Bytes(blob).first(size)))
          << size;
    for (std::size_t bit = 0; bit < 8 * blob.size(); ++bit) {
      Buffer damaged = blob;
      damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
      EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_layer(b, shape, chart, order); }, damaged)) << bit;
    }
    Buffer longer = blob;
    longer.push_back(0);
    EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_layer(b, shape, chart, order); }, longer));
    const Chart other = testing::cut(testing::torus(9, 7, 900));
    EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_layer(b, shape, other, LayerOrder(other)); }, blob));
  }
}

TEST(Layer, RandomBytesDecodeToNothing) {
  const Chart chart = testing::cut(testing::sphere(2, 1000));
  const LayerOrder order(chart);
  std::mt19937 random(4);
  for (int round = 0; round < 300; ++round) {
    Buffer blob{1, static_cast<std::uint8_t>(random() % 2)};
    for (std::size_t i = 0, size = random() % 300; i < size; ++i) blob.push_back(static_cast<std::uint8_t>(random()));
    for (const AttributeOf of : kKinds)
      EXPECT_TRUE(refuses([&](Bytes b) { (void)decode_layer(b, {of, 2, 64}, chart, order); }, blob));
  }
}

TEST(Layer, RefusesValuesThatAreNotTheCharts) {
  const Chart chart = testing::one_triangle();
  const LayerOrder order(chart);
  EXPECT_THROW((void)encode_layer({{1, 2}, {}}, {AttributeOf::vertex, 1, 8}, chart, order), Error);
  EXPECT_THROW((void)encode_layer({{1, 2, 256}, {}}, {AttributeOf::vertex, 1, 8}, chart, order), Error);
  EXPECT_THROW((void)encode_layer({{1, 2, 3}, {true}}, {AttributeOf::vertex, 1, 8}, chart, order), Error);
  EXPECT_THROW((void)encode_layer({{1, 2, 3}, {}}, {AttributeOf::vertex, 1, 65}, chart, order), Error);
}

TEST(LayerOrder, VisitsEverythingOnce) {
  for (const auto& [name, chart] : all_charts()) {
    const LayerOrder order(chart);
    std::vector<std::uint32_t> vertices = order.vertices(), faces;
    for (const std::uint32_t entry : order.entries()) faces.push_back(entry / 3);
    std::sort(vertices.begin(), vertices.end());
    std::sort(faces.begin(), faces.end());
    std::vector<std::uint32_t> expected_vertices(chart.positions.size()), expected_faces(chart.faces.size());
    std::iota(expected_vertices.begin(), expected_vertices.end(), 0U);
    std::iota(expected_faces.begin(), expected_faces.end(), 0U);
    EXPECT_EQ(vertices, expected_vertices) << name;
    EXPECT_EQ(faces, expected_faces) << name;
  }
}

/// On charts that are no manifold surface, too, faces have neighbours: another side of the same edge each.
TEST(LayerOrderTest, TwinsLieAtTheSameEdgeOfAnotherFace) {
  std::size_t twins = 0;
  for (const NamedChart& named : all_charts()) {
    SCOPED_TRACE(named.name);
    const Chart& chart = named.chart;
    const LayerOrder order(chart);
    EXPECT_EQ(order.entries().size(), chart.faces.size());
    EXPECT_EQ(order.vertices().size(), chart.positions.size());
    const auto origin = [&](std::uint32_t c) { return chart.faces[c / 3][c % 3]; };
    for (std::uint32_t c = 0; c < 3 * chart.faces.size(); ++c) {
      const std::uint32_t twin = order.twin(c);
      if (twin == LayerOrder::kNone) continue;
      ++twins;
      EXPECT_EQ(order.twin(twin), c);
      EXPECT_NE(twin / 3, c / 3);
      EXPECT_EQ(origin(twin), origin(LayerOrder::next(c)));
      EXPECT_EQ(origin(c), origin(LayerOrder::next(twin)));
    }
  }
  EXPECT_GT(twins, 1000U);
}

}  // namespace
}  // namespace ramcdb::codec
