#include <array>
#include <csignal>

#include "db/fail_points.h"
#include "db/sqlite.h"
#include "tests/db/child_process.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

using Versions = std::vector<VersionId>;

Versions ids(std::initializer_list<std::uint32_t> numbers) {
  Versions versions;
  for (const std::uint32_t n : numbers) versions.emplace_back(n);
  return versions;
}

/// main: 1 2 4, side: 3 (from 2) 5.
class Names : public ::testing::Test {
 protected:
  Names() {
    for (const char* branch : {"main", "main"}) (void)publish(*store_, {}, branch);
    (void)store_->create_branch("side", VersionId(2), false);
    for (const char* branch : {"side", "main", "side"}) (void)publish(*store_, {}, branch);
  }

  [[nodiscard]] std::uint32_t resolve(std::string_view revision) { return store_->resolve(revision).value; }

  TempStore temp_;
  std::shared_ptr<Store> store_ = temp_.open();
};

TEST_F(Names, ABranchBeginsAtAnyVersionAndMovesWithWhatIsPublishedOnIt) {
  EXPECT_EQ(store_->refs(), (std::vector<Ref>{{"main", false, VersionId(4)}, {"side", false, VersionId(5)}}));
  EXPECT_EQ(store_->version(VersionId(3)).parents, ids({2}));
  EXPECT_TRUE(store_->create_branch("third", store_->resolve("side~1"), false).empty());
  EXPECT_EQ(resolve("third"), 3U);
  EXPECT_EQ(publish(*store_, {}, "third"), VersionId(6));
  EXPECT_EQ(resolve("third"), 6U);
  EXPECT_EQ(resolve("third~2"), 2U);
  EXPECT_EQ(resolve("side"), 5U) << "the others stay";
  EXPECT_EQ(store_->tip("third"), VersionId(6));
  EXPECT_EQ(store_->tip("nobody"), VersionId());
  EXPECT_TRUE(problems(*store_).empty());
  store_.reset();
  EXPECT_EQ(temp_.open(Access::read)->resolve("third"), VersionId(6)) << "durable";
}

