#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "ramcdb/built_in_edits.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/painted_grid.h"
#include "tests/api/plain_smoothing.h"
#include "tests/api/whole_surface.h"

/// Smoothing that streams over charts does to a mesh what smoothing in memory does, and touches nothing else.
namespace ramcdb::test {
namespace {

SmoothOptions times(unsigned iterations, double lambda = 0.5) {
  SmoothOptions options;
  options.iterations = iterations;
  options.lambda = lambda;
  options.commit.message = "smooth";
  options.commit.author = "test";
  return options;
}

/// Names in the repository's folder.
std::set<std::string> names_in(const Repository& repository) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(repository.folder()))
    names.insert(entry.path().filename().string());
  return names;
}

struct Shape {
  const char* name;
  TestMesh (*make)();
};

class SmoothOf : public testing::TestWithParam<Shape> {};

TEST_P(SmoothOf, IsWhatSmoothingInMemoryIsHoweverTheMeshWasCut) {
  FaceSet first;
  for (const std::uint32_t chart_faces : {300U, 1000U, 5000U}) {
    TempRepository repository(GetParam().make(), chart_faces);
    const RegionMesh before = whole(repository->snapshot());
    const FaceSet expected = face_set(smoothed(before, 7, 0.6), before.faces);
    const CommitReport report = repository->smooth({}, kAll, times(7, 0.6));
    EXPECT_TRUE(report.conflicts.empty());
    EXPECT_EQ(surface(*repository), expected) << chart_faces;
    if (first.empty()) first = expected;
    EXPECT_EQ(expected, first) << chart_faces;
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SmoothOf,
    testing::Values(Shape{"Scan", [] { return scan(6000); }}, Shape{"Genus3", [] { return genus3(4000); }},
                    Shape{"Terrain", [] { return terrain(60, 50); }}, Shape{"Boxes", [] { return boxes(120); }},
                    Shape{"Torus", [] { return torus(3000); }}, Shape{"Several", [] { return several_components(); }},
                    Shape{"Moebius", [] { return moebius(); }}, Shape{"Hourglass", [] { return hourglass(); }},
                    Shape{"TwoCubesSharingEdge", [] { return two_cubes_sharing_edge(); }},
                    Shape{"ThreeFacesOneEdge", [] { return three_faces_one_edge(); }},
                    Shape{"DegenerateAndDuplicate", [] { return degenerate_and_duplicate_faces(); }},
                    Shape{"IsolatedVertices", [] { return isolated_vertices(); }}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST(Smooth, IsTheTextbooksUpToRounding) {
  TempRepository repository(scan(6000), 300, 16);
  const Snapshot base = repository->snapshot();
  const RegionMesh before = whole(base);
  const std::vector<Point> textbook = smoothed_in_doubles(before, base.lattice(), 20, 0.5);
  const std::vector<LatticePoint> ours = smoothed(before, 20, 0.5);
  for (std::size_t v = 0; v < ours.size(); ++v)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(base.position(ours[v])[a], textbook[v][a], base.lattice().step * 0.50001);
}

TEST(Smooth, ThreadsAndMemoryChangeNoByte) {
  std::vector<Buffer> first;
  for (const unsigned threads : {1U, 2U, 5U})
    for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{1} << 30}) {
      TempRepository repository(scan(6000), 300);
      SmoothOptions options = times(5);
      options.commit.threads = threads;
      options.memory = memory;
      const CommitReport report = repository->smooth({}, kAll, options);
      EXPECT_EQ(report.charts_reencoded, repository->snapshot().info().charts);
      const std::vector<Buffer> blobs = blobs_of(*repository, "mesh");
      if (first.empty()) first = blobs;
      EXPECT_TRUE(blobs == first) << threads << " threads, " << memory << " bytes";
    }
}

TEST(Smooth, ARegionsBorderAndAllOutsideStay) {
  TempRepository repository(scan(8000), 300);
  const Snapshot base = repository->snapshot();
  const std::vector<ChartId> charts = base.find({{OfCharts{{ChartId(4)}}}, 1});
  ASSERT_LT(charts.size(), base.info().charts);
  const RegionMesh before = base.read(charts);
  const CommitReport report = repository->smooth({}, {{OfCharts{charts}}, 0}, times(10));
  EXPECT_EQ(report.charts_reencoded, charts.size());
  EXPECT_EQ(report.charts_touched, charts.size());
  const Snapshot after = repository->snapshot();
  EXPECT_EQ(surface(after.read(charts)), face_set(smoothed(before, 10, 0.5), before.faces));
  std::vector<ChartId> outside;
  for (std::uint32_t id = 1; id <= base.info().charts; ++id)
    if (!std::ranges::binary_search(charts, ChartId(id))) outside.push_back(ChartId(id));
  EXPECT_EQ(after.read(outside).points, base.read(outside).points);
  for (const ChartSummary& chart : after.describe(outside)) EXPECT_EQ(chart.version, base.version());
  EXPECT_EQ(repository->diff(base, after).vertices_moved, report.vertices_moved);
  EXPECT_NEAR(repository->diff(base, after).max_displacement, report.max_displacement, 1e-12);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Smooth, WhatWouldMoveNothingWritesNothing) {
  TestMesh flat = terrain(30, 30);
  for (Point& p : flat.positions) p.z = 0;
  TempRepository repository(flat, 300, 5);
  const CommitReport report = repository->smooth({}, kAll, times(1, 0.001));
  EXPECT_TRUE(report.nothing_changed);
  EXPECT_EQ(report.revision, VersionId(1));
  EXPECT_EQ(repository->log().size(), 1U);
}

TEST(Smooth, LosslessMeshesKeepWhatStaysToTheLastBit) {
  FaceSet first;
  for (const std::uint32_t chart_faces : {300U, 5000U}) {
    const TempFolder folder;
    Repository::create(folder / "r.ramcdb");
    Repository repository = Repository::open(folder / "r.ramcdb");
    write_test_mesh(terrain(50, 50), folder / "in.ply");
    ImportOptions options;
    options.lossless = true;
    options.chart_faces = chart_faces;
    (void)repository.import(folder / "in.ply", options);
    const Snapshot base = repository.snapshot();
    const RegionMesh before = whole(base);
    ASSERT_FALSE(before.exact.empty());
    EXPECT_FALSE(repository.smooth({}, kAll, times(3)).nothing_changed);
    const Snapshot after_edit = repository.snapshot();
    const RegionMesh after = whole(after_edit);
    // Shared vertices keep their keys, and with them their numbers; the border stays.
    const std::vector<bool> fixed = fixed_vertices(before);
    const auto sorted = [](std::vector<Point> points) {
      std::ranges::sort(points, {}, [](const Point& p) { return std::array{p.x, p.y, p.z}; });
      return points;
    };
    std::vector<Point> stay;
    for (std::size_t v = 0; v < before.exact.size(); ++v)
      if (fixed[v]) stay.push_back(before.exact[v]);
    const auto less = [](const Point& a, const Point& b) {
      return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    };
    const std::vector<Point> now = sorted(after.exact), kept = sorted(stay);
    EXPECT_TRUE(std::includes(now.begin(), now.end(), kept.begin(), kept.end(), less));
    // Snapped to a common grid, since lattices of lossless meshes are as fine as numbers are.
    std::vector<LatticePoint> grid;
    const Lattice coarse{{0, 0, 0}, 1e-6, 0};
    for (const Point& p : after.exact) grid.push_back(coarse.snap(p));
    const FaceSet faces = face_set(grid, after.faces);
    if (first.empty()) first = faces;
    EXPECT_EQ(faces, first);
    EXPECT_TRUE(repository.verify({}).ok());
  }
}

TEST(Smooth, AttributesStayAndNormalsAreNamed) {
  const mesh_file::MeshData mesh = painted_grid(50);
  Painted repository(mesh);
  const std::size_t layers = repository.written(VersionId(1), db::Kind::attribute);
  ASSERT_GT(layers, 0U);
  const CommitReport report = repository->smooth({}, kAll, times(4));
  EXPECT_GT(report.charts_reencoded, 0U);
  EXPECT_EQ(report.layers_reencoded, 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::attribute), 0U);
  EXPECT_EQ(report.normals_left, std::vector<std::string>{"normal"});
  EXPECT_TRUE(repository->verify({}).ok());
}

