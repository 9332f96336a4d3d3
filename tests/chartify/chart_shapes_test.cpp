#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chartify/hilbert_cells.h"
#include "ramcdb/error.h"
#include "tests/chartify/chart_checks.h"

namespace ramcdb::chartify::test {
namespace {

using ramcdb::test::TestMesh;

struct Case {
  const char* name;
  TestMesh (*make)();
};

/// Three rings around a hub with very many spokes.
TestMesh hub() {
  constexpr std::uint32_t kSpokes = 3000, kRings = 3;
  TestMesh mesh;
  mesh.positions.push_back({0, 0, 1});
  for (std::uint32_t ring = 1; ring <= kRings; ++ring)
    for (std::uint32_t i = 0; i < kSpokes; ++i) {
      const double angle = 2 * 3.14159265358979 * i / kSpokes;
      mesh.positions.push_back({ring * std::cos(angle), ring * std::sin(angle), 0});
    }
  const auto vertex = [](std::uint32_t ring, std::uint32_t i) { return 1 + ring * kSpokes + i % kSpokes; };
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    mesh.faces.push_back({0, vertex(0, i), vertex(0, i + 1)});
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring) {
      mesh.faces.push_back({vertex(ring, i), vertex(ring + 1, i), vertex(ring + 1, i + 1)});
      mesh.faces.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring, i + 1)});
    }
  }
  return mesh;
}

std::string name_of(const testing::TestParamInfo<std::tuple<Case, Method>>& info) {
  return std::string(std::get<0>(info.param).name) +
         (std::get<1>(info.param) == Method::paper ? "ByThePaper" : "Refined");
}

/// Meshes of every shape, by both methods, cut coarse and fine.
class ChartShapes : public testing::TestWithParam<std::tuple<Case, Method>> {};

/// Faces scattered over charts, and all in one.
void check_foreign_cuts(const IndexedMesh& mesh, const Options& options) {
  std::vector<std::uint32_t> scattered, one(mesh.faces.size(), 0);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) scattered.push_back(f * 7 % 5);
  check_charts(mesh, refine_cut(mesh, scattered, options));
  check_charts(mesh, refine_cut(mesh, one, options));
}

TEST_P(ChartShapes, EveryFaceInOneConnectedChart) {
  const IndexedMesh mesh = canonical(std::get<0>(GetParam()).make());
  Options options;
  options.method = std::get<1>(GetParam());
  for (const std::uint32_t target : {1U, 2U, 3U, 10U, 100U, 1000U, 5000U}) {
    SCOPED_TRACE(target);
    options.target_faces = target;
    check_charts(mesh, chartify(mesh, options));
    if (options.method == Method::refined) check_foreign_cuts(mesh, options);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ChartShapes,
    testing::Combine(testing::Values(Case{"Sphere", [] { return ramcdb::test::sphere(5000); }},
                                     Case{"Torus", [] { return ramcdb::test::torus(5000); }},
                                     Case{"Genus3", [] { return ramcdb::test::genus3(5000); }},
                                     Case{"Terrain", [] { return ramcdb::test::terrain(50, 50); }},
                                     Case{"Strip", [] { return ramcdb::test::terrain(1, 3000); }}, Case{"Hub", hub},
                                     Case{"Scan", [] { return ramcdb::test::scan(6000); }},
                                     Case{"Boxes", [] { return ramcdb::test::boxes(300); }},
                                     Case{"SeveralComponents", [] { return ramcdb::test::several_components(); }},
                                     Case{"Moebius", [] { return ramcdb::test::moebius(); }},
                                     Case{"TwoCubesSharingEdge", [] { return ramcdb::test::two_cubes_sharing_edge(); }},
                                     Case{"Hourglass", [] { return ramcdb::test::hourglass(); }},
                                     Case{"ThreeFacesOneEdge", [] { return ramcdb::test::three_faces_one_edge(); }},
                                     Case{"DegenerateAndDuplicate",
                                          [] { return ramcdb::test::degenerate_and_duplicate_faces(); }},
                                     Case{"IsolatedVertices", [] { return ramcdb::test::isolated_vertices(); }}),
                     testing::Values(Method::refined, Method::paper)),
    name_of);

TEST(ChartEdgeCases, EmptyMesh) {
  for (const Method method : {Method::refined, Method::paper}) {
    Options options;
    options.method = method;
    const Charts charts = chartify(IndexedMesh{}, options);
    EXPECT_EQ(charts.chart_count, 0U);
    EXPECT_TRUE(charts.chart_of_face.empty());
    EXPECT_TRUE(charts.chart_of_isolated_vertex.empty());
  }
}

TEST(ChartEdgeCases, AForeignCutMustBeOne) {
  const IndexedMesh mesh = canonical(ramcdb::test::sphere(500));
  Options options;
  options.target_faces = 100;
  std::vector<std::uint32_t> cut(mesh.faces.size() - 1, 0);
  EXPECT_THROW((void)refine_cut(mesh, cut, options), Error);
  cut.push_back(~std::uint32_t{0});
  EXPECT_THROW((void)refine_cut(mesh, cut, options), Error);
  cut.back() = 0;
  options.target_faces = 0;
  EXPECT_THROW((void)refine_cut(mesh, cut, options), Error);
}

TEST(ChartEdgeCases, OneFace) {
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const std::uint32_t target : {1U, 2U, 3U, 5000U}) {
    Options options;
    options.target_faces = target;
    const Charts charts = chartify(mesh, options);
    EXPECT_EQ(charts.chart_count, 1U);
    EXPECT_EQ(charts.chart_of_face, std::vector<std::uint32_t>{0});
  }
}