TEST_F(Names, AnExistingBranchIsMovedByForceOnlyAndItsLostVersionsAreTold) {
  expect_error(Errc::invalid_argument, "there is a branch side already",
               [&] { (void)store_->create_branch("side", VersionId(1), false); });
  EXPECT_EQ(resolve("side"), 5U);
  EXPECT_EQ(store_->create_branch("side", VersionId(1), true), ids({3, 5}));
  EXPECT_EQ(resolve("side"), 1U);
  EXPECT_EQ(store_->create_branch("main", VersionId(5), true), ids({4})) << "main, too";
  EXPECT_EQ(resolve("HEAD"), 5U);
  EXPECT_EQ(resolve("v4"), 4U) << "can still be had by number";
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(Names, AMoveCanBeCompareAndSwap) {
  expect_error(Errc::conflict, "side moved to version 5",
               [&] { (void)store_->create_branch("side", VersionId(1), true, VersionId(3)); });
  expect_error(Errc::conflict, "side moved to version 5",
               [&] { (void)store_->create_branch("side", VersionId(1), false, VersionId()); });
  expect_error(Errc::conflict, "new moved to version 0",
               [&] { (void)store_->create_branch("new", VersionId(1), true, VersionId(3)); });
  (void)store_->create_branch("side", VersionId(4), false, VersionId(5));
  (void)store_->create_branch("new", VersionId(1), false, VersionId());
  EXPECT_EQ(resolve("side"), 4U);
  EXPECT_EQ(resolve("new"), 1U);
}

TEST_F(Names, DeletingABranchThatAloneLeadsToVersionsTakesForce) {
  expect_error(Errc::invalid_argument, "without branch side versions 3, 5 would be without a name",
               [&] { (void)store_->delete_branch("side", false); });
  EXPECT_EQ(resolve("side"), 5U);
  (void)store_->create_tag("keep", VersionId(3), false);
  expect_error(Errc::invalid_argument, "without branch side version 5 would",
               [&] { (void)store_->delete_branch("side", false); });
  EXPECT_EQ(store_->delete_branch("side", true), ids({5}));
  expect_error(Errc::not_found, "no revision 'side'", [&] { (void)store_->resolve("side"); });
  EXPECT_EQ(store_->delete_tag("keep"), ids({3}));
  (void)store_->create_branch("inside", VersionId(2), false);
  EXPECT_TRUE(store_->delete_branch("inside", false).empty()) << "main leads there";
  for (const bool force : {false, true})
    expect_error(Errc::invalid_argument, "main cannot be deleted", [&] { (void)store_->delete_branch("main", force); });
  expect_error(Errc::not_found, "there are main", [&] { (void)store_->delete_branch("side", true); });
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(Names, ARenamedBranchGoesOnUnderItsNewName) {
  store_->rename_branch("side", "work/left");
  EXPECT_EQ(resolve("work/left"), 5U);
  EXPECT_EQ(store_->tip("side"), VersionId());
  EXPECT_EQ(publish(*store_, {}, "work/left"), VersionId(6));
  EXPECT_EQ(store_->version(VersionId(5)).branch, "side") << "what was is not rewritten";
  expect_error(Errc::invalid_argument, "main keeps its name", [&] { store_->rename_branch("main", "x"); });
  expect_error(Errc::invalid_argument, "there is a branch main", [&] { store_->rename_branch("work/left", "main"); });
  expect_error(Errc::not_found, "no branch 'side'", [&] { store_->rename_branch("side", "x"); });
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(Names, TagsStayWhereTheyAre) {
  EXPECT_TRUE(store_->create_tag("1.0", VersionId(2), false).empty());
  EXPECT_EQ(resolve("1.0"), 2U);
  EXPECT_EQ(resolve("1.0~"), 1U);
  expect_error(Errc::invalid_argument, "there is a tag 1.0 already",
               [&] { (void)store_->create_tag("1.0", VersionId(3), false); });
  (void)store_->create_tag("1.0", VersionId(3), true);
  EXPECT_EQ(resolve("1.0"), 3U);
  const auto writer = store_->writer(10);
  expect_error(Errc::invalid_argument, "1.0 is a tag", [&] { (void)writer->tip("1.0"); });
  CommitInfo info = commit_info(*writer);
  info.branch = "1.0";
  expect_error(Errc::invalid_argument, "1.0 is a tag", [&] { (void)writer->publish(info); });
}

TEST_F(Names, BranchesAndTagsShareNoName) {
  (void)store_->create_tag("t", VersionId(2), false);
  for (const bool force : {false, true}) {
    expect_error(Errc::invalid_argument, "t is the name of a tag",
                 [&] { (void)store_->create_branch("t", VersionId(1), force); });
    expect_error(Errc::invalid_argument, "side is the name of a branch",
                 [&] { (void)store_->create_tag("side", VersionId(1), force); });
  }
  expect_error(Errc::invalid_argument, "there is a tag t", [&] { store_->rename_branch("side", "t"); });
  expect_error(Errc::invalid_argument, "t is no branch", [&] { (void)store_->delete_branch("t", true); });
  expect_error(Errc::invalid_argument, "side is no tag", [&] { (void)store_->delete_tag("side"); });
  const TempStore empty;
  expect_error(Errc::invalid_argument, "main is always a branch",
               [&] { (void)empty.open()->create_tag("main", VersionId(1), false); });
}

TEST_F(Names, AVersionWithoutANameLeavesAllBranchesAndCanBeHadByItsNumber) {
  const std::vector<Ref> before = store_->refs();
  CommitInfo info;
  info.nameless = true;
  info.parents = ids({2});
  info.attempt = new_attempt_id();
  const VersionId version = store_->writer()->publish(info);
  EXPECT_EQ(store_->refs(), before);
  EXPECT_EQ(resolve("v6"), version.value);
  EXPECT_EQ(store_->version(version).parents, ids({2}));
  EXPECT_EQ(store_->check([](const Store::Problem& problem) { ADD_FAILURE() << problem.text; }) > 0, true);
  EXPECT_EQ(publish(*store_, {}, "main"), VersionId(7));
  EXPECT_EQ(store_->version(VersionId(7)).parents, ids({4}));
}

TEST_F(Names, WhatIsNoNameIsRefused) {
  const std::string long_name(201, 'a');
  for (const std::string& name :
       {std::string(),         long_name,           std::string("a b"),  std::string("a\nb"), std::string("a\0b", 3),
        std::string("a\x7f"),  std::string("a..b"), std::string("a~1"),  std::string("a^"),   std::string("a:b"),
        std::string("-a"),     std::string(".a"),   std::string("17"),   std::string("v17"),  std::string("HEAD"),
        std::string("@"),      std::string("a/"),   std::string("/a"),   std::string("a//b"), std::string("a/.b"),
        std::string("a.lock"), std::string("a*"),   std::string("a\\b"), std::string("a.")}) {
    const auto expect_refused = [&](auto&& run) {
      expect_error(Errc::invalid_argument, "is no name for a branch or a tag", run);
    };
    expect_refused([&] { (void)store_->create_branch(name, VersionId(1), true); });
    expect_refused([&] { (void)store_->create_tag(name, VersionId(1), true); });
    expect_refused([&] { store_->rename_branch("side", name); });
    expect_refused([&] { (void)publish(*store_, {}, name); });
  }
  for (const std::string& name : {long_name.substr(1), std::string("v"), std::string("v1.0"), std::string("1a"),
                                  std::string("a.b-c_d/e"), std::string("H\xC3\xA4nde"), std::string("v1v")})
    EXPECT_TRUE(store_->create_branch(name, VersionId(1), false).empty()) << name;
  EXPECT_TRUE(problems(*store_).empty());
}

TEST_F(Names, OnlyVersionsThatAreThereGetNames) {
  for (const std::uint32_t version : {0U, 6U, ~0U}) {
    expect_error(Errc::not_found, "", [&] { (void)store_->create_branch("x", VersionId(version), true); });
    expect_error(Errc::not_found, "", [&] { (void)store_->create_tag("x", VersionId(version), true); });
  }
  EXPECT_EQ(store_->refs().size(), 2U);
}

TEST_F(Names, AVersionCanBeginABranchThatIsNotThere) {
  VersionId version;
  {
    const auto writer = store_->writer(10);
    CommitInfo info = commit_info(*writer, "rescued");
    EXPECT_EQ(info.expected_tip, VersionId());
    info.parents = {VersionId(2)};
    version = writer->publish(info);
  }
  EXPECT_EQ(store_->tip("rescued"), version);
  EXPECT_EQ(store_->resolve("rescued~"), VersionId(2));
  EXPECT_EQ(store_->merge_base(version, VersionId(5)), VersionId(2));
}

TEST_F(Names, AChangeOfNamesTouchesNoBlobs) {
  const auto size = fs::file_size(temp_ / "data.mdb");
  const auto time = fs::last_write_time(temp_ / "data.mdb");
  for (int i = 0; i < 20; ++i) (void)store_->create_branch("b" + std::to_string(i), VersionId(1), false);
  EXPECT_EQ(fs::file_size(temp_ / "data.mdb"), size);
  EXPECT_EQ(fs::last_write_time(temp_ / "data.mdb"), time);
}

TEST_F(Names, OfTwoProcessesThatMakeOneNameOneWins) {
  store_.reset();
  std::vector<ChildProcess> children;
  for (std::uint32_t i = 1; i <= 4; ++i)
    children.emplace_back([&, i] {
      const auto store = temp_.open();
      try {
        (void)store->create_branch("one", VersionId(i), false);
      } catch (const Error&) {
        ::_exit(40);
      }
    });
  int won = 0;
  for (ChildProcess& child : children) won += child.wait() == 0;
  EXPECT_EQ(won, 1);
  EXPECT_TRUE(problems(*temp_.open()).empty());
}

TEST_F(Names, DamageIsFound) {
  const auto run = [&](const std::string& sql) {
    Database(temp_ / "catalogue.sqlite", Database::Mode::write).run("PRAGMA foreign_keys = OFF; " + sql);
  };
  store_.reset();
  run("UPDATE ref SET version = 4 WHERE name = 'side'");
  expect_error(Errc::corrupt, "what branch side names is damaged", [&] { (void)temp_.open()->resolve("side"); });
  EXPECT_EQ(problems(*temp_.open()),
            std::vector<std::string>{"catalogue: what branch side names is damaged: it says version 4"});
  EXPECT_EQ(temp_.open()->resolve("HEAD"), VersionId(4)) << "the others are as they were";
  EXPECT_EQ(temp_.open()->create_branch("side", VersionId(5), true), Versions{}) << "and it can be set anew";
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{});
  run("UPDATE ref SET kind = 'tag' WHERE name = 'side'");
  EXPECT_FALSE(problems(*temp_.open()).empty());
}

TEST_F(Names, ANameForAVersionThatIsMissingIsFound) {
  store_.reset();
  Database(temp_ / "catalogue.sqlite", Database::Mode::write)
      .run("PRAGMA foreign_keys = OFF; DELETE FROM version WHERE id = 5");
  const auto store = temp_.open();
  expect_error(Errc::corrupt, "side names version 5, which is not there", [&] { (void)store->resolve("side"); });
  expect_error(Errc::corrupt, "side names version 5, which is not there",
               [&] { (void)store->writer(10)->tip("side"); });
  const auto found = problems(*store);
  EXPECT_NE(std::find(found.begin(), found.end(), "catalogue: branch side names version 5, which is not there"),
            found.end());
  EXPECT_EQ(store->resolve("main"), VersionId(4));
  EXPECT_EQ(store->create_branch("side", VersionId(3), true), ids({5}));
  EXPECT_EQ(store->resolve("side"), VersionId(3));
}

TEST_F(Names, ALostVersionGetsNoNameAndATagOfItSaysSo) {
  (void)store_->create_tag("t", VersionId(5), false);
  store_.reset();
  fs::copy_file(temp_ / "data.mdb", temp_ / "saved");
  (void)publish(*temp_.open(), {}, "side");
  (void)temp_.open()->create_tag("new", VersionId(6), false);
  fs::rename(temp_ / "saved", temp_ / "data.mdb");
  const auto store = temp_.open();
  EXPECT_EQ(store->resolve("side"), VersionId(5)) << "the newest that is whole";
  EXPECT_EQ(store->resolve("t"), VersionId(5));
  expect_error(Errc::corrupt, "version 6 has lost its blobs", [&] { (void)store->resolve("new"); });
  expect_error(Errc::corrupt, "version 6 has lost its blobs",
               [&] { (void)store->create_branch("b", VersionId(6), false); });
  (void)store->create_branch("b", VersionId(5), false);
  EXPECT_EQ(store->resolve("b"), VersionId(5));
}

/// A change of names ends at this point, by kill: the name is old or new.
class NamesCrash : public ::testing::TestWithParam<std::pair<const char*, bool>> {};

TEST_P(NamesCrash, LeavesOldOrNew) {
  const auto [point, done] = GetParam();
  const TempStore temp;
  for (const char* branch : {"main", "main"}) (void)publish(*temp.open(), {}, branch);
  (void)temp.open()->create_branch("old", VersionId(1), false);
  (void)temp.open()->create_tag("tag", VersionId(1), false);
  const std::array<std::function<void(Store&)>, 5> changes = {
      [](Store& s) { (void)s.create_branch("new", VersionId(1), false); },
      [](Store& s) { (void)s.create_branch("new", VersionId(2), true); },
      [](Store& s) { s.rename_branch("old", "renamed"); }, [](Store& s) { (void)s.delete_tag("tag"); },
      [](Store& s) {
        (void)s.lock({0, MeshId(1), {ChartId(1)}, "me", "", "", 1000, 2000}, false);
      }};
  for (const auto& change : changes) {
    const auto before = temp.open()->refs();
    const auto locks_before = temp.open()->locks(1500);
    ChildProcess child([&] {
      set_fail_hook([&](std::string_view name) {
        if (name == point) ::kill(::getpid(), SIGKILL);
      });
      change(*temp.open());
      ADD_FAILURE() << "survived " << point;
    });
    EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
    EXPECT_EQ(temp.open()->refs() != before || temp.open()->locks(1500) != locks_before, done);
    EXPECT_EQ(problems(*temp.open()), std::vector<std::string>{});
    if (!done) change(*temp.open());
  }
  EXPECT_EQ(temp.open()->refs(),
            (std::vector<Ref>{
                {"main", false, VersionId(2)}, {"new", false, VersionId(2)}, {"renamed", false, VersionId(1)}}));
  EXPECT_EQ(publish(*temp.open(), {}, "new"), VersionId(3));
}

INSTANTIATE_TEST_SUITE_P(Points, NamesCrash,
                         ::testing::Values(std::pair{"names.locked", false}, std::pair{"names.before_commit", false},
                                           std::pair{"names.committed", true}),
                         [](const auto& point) { return std::string(point.param.first).substr(6); });

/// A name can be changed over what a killed commit left, which the next commit takes back.
TEST_F(Names, AKilledCommitIsInNobodysWay) {
  store_.reset();
  ChildProcess child([&] {
    set_fail_hook([](std::string_view name) {
      if (name == "blobs.committed") ::kill(::getpid(), SIGKILL);
    });
    (void)publish(*temp_.open(), {make_blob(Kind::chart, 1, 500)});
  });
  EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  const auto store = temp_.open();
  expect_error(Errc::not_found, "no version 6", [&] { (void)store->create_branch("x", VersionId(6), false); });
  (void)store->create_branch("x", VersionId(4), false);
  EXPECT_EQ(publish(*store, {}), VersionId(7));
  EXPECT_TRUE(problems(*store).empty());
}

}  // namespace
}  // namespace ramcdb::db::test
