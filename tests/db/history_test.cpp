#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

std::vector<std::uint32_t> numbers(const std::vector<VersionId>& versions) {
  std::vector<std::uint32_t> out;
  for (const VersionId v : versions) out.push_back(v.value);
  return out;
}

std::vector<std::uint32_t> numbers(const std::vector<VersionInfo>& versions) {
  std::vector<std::uint32_t> out;
  for (const VersionInfo& v : versions) out.push_back(v.id.value);
  return out;
}

using Numbers = std::vector<std::uint32_t>;

/// main: 1 2 4, side: 3 (from 2) 5, and 6 on main merges 5.
class History : public ::testing::Test {
 protected:
  History() {
    for (const char* branch : {"main", "main"}) (void)commit(branch, {});
    (void)commit("side", {VersionId(2)});
    (void)commit("main", {});
    (void)commit("side", {});
    (void)commit("main", {VersionId(4), VersionId(5)});
  }

  VersionId commit(const std::string& branch, const std::vector<VersionId>& parents) {
    const auto writer = store_->writer(10);
    CommitInfo info = commit_info(*writer, branch);
    if (!parents.empty()) info.parents = parents;
    return writer->publish(info);
  }

  [[nodiscard]] std::uint32_t resolve(std::string_view revision) { return store_->resolve(revision).value; }

  TempStore temp_;
  std::shared_ptr<Store> store_ = temp_.open();
};

TEST_F(History, RevisionsAreResolved) {
  const std::pair<const char*, std::uint32_t> cases[] = {
      {"", 6},      {"HEAD", 6},   {"main", 6},   {"6", 6},      {"v6", 6},     {"3", 3},    {"v3", 3},   {"side", 5},
      {"~", 4},     {"~1", 4},     {"~2", 2},     {"HEAD~2", 2}, {"main~1", 4}, {"~~", 2},   {"~1~2", 1}, {"main~3", 1},
      {"side~", 3}, {"side~2", 2}, {"side~3", 1}, {"v5~", 3},    {"~0", 6},     {"4~1~1", 1}};
  for (const auto& [revision, version] : cases) EXPECT_EQ(resolve(revision), version) << revision;
}

TEST_F(History, WhatIsNoRevisionIsRefused) {
  for (const char* revision : {"7", "v7", "0", "v0", "v", "nobody", "Main", "-1", "1.5", "v1 ", " 1", "4294967296",
                               "99999999999999999999", "main side", "'; DROP TABLE version; --"})
    expect_error(Errc::not_found, "there is no revision", [&] { (void)resolve(revision); });
  expect_error(Errc::not_found, "main, side", [&] { (void)resolve("nobody"); });
  for (const char* revision : {"main~4", "1~", "~4294967295", "side~4"})
    expect_error(Errc::not_found, "beyond the first version", [&] { (void)resolve(revision); });
  for (const char* revision : {"main~x", "~-1", "~1x", "main~4294967296"})
    expect_error(Errc::invalid_argument, "is no revision", [&] { (void)resolve(revision); });
}

TEST_F(History, AnEmptyRepositoryHasOnlyItsTip) {
  const TempStore empty;
  const auto store = empty.open();
  for (const char* revision : {"", "HEAD", "main"}) EXPECT_EQ(store->resolve(revision), VersionId());
  EXPECT_TRUE(store->roots(VersionId()).empty());
  EXPECT_TRUE(store->history(VersionId(), 10).empty());
  expect_error(Errc::not_found, "nothing is published yet", [&] { (void)store->resolve("1"); });
  expect_error(Errc::not_found, "nothing is published yet", [&] { (void)store->resolve("~"); });
  expect_error(Errc::not_found, "there is no version 1", [&] { (void)store->version(VersionId(1)); });
  expect_error(Errc::not_found, "there is no version 1", [&] { (void)store->roots(VersionId(1)); });
}

