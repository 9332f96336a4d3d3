#include <algorithm>
#include <set>

#include "ramcdb/edit_transaction.h"
#include "ramcdb/error.h"
#include "tests/api/temp_repository.h"

/// Versions that change several meshes at once: merges, and what takes them back.
namespace ramcdb::test {
namespace {

class SeveralMeshes : public ::testing::Test {
 protected:
  SeveralMeshes() {
    Repository::create(folder_ / "r.ramcdb");
    repository_.emplace(Repository::open(folder_ / "r.ramcdb"));
    add("ball", sphere(3000));
    add("ring", torus(3000));
    add("land", terrain(30, 30));
    (void)repository_->create_branch("side");
  }

  void add(const std::string& name, const TestMesh& mesh) {
    write_test_mesh(mesh, folder_ / (name + ".ply"));
    ImportOptions options;
    options.name = name;
    options.bits = 14;
    options.chart_faces = 400;
    (void)repository_->import(folder_ / (name + ".ply"), options);
  }

  static CommitOptions on(const std::string& branch) {
    CommitOptions options = message("edit");
    options.branch = branch;
    return options;
  }

  /// Moves an inner vertex of a chart by some steps.
  void lift(const char* mesh, const char* branch, std::uint32_t chart, int steps) {
    EditTransaction edit = repository_->begin_edit(mesh, branch);
    Patch& patch = edit.checkout({{OfCharts{{ChartId(chart)}}}, 0});
    for (const auto v : patch.mesh().vertices()) {
      const std::uint64_t key = patch.mesh().property(patch.key_property(), v);
      if (VertexKey::unpack(key).where != VertexKey::Where::chart) continue;
      patch.mesh().point(v)[2] += steps * patch.base().lattice().step;
      break;
    }
    const CommitReport report = edit.commit(on(branch));
    ASSERT_EQ(report.vertices_moved, 1U);
  }

  std::uint64_t moved(const char* mesh, const char* from, const char* to = "HEAD") {
    return repository_->diff(repository_->snapshot(mesh, from), repository_->snapshot(mesh, to)).vertices_moved;
  }
  void expect_whole() { EXPECT_TRUE(repository_->verify({}).ok()); }

  TempFolder folder_;
  std::optional<Repository> repository_;
};

TEST_F(SeveralMeshes, MergedOnBothSidesMakeOneVersion) {
  for (const char* mesh : {"ball", "ring"}) {
    lift(mesh, "main", 1, 20);
    lift(mesh, "side", 2, 30);
  }
  const VersionId tip = repository_->resolve("main"), theirs = repository_->resolve("side");
  const MergeReport report = repository_->merge("side", message("both"));
  EXPECT_EQ(report.revision, VersionId(theirs.value + 1)) << "one version";
  EXPECT_EQ(repository_->show("HEAD").parents, (std::vector<VersionId>{tip, theirs}));
  ASSERT_EQ(report.commit.per_mesh.size(), 2U);
  EXPECT_EQ(report.commit.vertices_moved, 2U);
  EXPECT_EQ(repository_->show("HEAD").changes.size(), 2U);
  for (const char* mesh : {"ball", "ring"}) {
    EXPECT_EQ(moved(mesh, "3"), 2U) << mesh;
    EXPECT_EQ(moved(mesh, "side"), 1U) << mesh;
  }
  EXPECT_EQ(moved("land", "3"), 0U);
  EXPECT_TRUE(repository_->merge("side", message("again")).nothing_changed);
  expect_whole();
}

TEST_F(SeveralMeshes, OneMergedBesideOthersTakenOver) {
  lift("ball", "main", 1, 20);
  lift("ball", "side", 2, 30);
  lift("land", "side", 1, 40);
  lift("ring", "main", 1, 50);
  const MergeReport report = repository_->merge("side", message("both"));
  EXPECT_TRUE(report.commit.conflicts.empty());
  EXPECT_GE(report.charts_taken, 1U);
  EXPECT_TRUE(report.commit.per_mesh.empty());
  EXPECT_EQ(moved("ball", "3"), 2U);
  EXPECT_EQ(moved("land", "3"), 1U);
  EXPECT_EQ(moved("land", "side"), 0U);
  EXPECT_EQ(moved("ring", "3"), 1U);
  expect_whole();
}

TEST_F(SeveralMeshes, ConflictsOfAllAreToldAndNothingIsWritten) {
  for (const char* mesh : {"ball", "ring"}) {
    lift(mesh, "main", 1, 20);
    lift(mesh, "side", 1, 30);
  }
  lift("land", "main", 1, 20);
  lift("land", "side", 2, 20);
  const VersionId tip = repository_->resolve("main"), newest = repository_->resolve("side");
  const MergeReport report = repository_->merge("side", message("both"));
  EXPECT_EQ(report.revision, tip);
  EXPECT_EQ(report.commit.conflicts, (std::vector<ChartId>{ChartId(1), ChartId(1)}));
  std::set<std::string> meshes;
  for (const MergeConflict& conflict : report.commit.conflict_places) meshes.insert(conflict.mesh);
  EXPECT_EQ(meshes, (std::set<std::string>{"ball", "ring"}));
  ASSERT_EQ(report.commit.per_mesh.size(), 3U);
  EXPECT_EQ(repository_->resolve("main"), tip);
  EXPECT_THROW((void)repository_->show(std::to_string(newest.value + 1)), Error);
  expect_whole();
}

TEST_F(SeveralMeshes, LockedChartsThatAMergeTakesOverAreRefused) {
  lift("land", "side", 1, 40);
  LockOptions lock;
  lock.owner = "somebody else";
  (void)repository_->lock(repository_->snapshot("land"), {ChartId(1)}, lock);
  EXPECT_THROW((void)repository_->merge("side", message("both")), Error);
  CommitOptions anyway = message("both");
  anyway.ignore_locks = true;
  EXPECT_EQ(repository_->merge("side", anyway).charts_taken, 1U);
}

TEST_F(SeveralMeshes, AVersionOfSeveralIsTakenBackAtOnce) {
  for (const char* mesh : {"ball", "ring", "land"}) lift(mesh, "side", 2, 30);
  lift("ball", "main", 1, 20);
  const VersionId merge = repository_->merge("side", message("all")).revision;
  lift("ring", "main", 1, 20);
  const CommitReport back = repository_->revert("HEAD~1", {}, message("back"));
  EXPECT_EQ(back.revision, VersionId(merge.value + 2));
  ASSERT_EQ(back.per_mesh.size(), 3U);
  EXPECT_EQ(back.vertices_moved, 3U);
  EXPECT_EQ(moved("ball", "3"), 1U);
  EXPECT_EQ(moved("ring", "3"), 1U);
  EXPECT_EQ(moved("land", "3"), 0U);
  EXPECT_TRUE(repository_->revert(std::to_string(merge.value), {}, message("again")).nothing_changed);

  const std::string version = std::to_string(back.revision.value);
  const Region everywhere{{WholeMesh{}}, 0};
  EXPECT_THROW((void)repository_->revert(version, {}, message("part"), everywhere), Error) << "of which mesh?";
  const CommitReport one = repository_->revert(version, "ring", message("one"), everywhere);
  EXPECT_TRUE(one.per_mesh.empty());
  EXPECT_EQ(moved("ring", "3"), 2U);
  EXPECT_EQ(moved("land", "3"), 0U);
  expect_whole();
}

}  // namespace
}  // namespace ramcdb::test
