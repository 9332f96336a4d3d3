#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// Branches, tags, locks and where things were touched, as a person types them.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class NamesOfVersions : public SceneTest {
 protected:
  /// Runs with --json, wants success and one object.
  static nlohmann::ordered_json json_of(Arguments arguments) {
    arguments.emplace_back("--json");
    const Outcome outcome = run_ramcdb(arguments);
    expect_done(outcome);
    return only_object(outcome.out);
  }

  /// Commits an edit of the middle on a branch.
  void commit_on(const std::string& branch) {
    const std::string file = path(branch + ".ply");
    expect_done(
        run_ramcdb({"checkout", repo_, "--sphere", "0.5,0.5,0,0.1", "--at", branch, "-o", file, "--ascii", "-q"}));
    edit(file);
    expect_done(run_ramcdb({"commit", file, "-m", "on " + branch, "--branch", branch, "-q", "--author", "Ada"}));
  }
};

TEST_F(NamesOfVersions, ABranchFromBeginningToEnd) {
  EXPECT_EQ(run_ramcdb({"branch", repo_, "side"}).out, "branch side is at v1\n");
  commit_on("side");
  const auto branches = json_of({"branch", repo_})["branches"];
  ASSERT_EQ(branches.size(), 2U);
  EXPECT_EQ(branches[1].dump(), R"({"name":"side","version":2,"ahead":1,"behind":0})");
  EXPECT_THAT(run_ramcdb({"branch", repo_}).out, AllOf(HasSubstr("ahead of main"), HasSubstr("side")));
  expect_failure(run_ramcdb({"branch", repo_, "side", "1"}), 1);
  expect_failure(run_ramcdb({"branch", repo_, "-d", "side"}), 1);
  EXPECT_EQ(run_ramcdb({"branch", repo_, "-m", "side", "left"}).out, "branch side is called left now\n");
  const auto moved = json_of({"branch", repo_, "left", "1", "-f"});
  EXPECT_EQ(moved["version"], 1);
  EXPECT_EQ(moved["nameless"], nlohmann::ordered_json::array({2}));
  expect_done(run_ramcdb({"branch", repo_, "rescued", "v2"}));
  EXPECT_EQ(run_ramcdb({"branch", repo_, "-d", "left", "-q"}).out, "");
  EXPECT_THAT(run_ramcdb({"branch", repo_, "-d", "rescued", "-f"}).out,
              AllOf(HasSubstr("branch rescued deleted"), HasSubstr("1 version"), HasSubstr("v2")));
  expect_failure(run_ramcdb({"branch", repo_, "-d", "main", "-f"}), 1);
  expect_failure(run_ramcdb({"branch", repo_, "-d", "nobody"}), 1);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(NamesOfVersions, Tags) {
  EXPECT_EQ(run_ramcdb({"tag", repo_}).out, "no tags\n");
  EXPECT_EQ(run_ramcdb({"tag", repo_, "v1.0"}).out, "tag v1.0 is at v1\n");
  commit_on("main");
  expect_failure(run_ramcdb({"tag", repo_, "v1.0", "2"}), 1);
  expect_done(run_ramcdb({"tag", repo_, "v1.0", "2", "--force"}));
  EXPECT_EQ(json_of({"tag", repo_}).dump(), R"({"tags":[{"name":"v1.0","version":2}]})");
  edit(path("main.ply"), 0.01);
  expect_failure(run_ramcdb({"commit", path("main.ply"), "-m", "x", "--branch", "v1.0"}), 1);
  EXPECT_EQ(run_ramcdb({"tag", repo_, "-d", "v1.0"}).out, "tag v1.0 deleted\n");
  expect_failure(run_ramcdb({"tag", repo_, "-d", "v1.0"}), 1);
  for (const char* name : {"17", "a b", "a..b", "HEAD", "main"}) expect_failure(run_ramcdb({"tag", repo_, name}), 1);
}

TEST_F(NamesOfVersions, EveryReadingVerbTakesThem) {
  expect_done(run_ramcdb({"branch", repo_, "side", "-q"}));
  commit_on("side");
  commit_on("main");
  expect_done(run_ramcdb({"tag", repo_, "t", "side"}));
  for (const std::string at : {"side", "t"}) {
    EXPECT_EQ(json_of({"info", repo_, "--at", at})["revision"], 2) << at;
    EXPECT_EQ(json_of({"ls", repo_, "--at", at})["revision"], 2) << at;
    EXPECT_EQ(json_of({"charts", repo_, "--all", "--at", at})["revision"], 2) << at;
    EXPECT_EQ(json_of({"checkout", repo_, "--charts", "1", "--at", at, "-o", path(at + "1.ply")})["revision"], 2) << at;
    EXPECT_EQ(json_of({"export", repo_, "--at", at, "-o", path(at + "2.ply")})["revision"], 2) << at;
    EXPECT_EQ(json_of({"show", repo_, at})["id"], 2) << at;
    EXPECT_EQ(json_of({"log", repo_, "--at", at})["revisions"].size(), 2U) << at;
    EXPECT_EQ(json_of({"diff", repo_, "main", at})["to"], 2) << at;
    EXPECT_EQ(json_of({"diff", repo_, at + "~", at})["vertices_moved"], 1) << at;
  }
}

TEST_F(NamesOfVersions, LogShowsThemAndGoesAlongABranch) {
  expect_done(run_ramcdb({"branch", repo_, "side", "-q"}));
  expect_done(run_ramcdb({"tag", repo_, "first", "1", "-q"}));
  commit_on("side");
  EXPECT_THAT(run_ramcdb({"log", repo_}).out, HasSubstr("(main, tag: first)"));
  EXPECT_THAT(run_ramcdb({"log", repo_, "--branch", "side"}).out,
              AllOf(HasSubstr("on side (side)"), HasSubstr("(main, tag: first)")));
  EXPECT_THAT(run_ramcdb({"show", repo_, "1"}).out, HasSubstr("main, tag: first"));
  const auto log = json_of({"log", repo_, "--branch", "side"})["revisions"];
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0]["refs"].dump(), R"([{"name":"side","kind":"branch"}])");
  EXPECT_EQ(log[1]["refs"].dump(), R"([{"name":"main","kind":"branch"},{"name":"first","kind":"tag"}])");
  for (const char* none : {"first", "1", "nobody"}) expect_failure(run_ramcdb({"log", repo_, "--branch", none}), 1);
  expect_failure(run_ramcdb({"log", repo_, "--branch", "side", "--at", "1"}), 2);
}

