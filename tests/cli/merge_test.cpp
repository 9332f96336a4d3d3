#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// Merges of several meshes, as a person types them.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

class Merge : public SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    expect_done(run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "second", "--chart-faces", "300", "-q"}));
    expect_done(run_ramcdb({"branch", repo_, "side", "-q"}));
  }
  void lift(const char* mesh, const char* branch, const char* sphere, const char* by) const {
    expect_done(run_ramcdb({"transform", repo_, "--mesh", mesh, "--sphere", sphere, "--falloff", "0.05", "--translate",
                            by, "--branch", branch, "-m", "lift", "-q"}));
  }
};

TEST_F(Merge, OfSeveralMeshesIsOneVersionAndOneRevert) {
  for (const char* mesh : {"wavy", "second"}) {
    lift(mesh, "main", "0.2,0.2,0,0.05", "0,0,0.5");
    lift(mesh, "side", "0.8,0.8,0,0.05", "0,0,0.5");
  }
  const auto merged = only_object(run_ramcdb({"merge", repo_, "side", "--json"}).out);
  EXPECT_EQ(merged["revision"], 7);
  ASSERT_EQ(merged["meshes"].size(), 2U);
  EXPECT_EQ(merged["meshes"][1]["mesh"], "wavy");
  EXPECT_GT(merged["vertices_moved"], merged["meshes"][0]["vertices_moved"]);
  const Outcome back = run_ramcdb({"revert", repo_, "HEAD"});
  expect_done(back);
  EXPECT_THAT(back.out, HasSubstr("v8 after v7"));
  for (const char* mesh : {"wavy", "second"})
    EXPECT_EQ(
        only_object(run_ramcdb({"diff", repo_, "--mesh", mesh, "HEAD~2", "HEAD", "--json"}).out)["vertices_moved"], 0);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(Merge, NamesTheConflictsOfAllMeshes) {
  for (const char* mesh : {"wavy", "second"}) {
    lift(mesh, "main", "0.5,0.5,0,0.05", "0,0,0.5");
    lift(mesh, "side", "0.5,0.5,0,0.05", "0,0,0.25");
  }
  const Outcome refused = run_ramcdb({"merge", repo_, "side"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr(" of second and "), HasSubstr(" of wavy"), HasSubstr("mesh second, chart ")));
  const auto places = only_object(run_ramcdb({"merge", repo_, "side", "--json"}).out)["conflict_places"];
  EXPECT_EQ(places.front()["mesh"], "second");
  EXPECT_EQ(places.back()["mesh"], "wavy");
}

using MergedFile = SceneTest;

TEST_F(MergedFile, GoesOnBeingEditedAndCommitted) {
  const std::string mine = checked_out("mine.ply"), theirs = checked_out("theirs.ply");
  edit(mine);
  write_text(theirs, with_lifted_vertex(read_text(theirs), 0.5, 0.6, 0.03));
  expect_done(run_ramcdb({"commit", theirs, "-m", "theirs", "-q"}));
  EXPECT_EQ(run_ramcdb({"commit", mine, "-m", "mine"}).code, 3);
  EXPECT_EQ(only_object(run_ramcdb({"commit", mine, "-m", "mine", "--merge", "--json"}).out)["merged"], true);
  EXPECT_EQ(only_object(run_ramcdb({"status", mine, "--json"}).out)["clean"], true);
  edit(mine, 0.02);
  const auto more = only_object(run_ramcdb({"commit", mine, "-m", "more", "--merge", "--json"}).out);
  EXPECT_EQ(more["vertices_moved"], 1);
  EXPECT_EQ(more["conflicts"].size(), 0U);
  const auto all = only_object(run_ramcdb({"diff", repo_, "1", "HEAD", "--json"}).out);
  EXPECT_EQ(all["vertices_moved"], 2) << "theirs, and mine lifted twice";
  EXPECT_NEAR(all["max_displacement"].get<double>(), 0.07, 1e-4);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

}  // namespace
}  // namespace ramcdb::test
