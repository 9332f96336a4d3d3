#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// What a version did is taken back, wholly or in a region, as a person types it.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

using Revert = SceneTest;

TEST_F(Revert, TakesBackWhatABoxHolds) {
  expect_done(run_ramcdb({"transform", repo_, "--all", "--translate", "0,0,0.5", "-m", "up", "-q"}));
  const Outcome left = run_ramcdb({"revert", repo_, "HEAD", "--box", "-1,-1,-1,0.4999,2,2"});
  expect_done(left);
  EXPECT_THAT(left.out,
              AllOf(HasSubstr("v3 after v2"), HasSubstr("in this region"), HasSubstr("1,830 vertices moved")));
  const auto again = only_object(run_ramcdb({"revert", repo_, "2", "--box", "-1,-1,-1,0.4999,2,2", "--json"}).out);
  EXPECT_EQ(again["nothing_changed"], true);
  const auto rest = only_object(run_ramcdb({"revert", repo_, "2", "--sphere", "0.75,0.5,0,9", "--json"}).out);
  EXPECT_EQ(rest["nothing_changed"], false);
  EXPECT_EQ(only_object(run_ramcdb({"diff", repo_, "1", "HEAD", "--json"}).out)["vertices_moved"], 0);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(Revert, TakesBackNamedChartsAndThoseAround) {
  expect_done(run_ramcdb({"transform", repo_, "--all", "--translate", "0,0,0.5", "-m", "up", "-q"}));
  const auto one = only_object(run_ramcdb({"revert", repo_, "2", "--charts", "1", "--branch", "main", "--json"}).out);
  const auto more = only_object(run_ramcdb({"revert", repo_, "2", "--charts", "1", "--grow", "1", "--json"}).out);
  EXPECT_GT(one["vertices_moved"], 100);
  EXPECT_GT(more["vertices_moved"], one["vertices_moved"]);
  expect_failure(run_ramcdb({"revert", repo_, "2", "--charts", "999"}), 1);
  expect_failure(run_ramcdb({"revert", repo_, "2", "--box", "1,2,3"}), 2);
}

}  // namespace
}  // namespace ramcdb::test
