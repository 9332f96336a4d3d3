#include "codec/fast_coder.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "codec/chart_codec.h"
#include "ramcdb/error.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"

namespace ramcdb::codec {
namespace {

const CoderTables kPlainTables;

FastContext context_of_fast_chart(const Chart& chart) {
  FastContext context;
  context.border = std::span(chart.positions).first(chart.border_count());
  context.loop_sizes = chart.loop_sizes;
  context.counts.faces = static_cast<std::uint32_t>(chart.faces.size());
  context.counts.inner_vertices = static_cast<std::uint32_t>(chart.positions.size()) - chart.border_count();
  context.box = testing::box_of(chart);
  context.tables = &kPlainTables;
  return context;
}

/// That the coder itself takes the chart and gives it back; without the raw coding that stands in for it elsewhere.
void expect_comes_back(const Chart& chart) {
  const FastContext context = context_of_fast_chart(chart);
  const auto stream = encode_fast(chart, context);
  ASSERT_TRUE(stream);
  const FastChart decoded = decode_fast(stream->bytes, context);
  EXPECT_EQ(decoded.positions, stream->coded.positions);
  EXPECT_EQ(decoded.faces, stream->coded.faces);

  ASSERT_EQ(decoded.faces.size(), chart.faces.size());
  ASSERT_EQ(decoded.positions.size(), chart.positions.size());
  std::set<std::uint32_t> vertices, faces;
  for (std::uint32_t v = 0; v < decoded.positions.size(); ++v) {
    const std::uint32_t source = stream->source_vertex[v];
    EXPECT_TRUE(vertices.insert(source).second);
    EXPECT_EQ(decoded.positions[v], chart.positions[source]);
    EXPECT_TRUE(source == v || v >= chart.border_count());
  }
  for (std::uint32_t f = 0; f < decoded.faces.size(); ++f) {
    const std::uint32_t corner = stream->source_corner[f];
    EXPECT_TRUE(faces.insert(corner / 3).second);
    for (std::uint32_t i = 0; i < 3; ++i)
      EXPECT_EQ(stream->source_vertex[decoded.faces[f][i]], chart.faces[corner / 3][(corner + i) % 3]);
  }
}

TEST(FastCoder, ManifoldChartsComeBack) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    SCOPED_TRACE(name);
    expect_comes_back(chart);
  }
}

TEST(FastCoder, RegionsOfAnyShapeComeBack) {
  const std::vector<testing::TestMesh> meshes{testing::torus(24, 14, 9000), testing::sphere(4, 500000000),
                                              testing::terrain(20, 40, 5)};
  for (std::uint32_t seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE(seed);
    const testing::TestMesh& mesh = meshes[seed % meshes.size()];
    std::mt19937 random(seed);
    const std::size_t size = 1 + random() % mesh.faces.size();
    expect_comes_back(
        testing::cut(mesh, testing::random_region(mesh, size, 1 + static_cast<int>(random() % 40), seed)));
  }
}

/// Faces taken at random: hardly a vertex is not on a border, loops run into each other everywhere.
TEST(FastCoder, ChartsThatAreNearlyAllBorderComeBack) {
  const std::vector<testing::TestMesh> meshes{testing::torus(16, 10, 9000), testing::sphere(3, 100000),
                                              testing::terrain(14, 40, 5)};
  for (std::uint32_t seed = 1; seed <= 900; ++seed) {
    SCOPED_TRACE(seed);
    const testing::TestMesh& mesh = meshes[seed % meshes.size()];
    std::mt19937 random(seed);
    const std::uint32_t kept = 1 + static_cast<std::uint32_t>(random() % 20);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      if (random() % 20 < kept) faces.push_back(f);
    expect_comes_back(testing::cut(mesh, faces));
  }
}

/// More than the coder looks at when it looks for the nearest one; some lie on the same point.
TEST(FastCoder, IsolatedVerticesComeBack) {
  for (const bool with_faces : {false, true}) {
    Chart chart;
    if (with_faces) chart = testing::cut(testing::terrain(14, 40, 5));
    std::mt19937 random(7);
    for (int i = 0; i < 700; ++i) {
      const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 9) * 100000 - 400000; };
      chart.positions.push_back({coordinate(), coordinate(), coordinate()});
    }
    expect_comes_back(chart);
  }
}

}  // namespace
}  // namespace ramcdb::codec