TEST_F(NamesOfVersions, LogTellsWhichVersionsTouchedAPlace) {
  commit_on("main");
  const auto ids = [&](Arguments region) {
    region.insert(region.begin(), {"log", repo_});
    std::vector<int> found;
    const auto log = json_of(region);
    for (const auto& revision : log["revisions"]) found.push_back(revision["id"].get<int>());
    return found;
  };
  const std::string touched = json_of({"show", repo_, "2"})["changes"][0]["charts"][0].dump();
  EXPECT_EQ(ids({"--charts", touched}), (std::vector<int>{2, 1}));
  EXPECT_EQ(ids({"--charts", touched, "-n", "1"}), std::vector<int>{2});
  EXPECT_EQ(ids({"--box", "0,0,-1,0.02,0.02,1"}), std::vector<int>{1});
  EXPECT_EQ(ids({"--sphere", "0,0,0,0.05"}), std::vector<int>{1});
  EXPECT_EQ(ids({"--near", "0,0,0"}), std::vector<int>{1});
  EXPECT_EQ(ids({"--all"}), (std::vector<int>{2, 1}));
  EXPECT_EQ(ids({"--box", "0,0,50,1,1,60"}), std::vector<int>{});
  expect_failure(run_ramcdb({"log", repo_, "--box", "1,2"}), 2);
}

TEST_F(NamesOfVersions, ALockFromCheckoutToCommit) {
  const std::string file = path("horn.ply");
  const Outcome out = run_ramcdb({"checkout", repo_, "--sphere", "0.5,0.5,0,0.1", "-o", file, "--ascii", "--lock",
                                  "--for", "2h", "--why", "the horn", "--owner", "Ada"});
  expect_done(out);
  EXPECT_THAT(out.out, HasSubstr("lock 1: charts "));
  EXPECT_THAT(run_ramcdb({"status", file}).out, AllOf(HasSubstr("locks on its charts"), HasSubstr("Ada")));
  EXPECT_EQ(json_of({"status", file})["locks"][0]["reason"], "the horn");
  edit(file);
  const Outcome refused = run_ramcdb({"commit", file, "-m", "x", "--author", "Bob"});
  expect_failure(refused, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("by Ada until"), HasSubstr("the horn"), HasSubstr("--ignore-locks")));
  EXPECT_EQ(json_of({"log", repo_})["revisions"].size(), 1U);
  expect_done(run_ramcdb({"commit", file, "-m", "x", "--author", "Ada", "-q"}));
  EXPECT_EQ(json_of({"locks", repo_})["locks"].size(), 0U) << "given back";
  expect_done(run_ramcdb({"lock", repo_, "--all", "--owner", "Ada", "-q"}));
  edit(file, 0.01);
  expect_failure(run_ramcdb({"commit", file, "-m", "x", "--author", "Bob"}), 3);
  expect_done(run_ramcdb({"commit", file, "-m", "x", "--author", "Bob", "--ignore-locks", "-q"}));
}

