#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"
#include "tests/chartify/wire_net_checks.h"

namespace ramcdb::chartify::test {
namespace {

class WireNets : public testing::TestWithParam<Family> {
 protected:
  WireNets() : mesh_(canonical_order(on_lattice(GetParam().make())).mesh) {}
  [[nodiscard]] Charts cut(std::uint32_t target, Method method = Method::refined) const {
    Options options;
    options.target_faces = target;
    options.method = method;
    return chartify(mesh_, options);
  }
  IndexedMesh mesh_;
};

TEST_P(WireNets, HoldForEveryTargetAndMethod) {
  for (const Method method : {Method::refined, Method::paper})
    for (const std::uint32_t target : {1U, 7U, 50U, 120U, 300U, 5000U}) {
      SCOPED_TRACE(target);
      const Charts charts = cut(target, method);
      ASSERT_NO_FATAL_FAILURE(check_wire_net(mesh_, charts, build_wire_net(mesh_, charts)));
    }
}

/// Charts of an edit may be cut in any way: torn, pinched, with holes.
TEST_P(WireNets, HoldForChartsDrawnAtRandom) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Charts charts = cut(5000);
    charts.chart_count = 1 + seed;
    for (std::uint32_t& c : charts.chart_of_face) c = static_cast<std::uint32_t>(random() % charts.chart_count);
    for (std::uint32_t& c : charts.chart_of_isolated_vertex) c %= charts.chart_count;
    ASSERT_NO_FATAL_FAILURE(check_wire_net(mesh_, charts, build_wire_net(mesh_, charts)));
  }
}

