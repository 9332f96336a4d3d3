#include <gtest/gtest.h>

#include <algorithm>

#include "ramcdb/edit_transaction.h"
#include "tests/api/painted_grid.h"

/// A mesh coded anew is the same mesh, in the profile that was asked for, at every version.
namespace ramcdb::test {
namespace {

FaceSet faces_at(Repository& repository, std::string_view revision = {}) {
  const Snapshot snapshot = repository.snapshot({}, revision);
  const RegionMesh region = snapshot.read(snapshot.find({{WholeMesh{}}, 0}));
  return face_set(region.points, region.faces);
}

RepackOptions as(ChartProfile profile) {
  RepackOptions options;
  options.profile = profile;
  options.threads = 2;
  return options;
}

/// Moves some vertices of a chart by some steps, and commits.
void nudge(Repository& repository, std::uint32_t chart, double steps) {
  auto edit = repository.begin_edit();
  Patch& patch = edit.checkout({{OfCharts{{ChartId(chart)}}}, 0});
  const double step = edit.base().lattice().step;
  int n = 0;
  for (const auto v : patch.mesh().all_vertices())
    if (++n % 3 == 0)
      patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(steps * step, 0, -steps * step));
  CommitOptions options;
  options.message = "nudge";
  (void)edit.commit(options);
}

/// Moves a vertex of a checked-out file.
void nudge_file(const std::filesystem::path& file) {
  mesh_file::MeshData data = mesh_file::read_mesh(file);
  data.positions[7].z += 0.1;
  write_data(data, file);
}

struct Family {
  const char* name;
  TestMesh (*make)();
};

class RepackOf : public testing::TestWithParam<Family> {};

TEST_P(RepackOf, HoldsTheSameMeshInBothProfiles) {
  TempRepository repository(GetParam().make(), 300);
  const FaceSet faces = faces_at(*repository);
  const MeshInfo before = repository->snapshot().info();

  const RepackReport fast = repository->repack({}, as(ChartProfile::fast));
  EXPECT_FALSE(fast.nothing_changed);
  EXPECT_EQ(fast.profile, "fast");
  EXPECT_EQ(fast.charts, before.charts);
  EXPECT_EQ(fast.before.payload, before.bytes.payload);
  EXPECT_EQ(fast.after.payload, repository->snapshot().info().bytes.payload);
  EXPECT_EQ(faces_at(*repository), faces);
  EXPECT_EQ(repository->diff(repository->snapshot({}, "1"), repository->snapshot()).vertices_moved, 0U);

  const RepackReport dense = repository->repack({}, as(ChartProfile::dense));
  EXPECT_EQ(dense.parent, fast.revision);
  EXPECT_EQ(faces_at(*repository), faces);
  EXPECT_EQ(repository->snapshot().info().profile, "dense");
  EXPECT_EQ(repository->snapshot({}, "2").info().profile, "fast");
  EXPECT_EQ(repository->snapshot({}, "1").info().profile, "dense");
  for (const char* revision : {"1", "2"}) EXPECT_EQ(faces_at(*repository, revision), faces);
  EXPECT_TRUE(repository->verify({}).ok());
}

INSTANTIATE_TEST_SUITE_P(
    Families, RepackOf,
    testing::Values(Family{"Scan", [] { return scan(6000); }}, Family{"Genus3", [] { return genus3(4000); }},
                    Family{"Boxes", [] { return boxes(120); }}, Family{"Moebius", [] { return moebius(); }},
                    Family{"TwoCubesSharingEdge", [] { return two_cubes_sharing_edge(); }},
                    Family{"DegenerateAndDuplicate", [] { return degenerate_and_duplicate_faces(); }},
                    Family{"IsolatedVertices", [] { return isolated_vertices(); }}),
    [](const auto& family) { return std::string(family.param.name); });

TEST(Repack, KeepsAttributesAndPolygons) {
  const mesh_file::MeshData mesh = painted_grid(50);
  Painted repository(mesh);
  const auto expected = records(repository->snapshot(), mesh);
  for (const ChartProfile profile : {ChartProfile::fast, ChartProfile::dense}) {
    const RepackReport report = repository->repack("mesh", as(profile));
    EXPECT_FALSE(report.nothing_changed);
    const Snapshot snapshot = repository->snapshot();
    const auto file = repository / ("out" + std::to_string(report.revision.value) + ".ply");
    (void)repository->export_mesh(snapshot, file, {});
    EXPECT_TRUE(records(snapshot, mesh_file::read_mesh(file)) == expected) << report.profile;
  }
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Repack, KeepsPositionsToTheLastBit) {
  const TempFolder folder;
  Repository::create(folder / "r.ramcdb");
  Repository repository = Repository::open(folder / "r.ramcdb");
  write_test_mesh(scan(5000), folder / "in.ply");
  ImportOptions options;
  options.lossless = true;
  options.chart_faces = 400;
  (void)repository.import(folder / "in.ply", options);
  const auto positions_now = [&](const char* name) {
    (void)repository.export_mesh(repository.snapshot(), folder / name, {});
    auto positions = mesh_file::read_mesh(folder / name).positions;
    std::sort(positions.begin(), positions.end(),
              [](const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    return positions;
  };
  const auto before = positions_now("before.ply");
  EXPECT_FALSE(repository.repack({}, as(ChartProfile::fast)).nothing_changed);
  EXPECT_TRUE(positions_now("after.ply") == before);
  EXPECT_TRUE(repository.verify({}).ok());
}

TEST(Repack, OfTheSameProfileWritesOnlyWhatGetsSmaller) {
  TempRepository repository(scan(6000), 300);
  const RepackReport again = repository->repack({}, {});
  EXPECT_TRUE(again.nothing_changed);
  EXPECT_EQ(again.revision, again.parent);
  EXPECT_EQ(repository->log().size(), 1U);
  (void)repository->repack({}, as(ChartProfile::fast));
  EXPECT_TRUE(repository->repack({}, as(ChartProfile::fast)).nothing_changed);
  EXPECT_EQ(repository->log().size(), 2U);
}

TEST(Repack, EditsBeforeAndAfterStay) {
  TempRepository repository(scan(6000), 300);
  nudge(*repository, 3, 40);
  const FaceSet edited = faces_at(*repository);
  (void)repository->repack({}, as(ChartProfile::fast));
  EXPECT_EQ(faces_at(*repository), edited);
  nudge(*repository, 5, -25);
  const FaceSet twice = faces_at(*repository);
  EXPECT_NE(twice, edited);
  (void)repository->repack({}, as(ChartProfile::dense));
  EXPECT_EQ(faces_at(*repository), twice);
  nudge(*repository, 3, 2);
  EXPECT_TRUE(repository->verify({}).ok());
  EXPECT_EQ(repository->log().front().operation, "commit");
  EXPECT_EQ(repository->show("HEAD~1").operation, "repack");
}

TEST(Repack, AFileCheckedOutBeforeGoesIn) {
  TempRepository repository(scan(6000), 300);
  const auto file = repository / "region.ply";
  const std::vector<ChartId> charts{ChartId(2), ChartId(3)};
  (void)repository->checkout_file(repository->snapshot(), charts, file, {});
  (void)repository->repack({}, as(ChartProfile::fast));
  nudge_file(file);
  CommitOptions options;
  options.message = "late";
  const CommitReport late = repository->commit_file(file, options);
  EXPECT_TRUE(late.conflicts.empty()) << "others moved nothing";
  EXPECT_EQ(repository->log().size(), 3U);

  const auto fresh = repository / "fresh.ply";
  (void)repository->checkout_file(repository->snapshot(), charts, fresh, {});
  nudge_file(fresh);
  EXPECT_TRUE(repository->commit_file(fresh, options).conflicts.empty());
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Repack, ACommitMeanwhileIsKept) {
  TempRepository repository(scan(6000), 300);
  FaceSet committed;
  RepackOptions options = as(ChartProfile::fast);
  options.progress = [&](std::string_view, double) {
    if (!committed.empty()) return;
    nudge(*repository, 4, 30);
    committed = faces_at(*repository);
  };
  EXPECT_EQ(repository->repack({}, options).parent, VersionId(2)) << "made again from the newer tip";
  EXPECT_EQ(repository->snapshot().info().profile, "fast");
  EXPECT_EQ(faces_at(*repository), committed);
  EXPECT_TRUE(repository->verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