TEST_F(NamesOfVersions, LocksAreTakenStolenAndGivenBack) {
  const auto taken = json_of({"lock", repo_, "--charts", "1-3", "--owner", "Ada", "--for", "90m", "-m", "why"});
  EXPECT_EQ(taken["lock"]["charts"].dump(), "[1,2,3]");
  EXPECT_EQ(taken["lock"]["mesh"], "wavy");
  const Outcome refused = run_ramcdb({"lock", repo_, "--charts", "3,4", "--owner", "Bob"});
  expect_failure(refused, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("chart 3 by Ada"), HasSubstr("--steal")));
  EXPECT_THAT(run_ramcdb({"lock", repo_, "--charts", "3,4", "--owner", "Bob", "--steal"}).out,
              HasSubstr("took over charts 3 from Ada"));
  const auto locks = json_of({"locks", repo_})["locks"];
  ASSERT_EQ(locks.size(), 2U);
  EXPECT_EQ(locks[0]["charts"].dump(), "[1,2]");
  EXPECT_THAT(run_ramcdb({"locks", repo_}).out, AllOf(HasSubstr("Ada"), HasSubstr("Bob"), HasSubstr("3,4")));
  expect_failure(run_ramcdb({"unlock", repo_, "--id", "2", "--owner", "Ada"}), 3);
  expect_failure(run_ramcdb({"unlock", repo_, "--charts", "9", "--owner", "Ada"}), 1);
  expect_done(run_ramcdb({"unlock", repo_, "--charts", "1", "--owner", "Ada"}));
  expect_done(run_ramcdb({"unlock", repo_, "--id", "2", "--owner", "Ada", "--force"}));
  EXPECT_EQ(json_of({"unlock", repo_, "--all", "--owner", "Ada"})["released"].size(), 1U);
  EXPECT_EQ(run_ramcdb({"locks", repo_}).out, "no locks\n");
}

TEST_F(NamesOfVersions, WrongUsageIsRefused) {
  for (const Arguments& arguments :
       std::initializer_list<Arguments>{{"branch"},
                                        {"tag"},
                                        {"lock"},
                                        {"unlock"},
                                        {"locks"},
                                        {"branch", repo_, "-f"},
                                        {"tag", repo_, "-f"},
                                        {"branch", repo_, "-m", "a"},
                                        {"branch", repo_, "a", "-d", "b"},
                                        {"tag", repo_, "a", "-d", "b"},
                                        {"lock", repo_},
                                        {"lock", repo_, "--all", "--for", "soon"},
                                        {"lock", repo_, "--all", "--for", "0h"},
                                        {"lock", repo_, "--all", "--for", "99999w"},
                                        {"lock", repo_, "--all", "--owner", ""},
                                        {"unlock", repo_},
                                        {"unlock", repo_, "--id", "0"},
                                        {"unlock", repo_, "--id", "1", "--all"},
                                        {"checkout", repo_, "--all", "-o", path("x.ply"), "--for", "2h"}}) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(run_ramcdb(arguments), 2);
  }
}

TEST_F(NamesOfVersions, ImportToANewBranch) {
  EXPECT_EQ(json_of({"import", repo_, path("wavy.ply"), "--name", "again", "--branch", "scans"})["revision"], 2);
  EXPECT_EQ(json_of({"ls", repo_, "--at", "scans"})["meshes"].size(), 2U);
  EXPECT_EQ(json_of({"ls", repo_})["meshes"].size(), 1U);
  expect_failure(run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "third", "--branch", "17"}), 1);
}

}  // namespace
}  // namespace ramcdb::test
