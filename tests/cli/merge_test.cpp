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

}  // namespace
}  // namespace ramcdb::test