TEST_F(History, GoesAlongAllParentsNewestFirst) {
  EXPECT_EQ(numbers(store_->history(VersionId(6), 100)), (Numbers{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(numbers(store_->history(VersionId(6), 3)), (Numbers{6, 5, 4}));
  EXPECT_EQ(numbers(store_->history(VersionId(4), 100)), (Numbers{4, 2, 1}));
  EXPECT_EQ(numbers(store_->history(VersionId(5), 100)), (Numbers{5, 3, 2, 1}));
  EXPECT_TRUE(store_->history(VersionId(6), 0).empty());
  EXPECT_TRUE(store_->history(VersionId(7), 100).empty());
  EXPECT_EQ(numbers(store_->all_versions()), (Numbers{1, 2, 3, 4, 5, 6}));
}

TEST_F(History, AVersionTellsAllThatWasSaid) {
  const std::string odd = "line\nline \"quoted\" \xC3\xA4 ' ; \x01";
  CommitInfo info;
  VersionId version;
  {
    const auto writer = store_->writer(10);
    info = commit_info(*writer);
    info.author = odd;
    info.message = odd + std::string(100'000, 'm');
    info.figures = R"({"faces":[1,2,3]})";
    info.roots = {{MeshId(9), "zebra", PageId(4), VersionId(6), VersionId(1)},
                  {MeshId(65535), "ant", PageId(~0U), VersionId(7), VersionId(7)},
                  {MeshId(2), "", PageId(1), VersionId(2), VersionId(3)}};
    info.changed = {{MeshId(9), {ChartId(1), ChartId(2), ChartId(3), ChartId(7), ChartId(~0U)}}, {MeshId(2), {}}};
    version = writer->publish(info);
  }
  store_.reset();
  store_ = temp_.open(Access::read);
  const VersionInfo told = store_->version(version);
  EXPECT_EQ(told.id, VersionId(7));
  EXPECT_EQ(numbers(told.parents), Numbers{6});
  EXPECT_EQ(told.branch, "main");
  EXPECT_EQ(told.author, info.author);
  EXPECT_EQ(told.message, info.message);
  EXPECT_EQ(told.attempt, info.attempt);
  EXPECT_EQ(told.figures, info.figures);
  EXPECT_GT(told.time_us, std::int64_t{1'600'000'000'000'000});

  EXPECT_EQ(store_->roots(version), (std::vector{info.roots[2], info.roots[1], info.roots[0]})) << "by name";
  const auto changed = store_->changed(version);
  ASSERT_EQ(changed.size(), 2U);
  EXPECT_EQ(changed[0].mesh, MeshId(9));
  EXPECT_EQ(changed[0].charts, info.changed[0].charts);
  EXPECT_EQ(changed[1].mesh, MeshId(2));
  EXPECT_TRUE(changed[1].charts.empty());
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(History, ARepeatedAttemptIsAnsweredAndWritesNothing) {
  CommitInfo info;
  VersionId first;
  {
    const auto writer = store_->writer(10);
    info = commit_info(*writer);
    writer->put({Kind::chart, MeshId(1), 1, VersionId(), 0}, random_bytes(1, 100));
    first = writer->publish(info);
  }
  EXPECT_EQ(store_->published_by(info.attempt), first);
  EXPECT_FALSE(store_->published_by(new_attempt_id()).has_value());
  VersionId refused;
  {
    const auto writer = store_->writer(10);
    refused = writer->version();
    writer->put({Kind::chart, MeshId(1), 1, VersionId(), 0}, random_bytes(1, 100));
    EXPECT_EQ(writer->publish(info), first);
  }
  EXPECT_EQ(store_->all_versions().size(), 7U);
  EXPECT_FALSE(store_->reader()->find({Kind::chart, MeshId(1), 1, refused, 0}).has_value());
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(History, AMovedTipIsAConflictAndLeavesNothing) {
  VersionId refused;
  {
    const auto writer = store_->writer(10);
    refused = writer->version();
    CommitInfo info = commit_info(*writer);
    info.expected_tip = VersionId(4);
    writer->put({Kind::chart, MeshId(1), 1, VersionId(), 0}, random_bytes(1, 100));
    writer->flush();
    expect_error(Errc::conflict, "branch main moved to version 6 (expected version 4)",
                 [&] { (void)writer->publish(info); });
    info.branch = "new";
    expect_error(Errc::conflict, "branch new moved to version 0", [&] { (void)writer->publish(info); });
  }
  EXPECT_EQ(store_->all_versions().size(), 6U);
  EXPECT_FALSE(store_->reader()->find({Kind::chart, MeshId(1), 1, refused, 0}).has_value());
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(History, AbandonedAttemptsLeaveNothingAndTheirNumbersAreNotReused) {
  {
    const auto writer = store_->writer(10);
    EXPECT_EQ(writer->version(), VersionId(7));
    writer->put({Kind::chart, MeshId(1), 1, VersionId(), 0}, random_bytes(1, 100));
  }
  {
    // What wrote nothing durable took no number.
    const auto writer = store_->writer(10);
    EXPECT_EQ(writer->version(), VersionId(7));
    for (std::uint32_t id = 1; id < 50; ++id) {
      writer->put({Kind::chart, MeshId(1), id, VersionId(), 0}, random_bytes(id, 5000));
      if (id % 10 == 0) writer->flush();
    }
  }
  EXPECT_TRUE(problems(*store_).empty());
  for (std::uint32_t id = 1; id < 50; ++id)
    EXPECT_FALSE(store_->reader()->find({Kind::chart, MeshId(1), id, VersionId(7), 0}).has_value());
  EXPECT_EQ(commit("main", {}), VersionId(8)) << "7 was given away";
  EXPECT_EQ(numbers(store_->all_versions()), (Numbers{1, 2, 3, 4, 5, 6, 8}));
  EXPECT_EQ(resolve("~"), 6U);
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(History, ABranchBeginsWhereItsFirstVersionSays) {
  EXPECT_EQ(commit("third", {VersionId(3)}), VersionId(7));
  EXPECT_EQ(commit("fourth", {}), VersionId(8)) << "without history";
  EXPECT_EQ(resolve("third~2"), 2U);
  EXPECT_EQ(resolve("main"), 6U);
  EXPECT_EQ(numbers(store_->history(VersionId(8), 10)), Numbers{8});
  EXPECT_TRUE(store_->version(VersionId(8)).parents.empty());
}

}  // namespace
}  // namespace ramcdb::db::test
