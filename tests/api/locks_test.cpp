#include <fstream>
#include <optional>
#include <set>
#include <tuple>

#include "tests/api/temp_repository.h"

/// Advisory locks through the public library.
namespace ramcdb::test {
namespace {

template <class Run>
std::string refusal_of(Errc code, Run&& run) {
  try {
    run();
  } catch (const Error& e) {
    EXPECT_EQ(static_cast<int>(e.code()), static_cast<int>(code)) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

LockOptions lock_of(const std::string& owner, bool steal = false) {
  LockOptions options;
  options.owner = owner;
  options.reason = "horn";
  options.steal = steal;
  return options;
}

CommitOptions by(const std::string& author, bool ignore_locks = false) {
  CommitOptions options;
  options.message = "lift";
  options.author = author;
  options.ignore_locks = ignore_locks;
  return options;
}

class Locks : public ::testing::Test {
 protected:
  /// Checks one chart out and moves what lies inside it.
  std::filesystem::path edited_file(std::uint32_t chart, const std::string& name,
                                    const std::optional<LockOptions>& lock = {}) {
    FileOptions options;
    options.lock = lock;
    (void)repo_->checkout_file(repo_->snapshot(), {ChartId(chart)}, repo_ / name, options);
    const Snapshot now = repo_->snapshot();
    const RegionMesh region = now.read({ChartId(chart)});
    mesh_file::MeshData data = mesh_file::read_mesh(repo_ / name);
    std::set<Point, decltype(&before)> border(&before);
    for (std::size_t v = 0; v < region.points.size(); ++v)
      if (region.keys[v].where != VertexKey::Where::chart) border.insert(rounded(now.position(region, v)));
    for (Point& p : data.positions)
      if (!border.contains(rounded(p))) p.z += 4 * now.lattice().step;
    write_data(data, repo_ / name);
    return repo_ / name;
  }

  static bool before(const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
  static Point rounded(const Point& p) { return {double(float(p.x)), double(float(p.y)), double(float(p.z))}; }

  TempRepository repo_{terrain(40, 40), 200};
};

TEST_F(Locks, StopCommitsOfOthersToTheseChartsOnly) {
  const LockReport taken = repo_->lock(repo_->snapshot(), {ChartId(2), ChartId(3)}, lock_of("ada"));
  EXPECT_EQ(taken.lock.mesh, "mesh");
  EXPECT_TRUE(taken.stolen.empty());
  const auto third = edited_file(3, "third.ply"), fifth = edited_file(5, "fifth.ply");
  const std::string refusal = refusal_of(Errc::conflict, [&] { (void)repo_->commit_file(third, by("bob")); });
  for (const char* part : {"chart 3 by ada until ", "horn", "nothing was written", "--ignore-locks"})
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
  EXPECT_EQ(repo_->resolve("HEAD"), VersionId(1));
  EXPECT_EQ(repo_->commit_file(fifth, by("bob")).revision, VersionId(2)) << "nobody's chart";
  EXPECT_EQ(repo_->locks().size(), 1U);
  const auto second = edited_file(2, "second.ply");
  const VersionId own = repo_->commit_file(second, by("ada")).revision;
  EXPECT_EQ(repo_->resolve("HEAD"), own) << "the owner's commit";
  EXPECT_EQ(repo_->locks().size(), 1U) << "a lock taken by itself stays";
  EXPECT_GT(repo_->commit_file(third, by("bob", true)).revision, own) << "ignored on purpose";
  EXPECT_TRUE(repo_->verify({}).ok());
}

TEST_F(Locks, StatusShowsThoseOnTheFilesCharts) {
  (void)repo_->lock(repo_->snapshot(), {ChartId(2), ChartId(3)}, lock_of("ada"));
  const auto third = edited_file(3, "third.ply"), fifth = edited_file(5, "fifth.ply");
  const auto locks = repo_->status_file(third).locks;
  ASSERT_EQ(locks.size(), 1U);
  EXPECT_EQ(locks[0].owner, "ada");
  EXPECT_EQ(locks[0].charts, std::vector{ChartId(3)});
  EXPECT_TRUE(repo_->status_file(fifth).locks.empty());
}

TEST_F(Locks, OfACheckoutEndWithItsCommit) {
  const auto file = edited_file(3, "third.ply", lock_of("ada"));
  ASSERT_EQ(repo_->locks().size(), 1U);
  EXPECT_EQ(repo_->locks()[0].charts, std::vector{ChartId(3)});
  (void)refusal_of(Errc::conflict, [&] { (void)repo_->commit_file(file, by("bob")); });
  EXPECT_EQ(repo_->locks().size(), 1U) << "a refused commit leaves it";
  (void)repo_->commit_file(file, by("ada"));
  EXPECT_TRUE(repo_->locks().empty());
  (void)repo_->lock(repo_->snapshot(), {ChartId(3)}, lock_of("bob"));
  EXPECT_EQ(repo_->locks().size(), 1U);
  EXPECT_TRUE(repo_->commit_file(file, by("ada")).nothing_changed) << "and the file knows of it no more";
  EXPECT_EQ(repo_->locks().size(), 1U);
}

TEST_F(Locks, ARefusedOrFailedCheckoutTakesNone) {
  (void)repo_->lock(repo_->snapshot(), {ChartId(3)}, lock_of("ada"));
  FileOptions options;
  options.lock = lock_of("bob");
  const Snapshot now = repo_->snapshot();
  (void)refusal_of(Errc::conflict, [&] { (void)repo_->checkout_file(now, {ChartId(3)}, repo_ / "a.ply", options); });
  EXPECT_FALSE(std::filesystem::exists(repo_ / "a.ply"));
  std::ofstream(repo_ / "mine.ply") << "work";
  options.overwrite = false;
  (void)refusal_of(Errc::invalid_argument,
                   [&] { (void)repo_->checkout_file(now, {ChartId(4)}, repo_ / "mine.ply", options); });
  ASSERT_EQ(repo_->locks().size(), 1U);
  EXPECT_EQ(repo_->locks()[0].owner, "ada");
  options.overwrite = true;
  options.lock = lock_of("bob", true);
  const CheckoutReport report = repo_->checkout_file(now, {ChartId(3)}, repo_ / "a.ply", options);
  ASSERT_TRUE(report.lock.has_value());
  ASSERT_EQ(report.lock->stolen.size(), 1U);
  EXPECT_EQ(report.lock->stolen[0].owner, "ada");
}

TEST_F(Locks, AreGivenBack) {
  const Snapshot now = repo_->snapshot();
  const auto first = repo_->lock(now, {ChartId(1), ChartId(2)}, lock_of("ada"));
  (void)repo_->lock(now, {ChartId(5)}, lock_of("bob"));
  EXPECT_NE(refusal_of(Errc::conflict, [&] { (void)repo_->unlock(now, {ChartId(5)}, "ada"); }).find("bob"),
            std::string::npos);
  (void)refusal_of(Errc::not_found, [&] { (void)repo_->unlock(now, {ChartId(9)}, "ada"); });
  (void)refusal_of(Errc::not_found, [&] { (void)repo_->unlock(77, "ada"); });
  (void)refusal_of(Errc::conflict, [&] { (void)repo_->unlock(first.lock.id, "bob"); });
  EXPECT_EQ(repo_->unlock(now, {ChartId(2)}, "ada").at(0).charts, std::vector{ChartId(2)});
  EXPECT_EQ(repo_->unlock(first.lock.id, "ada").at(0).charts, std::vector{ChartId(1)});
  EXPECT_TRUE(repo_->unlock_all("ada").empty());
  EXPECT_EQ(repo_->unlock_all("ada", true).size(), 1U);
  EXPECT_TRUE(repo_->locks().empty());
}

TEST_F(Locks, OnAChartThatIsGoneIsListedAsSuch) {
  (void)repo_->lock(repo_->snapshot(), {ChartId(2), ChartId(4999)}, lock_of("ada"));
  ASSERT_EQ(repo_->locks().size(), 1U);
  EXPECT_EQ(repo_->locks()[0].gone, std::vector{ChartId(4999)});
}

TEST_F(Locks, WithoutOwnerOrForAgesAreRefused) {
  LockOptions options = lock_of("");
  (void)refusal_of(Errc::invalid_argument, [&] { (void)repo_->lock(repo_->snapshot(), {ChartId(2)}, options); });
  options.owner = "ada";
  for (const std::int64_t seconds : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1} << 40}) {
    options.seconds = seconds;
    (void)refusal_of(Errc::invalid_argument, [&] { (void)repo_->lock(repo_->snapshot(), {ChartId(2)}, options); });
  }
}

TEST_F(Locks, StopARepackOfOthers) {
  (void)repo_->lock(repo_->snapshot(), {ChartId(2)}, lock_of("ada"));
  RepackOptions options;
  options.profile = ChartProfile::fast;
  options.author = "bob";
  (void)refusal_of(Errc::conflict, [&] { (void)repo_->repack({}, options); });
  options.ignore_locks = true;
  EXPECT_EQ(repo_->repack({}, options).revision, VersionId(2));
}

}  // namespace
}  // namespace ramcdb::test