TEST(ChartEdgeCases, AllFacesOnOnePoint) {
  IndexedMesh mesh;
  mesh.positions.assign(102, {7, 7, 7});
  for (std::uint32_t f = 0; f < 100; ++f)
    mesh.faces.push_back(f % 2 ? Triangle{f, f + 2, f + 1} : Triangle{f, f + 1, f + 2});
  for (const Method method : {Method::refined, Method::paper}) {
    Options options;
    options.method = method;
    options.target_faces = 10;
    check_charts(mesh, chartify(mesh, options));
  }
}

TEST(ChartEdgeCases, ExtremePositions) {
  TestMesh terrain = ramcdb::test::terrain(30, 30);
  IndexedMesh mesh{ramcdb::test::snap_to_bits(terrain, 30), terrain.faces};
  mesh = canonical_order(mesh).mesh;
  for (const Method method : {Method::refined, Method::paper}) {
    Options options;
    options.method = method;
    options.target_faces = 100;
    check_charts(mesh, chartify(mesh, options));
  }
}

std::vector<LatticePoint> row_of_points(std::int32_t count) {
  std::vector<LatticePoint> points;
  for (std::int32_t i = 0; i < count; ++i) points.push_back({i, 0, 0});
  return points;
}

TEST(IsolatedVertices, AloneFillChartsOfFourTargets) {
  const IndexedMesh mesh{row_of_points(90), {}};
  Options options;
  options.target_faces = 10;
  const Charts charts = chartify(mesh, options);
  check_charts(mesh, charts);
  EXPECT_EQ(charts.chart_count, 3U);
  std::vector<std::uint32_t> expected(40, 0);
  expected.insert(expected.end(), 40, 1);
  expected.insert(expected.end(), 10, 2);
  EXPECT_EQ(charts.chart_of_isolated_vertex, expected);
}

TEST(IsolatedVertices, JoinTheFaceBeforeThemOnTheCurve) {
  const IndexedMesh mesh = canonical(ramcdb::test::isolated_vertices());
  Options options;
  options.target_faces = 20;
  const Charts charts = chartify(mesh, options);
  check_charts(mesh, charts);
  const auto isolated = static_cast<std::uint32_t>(charts.chart_of_isolated_vertex.size());
  ASSERT_GT(isolated, 10U);
  const HilbertCells cells(mesh);
  for (std::uint32_t i = 0; i < isolated; ++i) {
    const auto vertex = static_cast<std::uint32_t>(mesh.positions.size() - isolated + i);
    std::uint32_t before = 0;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      if (cells.key_of_face(f) <= cells.key_of_vertex(vertex)) before = f;
    EXPECT_EQ(charts.chart_of_isolated_vertex[i], charts.chart_of_face[before]);
  }
}

TEST(IsolatedVertices, VeryManyBesideOneFaceGetChartsOfTheirOwn) {
  IndexedMesh mesh{row_of_points(1000), {{0, 1, 2}}};
  mesh = canonical_order(mesh).mesh;
  Options options;
  options.target_faces = 10;
  const Charts charts = chartify(mesh, options);
  check_charts(mesh, charts);
  std::vector<std::uint32_t> count(charts.chart_count, 0);
  for (const std::uint32_t c : charts.chart_of_isolated_vertex) ++count[c];
  EXPECT_EQ(charts.chart_count, 25U);
  EXPECT_LE(*std::max_element(count.begin(), count.end()), 40U);
}

}  // namespace
}  // namespace ramcdb::chartify::test