/// Moves a vertex of a chart.
void push_vertex(Repository& repository, std::uint32_t chart) {
  auto edit = repository.begin_edit();
  Patch& patch = edit.checkout({{OfCharts{{ChartId(chart)}}}, 0});
  for (const auto v : patch.mesh().all_vertices())
    if (!patch.on_outer_border(v)) {
      patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(0, 0, 30 * edit.base().lattice().step));
      break;
    }
  (void)edit.commit(message("nudge"));
}

TEST(Smooth, ACommitMeanwhileWins) {
  TempRepository repository(scan(6000), 300);
  SmoothOptions options = times(3);
  FaceSet committed;
  options.commit.progress = [&](std::string_view stage, double) {
    if (stage != "encode" || !committed.empty()) return;
    push_vertex(*repository, 4);
    committed = surface(*repository);
  };
  const CommitReport report = repository->smooth({}, kAll, options);
  EXPECT_EQ(report.conflicts, std::vector<ChartId>{ChartId(4)});
  EXPECT_EQ(surface(*repository), committed);
  EXPECT_EQ(repository->log().size(), 2U);
}

TEST(Smooth, ACommitElsewhereMeanwhileStays) {
  TempRepository repository(scan(6000), 300);
  const Region region{{OfCharts{{ChartId(2)}}}, 0};
  SmoothOptions options = times(3);
  bool committed = false;
  options.commit.progress = [&](std::string_view stage, double) {
    if (stage == "smooth" && !std::exchange(committed, true)) push_vertex(*repository, 9);
  };
  const CommitReport report = repository->smooth({}, region, options);
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(report.parent, VersionId(2));
  const auto changed = repository->diff(repository->snapshot({}, "1"), repository->snapshot()).changed;
  EXPECT_EQ(changed, (std::vector<ChartId>{ChartId(2), ChartId(9)}));
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Smooth, CancelledAtAnyStageLeavesNothing) {
  TempRepository repository(scan(6000), 300);
  const FaceSet before = surface(*repository);
  const auto names = names_in(*repository);
  for (const std::string stage : {"read", "smooth", "encode", "write"}) {
    SmoothOptions options = times(3);
    options.memory = 1;
    bool reached = false;
    options.commit.progress = [&](std::string_view now, double done) {
      if (now != stage || done == 0) return;
      reached = true;
      throw Error(Errc::cancelled, "enough");
    };
    EXPECT_THROW((void)repository->smooth({}, kAll, options), Error);
    EXPECT_TRUE(reached) << stage;
    EXPECT_EQ(names_in(*repository), names) << stage;
    EXPECT_EQ(repository->log().size(), 1U);
  }
  EXPECT_EQ(surface(*repository), before);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Smooth, SweepsWhatAKilledOneLeft) {
  TempRepository repository(scan(2000), 300);
  const auto names = names_in(*repository);
  std::ofstream(repository->folder() / "scratch-abcdef") << "left";
  (void)repository->smooth({}, kAll, times(1));
  EXPECT_EQ(names_in(*repository), names);
}

TEST(Smooth, RefusesOptionsOutOfRange) {
  TempRepository repository(scan(1000), 300);
  EXPECT_THROW((void)repository->smooth({}, kAll, times(0)), Error);
  for (const double lambda : {0.0, -0.5, 1.5, std::nan("")})
    EXPECT_THROW((void)repository->smooth({}, kAll, times(1, lambda)), Error) << lambda;
  EXPECT_EQ(repository->log().size(), 1U);
}

}  // namespace
}  // namespace ramcdb::test