TEST_P(WireNets, AreTheSameEveryTime) {
  const Charts charts = cut(120);
  const WireNet one = build_wire_net(mesh_, charts), two = build_wire_net(mesh_, charts);
  ASSERT_EQ(one.corners, two.corners);
  ASSERT_EQ(one.wires.size(), two.wires.size());
  for (std::size_t w = 0; w < one.wires.size(); ++w) {
    ASSERT_EQ(one.wires[w].vertices, two.wires[w].vertices);
    ASSERT_EQ(one.wires[w].charts, two.wires[w].charts);
  }
  for (std::size_t c = 0; c < one.charts.size(); ++c) {
    ASSERT_EQ(one.charts[c].chart, two.charts[c].chart);
    ASSERT_EQ(one.charts[c].mesh_vertex, two.charts[c].mesh_vertex);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, WireNets, testing::ValuesIn(all_families()),
                         [](const auto& family) { return std::string(family.param.name); });

/// All faces in one chart, whatever they hang on.
WireNet in_one_chart(const IndexedMesh& mesh) {
  Charts charts{1, std::vector<std::uint32_t>(mesh.faces.size(), 0), {}};
  const WireNet net = build_wire_net(mesh, charts);
  check_wire_net(mesh, charts, net);
  return net;
}

IndexedMesh canonical_of(const ramcdb::test::TestMesh& mesh) { return canonical_order(on_lattice(mesh)).mesh; }

TEST(WireNet, AClosedSurfaceInOneChartHasNoLoop) {
  for (const auto& mesh :
       {ramcdb::test::sphere(500), ramcdb::test::torus(500), ramcdb::test::genus3(500), ramcdb::test::boxes(20)}) {
    const WireNet net = in_one_chart(canonical_of(mesh));
    EXPECT_TRUE(net.charts[0].loops.empty());
    EXPECT_TRUE(net.wires.empty());
    EXPECT_TRUE(net.corners.empty());
    EXPECT_EQ(net.charts[0].chart.positions.size(), mesh.positions.size());
  }
}

TEST(WireNet, TheBorderOfAnOpenMeshIsOneClosedWire) {
  const IndexedMesh mesh = canonical_of(ramcdb::test::terrain(20, 30));
  const WireNet net = in_one_chart(mesh);
  ASSERT_EQ(net.wires.size(), 1U);
  ASSERT_EQ(net.corners.size(), 1U);
  EXPECT_EQ(net.wires[0].vertices.size(), 101U);  // 100 edges
  EXPECT_EQ(net.wires[0].charts, std::vector<std::uint32_t>{0});
}

/// A tetrahedron with a chart per face: every edge is a wire of two charts, every vertex a corner.
TEST(WireNet, OfATetrahedronInFourCharts) {
  const IndexedMesh mesh{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const Charts charts{4, {0, 1, 2, 3}, {}};
  const WireNet net = build_wire_net(mesh, charts);
  check_wire_net(mesh, charts, net);
  EXPECT_EQ(net.corners.size(), 4U);
  ASSERT_EQ(net.wires.size(), 6U);
  EXPECT_EQ(net.wires[0].vertices, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(net.wires[0].charts, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(net.wires[1].charts, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(net.wires[2].charts, (std::vector<std::uint32_t>{0, 1}));
}

/// A closed fan at a vertex with another fan is slit, once per box, and the slits do not tear the boxes apart.
TEST(WireNet, BoxesThatShareAVertexAreSlitThere) {
  const IndexedMesh mesh = canonical_of(ramcdb::test::hourglass());
  const WireNet net = in_one_chart(mesh);
  ASSERT_EQ(net.charts[0].loops.size(), 2U);
  EXPECT_EQ(net.charts[0].chart.loop_sizes, (std::vector<std::uint32_t>{4, 4}));
  EXPECT_EQ(mesh.positions.size(), 15U);
  EXPECT_EQ(net.charts[0].chart.positions.size(), 15U + 1 + 2);  // the vertex twice, and the middle of each slit
}

/// A sheet rolled up and glued to itself the wrong way round: the seam is a wire that one chart passes twice.
TEST(WireNet, AMoebiusStripPassesItsSeamTwice) {
  const IndexedMesh mesh = canonical_of(ramcdb::test::moebius());
  const WireNet net = in_one_chart(mesh);
  const auto twice = std::count_if(net.wires.begin(), net.wires.end(), [](const NetWire& wire) {
    return wire.charts == std::vector<std::uint32_t>{0, 0};
  });
  EXPECT_EQ(twice, 1);
}

/// Three sheets of one chart each: the line where they meet is one wire that all three pass.
TEST(WireNet, SheetsThatMeetAlongALineShareItsWire) {
  const IndexedMesh mesh = canonical_of(ramcdb::test::three_faces_one_edge());
  const Charts charts = chartify(mesh, {.target_faces = 1'000});
  const WireNet net = build_wire_net(mesh, charts);
  check_wire_net(mesh, charts, net);
  const auto shared =
      std::count_if(net.wires.begin(), net.wires.end(), [](const NetWire& wire) { return wire.charts.size() == 3; });
  EXPECT_EQ(shared, 1);
}

/// Quads that all stand twice, once from either side: four triangles meet at each diagonal, yet inside a quad it is no
/// border.
TEST(WireNet, DiagonalsOfDoubledQuadsAreNoWires) {
  constexpr std::uint32_t kSide = 6;
  IndexedMesh sheet;
  for (std::int32_t y = 0; y <= static_cast<std::int32_t>(kSide); ++y)
    for (std::int32_t x = 0; x <= static_cast<std::int32_t>(kSide); ++x) sheet.positions.push_back({x, y, x * y});
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t a = y * (kSide + 1) + x, b = a + 1, c = b + kSide + 1, d = c - 1;
      for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}, Triangle{a, c, b}, Triangle{a, d, c}})
        sheet.faces.push_back(t);
    }
  CanonicalMesh canonical = canonical_order(sheet);
  const std::size_t wires_of_triangles = in_one_chart(canonical.mesh).wires.size();
  for (const std::uint32_t f : canonical.source_face) canonical.mesh.polygon_of_face.push_back(f / 2);
  const WireNet net = in_one_chart(canonical.mesh);
  EXPECT_EQ(wires_of_triangles - net.wires.size(), kSide * kSide - 2);
  std::size_t diagonals = 0;
  for (const NetWire& wire : net.wires)
    for (std::size_t i = 1; i < wire.vertices.size(); ++i) {
      const LatticePoint p = canonical.mesh.positions[wire.vertices[i - 1]];
      const LatticePoint q = canonical.mesh.positions[wire.vertices[i]];
      diagonals += p.x != q.x && p.y != q.y;
    }
  EXPECT_EQ(diagonals, 2U) << "of the two corners of the sheet where both sides hang together all around the quad";
}

/// Two faces back to back share three edges; a degenerate face has an edge from a vertex to itself.
TEST(WireNet, OfFacesThatAreHardlySurfaces) {
  const std::vector<LatticePoint> points{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  EXPECT_TRUE(in_one_chart({points, {{0, 1, 2}, {0, 2, 1}}}).wires.empty());
  EXPECT_FALSE(in_one_chart({points, {{0, 1, 2}, {0, 1, 2}}}).wires.empty());
  EXPECT_FALSE(in_one_chart({points, {{0, 1, 2}, {0, 0, 1}}}).wires.empty());
  EXPECT_FALSE(in_one_chart({points, {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 2, 1}}}).wires.empty());
}

/// The only face on its edges: there and back along one edge, and around the edge from the first vertex to itself.
TEST(WireNet, OfALoneDegenerateFace) {
  const WireNet net = in_one_chart({{{0, 0, 0}, {9, 0, 0}}, {{0, 0, 1}}});
  EXPECT_EQ(net.charts[0].chart.loop_sizes, std::vector<std::uint32_t>{3});
  ASSERT_EQ(net.wires.size(), 2U);
  EXPECT_EQ(net.wires[0].vertices, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(net.wires[1].vertices, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(net.wires[1].charts, (std::vector<std::uint32_t>{0, 0}));
}

}  // namespace
}  // namespace ramcdb::chartify::test
