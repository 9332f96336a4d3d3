#include <algorithm>
#include <map>
#include <set>

#include "ramcdb/built_in_edits.h"
#include "ramcdb/error.h"
#include "tests/api/painted_grid.h"
#include "tests/api/whole_surface.h"

/// Regions with fewer faces.
namespace ramcdb::test {
namespace {

DecimateOptions to_ratio(double ratio) {
  DecimateOptions options;
  options.ratio = ratio;
  options.commit = message("decimate");
  options.commit.threads = 2;
  return options;
}

std::set<LatticePoint> points_of(const RegionMesh& mesh) { return {mesh.points.begin(), mesh.points.end()}; }

TEST(Decimate, TakesAShareOfAllFaces) {
  TempRepository repository(scan(8000), 600);
  const MeshInfo before = repository->snapshot().info();
  const std::set<LatticePoint> were = points_of(whole(repository->snapshot()));
  const CommitReport report = repository->decimate({}, kAll, to_ratio(0.5));
  const MeshInfo after = repository->snapshot().info();
  EXPECT_NEAR(static_cast<double>(after.faces), static_cast<double>(before.faces) * 0.5,
              static_cast<double>(before.faces) * 0.02);
  EXPECT_EQ(report.faces_removed - report.faces_added, before.faces - after.faces);
  EXPECT_EQ(report.vertices_added, 0U);
  EXPECT_EQ(report.vertices_moved, 0U);
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  EXPECT_EQ(after.nonmanifold_edges, 0U);
  const std::set<LatticePoint> are = points_of(whole(repository->snapshot()));
  EXPECT_TRUE(std::includes(were.begin(), were.end(), are.begin(), are.end()));
  EXPECT_EQ(repository->show("2").operation, "decimate");
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Decimate, LeavesTheBorderAndAllOtherCharts) {
  TempRepository repository(terrain(60, 60), 500);
  const Snapshot before = repository->snapshot();
  const Region region{{OfCharts{{ChartId(3)}}}, 0};
  const RegionMesh was = before.read({ChartId(3)});
  DecimateOptions options = to_ratio(1);
  options.faces = was.faces.size() * 6 / 10;
  const CommitReport report = repository->decimate({}, region, options);
  EXPECT_EQ(report.charts_reencoded, 1U);
  EXPECT_EQ(report.wires_reencoded, 0U);
  const Snapshot after = repository->snapshot();
  const RegionMesh is = after.read({ChartId(3)});
  EXPECT_NEAR(static_cast<double>(is.faces.size()), static_cast<double>(*options.faces), 3);
  const std::set<LatticePoint> are = points_of(is);
  for (std::size_t v = 0; v < was.points.size(); ++v)
    EXPECT_TRUE(was.keys[v].where == VertexKey::Where::chart || are.contains(was.points[v]));
  for (const ChartSummary& chart : after.describe(after.find(kAll)))
    EXPECT_EQ(chart.version.value, chart.id.value == 3 ? 2U : 1U);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Decimate, AllKindsOfMeshes) {
  for (const TestMesh& mesh : {sphere(800), torus(800), boxes(20), moebius(), two_cubes_sharing_edge(), hourglass(),
                               three_faces_one_edge(), degenerate_and_duplicate_faces(), isolated_vertices()})
    for (const std::uint32_t chart_faces : {60U, 100000U}) {
      TempRepository repository(mesh, chart_faces);
      const MeshInfo before = repository->snapshot().info();
      for (const double ratio : {0.6, 0.05, 0.0}) {
        (void)repository->decimate({}, kAll, to_ratio(ratio));
        const MeshInfo after = repository->snapshot().info();
        EXPECT_LE(after.faces, before.faces);
        EXPECT_EQ(after.nonmanifold_edges, before.nonmanifold_edges);
        EXPECT_EQ(after.isolated_vertices, before.isolated_vertices);
        EXPECT_TRUE(repository->verify({}).ok());
      }
    }
}

TEST(Decimate, NothingToTakeWritesNothing) {
  TempRepository repository(sphere(1000), 300);
  EXPECT_TRUE(repository->decimate({}, kAll, to_ratio(1)).nothing_changed);
  EXPECT_EQ(repository->resolve("HEAD").value, 1U);
  EXPECT_THROW((void)repository->decimate({}, kAll, to_ratio(1.5)), Error);
}

TEST(Decimate, WhatStaysKeepsItsValues) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  const mesh_file::MeshData grid = painted_grid(30);
  write_data(grid, folder / "a.ply", mesh_file::Scalar::float32);
  ImportOptions options;
  options.chart_faces = 400;
  (void)repository.import(folder / "a.ply", options);
  const RegionMesh was = whole(repository.snapshot());
  (void)repository.decimate({}, kAll, to_ratio(0.6));
  const RegionMesh is = whole(repository.snapshot());
  EXPECT_LT(is.faces.size(), was.faces.size());
  std::map<LatticePoint, std::size_t> at;
  for (std::size_t v = 0; v < was.points.size(); ++v) at.emplace(was.points[v], v);
  for (std::size_t a = 0; a < is.attributes.size(); ++a) {
    if (is.attributes[a].info.of != AttributeOf::vertex) continue;
    const std::size_t n = is.attributes[a].info.components;
    for (std::size_t v = 0; v < is.points.size(); ++v)
      for (std::size_t k = 0; k < n; ++k)
        EXPECT_EQ(is.attributes[a].values[v * n + k], was.attributes[a].values[at.at(is.points[v]) * n + k]);
  }
  EXPECT_TRUE(repository.verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
