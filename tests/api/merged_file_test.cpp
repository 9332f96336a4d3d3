#include <algorithm>

#include "ramcdb/edit_transaction.h"
#include "tests/api/temp_repository.h"

/// A checked-out file goes on being edited after its commit was merged with what others did to the same charts.
namespace ramcdb::test {
namespace {

class MergedFile : public ::testing::Test {
 protected:
  MergedFile() {
    (void)repository_->checkout_file(repository_->snapshot(), {kChart}, file_, {});
    base_ = whole(repository_->snapshot());
  }

  /// Lifts the n-th inner vertex of the chart in the file, as a program that knows nothing of us.
  void lift_in_file(std::uint32_t n, int steps) {
    auto data = mesh_file::read_mesh(file_);
    const RegionMesh region = repository_->snapshot({}, "1").read({kChart});
    data.positions[inner_vertex(region, n)].z += steps * step();
    write_data(data, file_, mesh_file::Scalar::float32);
  }

  /// Somebody else lifts one.
  void lift_elsewhere(std::uint32_t n, int steps) {
    EditTransaction edit = repository_->begin_edit();
    Patch& patch = edit.checkout({{OfCharts{{kChart}}}, 0});
    const LatticePoint at = base_.points[inner_vertex(base_, n)];
    for (const auto v : patch.mesh().vertices()) {
      auto& p = patch.mesh().point(v);
      if (repository_->snapshot().lattice().snap({p[0], p[1], p[2]}) == at) p[2] += steps * step();
    }
    ASSERT_EQ(edit.commit(message("theirs")).vertices_moved, 1U);
  }

  CommitReport commit(bool merge = true) {
    CommitOptions options = message("mine");
    options.merge = merge;
    return repository_->commit_file(file_, options);
  }

  /// Expects the n-th inner vertices of the chart lifted by so many steps, and no other vertex.
  void expect_lifted(const std::map<std::uint32_t, int>& lifts) {
    RegionMesh expected = base_;
    for (const auto& [n, steps] : lifts) expected.points[inner_vertex(base_, n)].z += steps;
    EXPECT_TRUE(face_set(whole(repository_->snapshot())) == face_set(expected));
    EXPECT_TRUE(repository_->verify({}).ok());
  }

  [[nodiscard]] double step() { return repository_->snapshot().lattice().step; }
  static std::uint32_t inner_vertex(const RegionMesh& region, std::uint32_t n) {
    const auto key = std::ranges::find(region.keys, VertexKey{VertexKey::Where::chart, kChart.value, n});
    return static_cast<std::uint32_t>(key - region.keys.begin());
  }

  static constexpr ChartId kChart{4};
  TempRepository repository_{scan(8000), 400};
  std::filesystem::path file_ = repository_ / "chart.ply";
  RegionMesh base_;
};

TEST_F(MergedFile, IsCleanAndOthersWorkIsNotUndoneByIt) {
  lift_in_file(3, 40);
  lift_elsewhere(30, 70);
  EXPECT_FALSE(commit(false).conflicts.empty());
  const CommitReport merged = commit();
  EXPECT_TRUE(merged.merged);
  EXPECT_TRUE(repository_->status_file(file_).clean());
  EXPECT_TRUE(commit().nothing_changed);
  EXPECT_EQ(repository_->resolve("HEAD"), merged.revision);
  expect_lifted({{3, 40}, {30, 70}});
}

TEST_F(MergedFile, GoesOnWithTheSameVerticesAndOthers) {
  lift_in_file(3, 40);
  lift_elsewhere(30, 70);
  (void)commit();
  lift_in_file(3, 5);
  lift_in_file(12, 9);
  EXPECT_EQ(repository_->status_file(file_).vertices_moved, 2U) << "the first edit does not count again";
  const CommitReport second = commit();
  EXPECT_TRUE(second.conflicts.empty());
  EXPECT_EQ(second.vertices_moved, 2U);
  expect_lifted({{3, 45}, {12, 9}, {30, 70}});
  lift_elsewhere(31, 11);
  lift_in_file(3, -45);
  const CommitReport third = commit();
  EXPECT_EQ(third.vertices_moved, 1U);
  expect_lifted({{12, 9}, {30, 70}, {31, 11}});
  EXPECT_EQ(repository_->log().size(), 6U) << "what the file alone holds is on no branch";
}

TEST_F(MergedFile, ConflictsOnlyWhereOthersReallyDiffer) {
  lift_in_file(3, 40);
  lift_elsewhere(30, 70);
  (void)commit();
  lift_in_file(30, 5);
  const CommitReport refused = commit();
  ASSERT_EQ(refused.conflict_places.size(), 1U);
  EXPECT_EQ(refused.conflict_places.front().what, "both sides moved a vertex to different places");
  expect_lifted({{3, 40}, {30, 70}});
}

}  // namespace
}  // namespace ramcdb::test
