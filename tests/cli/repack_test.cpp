#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// A mesh coded anew, as a person types it.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

class RepackVerb : public SceneTest {};

TEST_F(RepackVerb, SaysWhatItDidAndTheMeshStays) {
  expect_done(run_ramcdb({"export", repo_, "-o", path("before.ply"), "-q"}));
  const Outcome outcome = run_ramcdb({"repack", repo_, "--profile", "fast", "-m", "for the viewer", "--author", "Bo"});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("v2 after v1"), HasSubstr("now fast"), HasSubstr(" -> ")));
  EXPECT_THAT(run_ramcdb({"info", repo_}).out, HasSubstr("profile      fast"));
  EXPECT_THAT(run_ramcdb({"info", repo_, "--at", "1"}).out, HasSubstr("profile      dense"));
  EXPECT_THAT(run_ramcdb({"log", repo_}).out, AllOf(HasSubstr("for the viewer"), HasSubstr("Bo")));
  EXPECT_THAT(run_ramcdb({"show", repo_, "2"}).out, HasSubstr("repack"));
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
  expect_done(run_ramcdb({"export", repo_, "-o", path("after.ply"), "-q"}));
  EXPECT_EQ(read_text(path("before.ply")).size(), read_text(path("after.ply")).size());
}

TEST_F(RepackVerb, NothingToGainWritesNoVersion) {
  const Outcome outcome = run_ramcdb({"repack", repo_});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, HasSubstr("nothing changed"));
  const auto report = only_object(run_ramcdb({"repack", repo_, "--json"}).out);
  EXPECT_EQ(report["nothing_changed"], true);
  EXPECT_EQ(report["revision"], 1);
}

TEST_F(RepackVerb, JsonHasTheSizes) {
  const auto report = only_object(run_ramcdb({"repack", repo_, "--profile", "fast", "--json"}).out);
  const auto info = only_object(run_ramcdb({"info", repo_, "--json"}).out);
  EXPECT_EQ(report["profile"], "fast");
  EXPECT_EQ(report["parent"], 1);
  EXPECT_EQ(report["charts"], info["charts"]);
  EXPECT_EQ(report["bytes"]["payload"], info["bytes"]["payload"]);
  EXPECT_NE(report["bytes_before"]["payload"], report["bytes"]["payload"]);
  EXPECT_GT(report["bytes_written"], 0);
}

TEST_F(RepackVerb, WrongUsageAndUnknownMeshesAreRefused) {
  EXPECT_EQ(run_ramcdb({"repack", repo_, "--profile", "tiny"}).code, 2);
  EXPECT_EQ(run_ramcdb({"repack"}).code, 2);
  expect_failure(run_ramcdb({"repack", repo_, "--mesh", "nobody"}), 1);
  expect_failure(run_ramcdb({"repack", path("nowhere.ramcdb")}), 1);
}

}  // namespace
}  // namespace ramcdb::test
