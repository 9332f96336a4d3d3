#include <gmock/gmock.h>

#include <sstream>

#include "tests/cli/scene.h"

/// The whole life of an edit, as a person types it.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class EditLoop : public SceneTest {};

TEST_F(EditLoop, ReportsOfARepositorySayWhatIsInIt) {
  EXPECT_THAT(run_ramcdb({"ls", repo_}).out, AllOf(HasSubstr("wavy"), HasSubstr("3,721"), HasSubstr("7,200")));
  EXPECT_THAT(run_ramcdb({"info", repo_}).out,
              AllOf(HasSubstr("boundary loops"), HasSubstr("connectivity"), HasSubstr("bits/vertex")));
  EXPECT_THAT(run_ramcdb({"log", repo_}).out, AllOf(HasSubstr("v1"), HasSubstr("Ada"), HasSubstr("wavy.ply")));
  EXPECT_THAT(run_ramcdb({"show", repo_, "1"}).out, AllOf(HasSubstr("v1 (import on main)"), HasSubstr("Ada")));
}

TEST_F(EditLoop, ImportSaysWhatItFound) {
  const Outcome outcome = run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "again", "--bits", "12"});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("again: 3,721 vertices, 7,200 faces"), HasSubstr("1 component, "),
                                 HasSubstr("1 boundary loop, 0 non-manifold edges"), HasSubstr("error    at most "),
                                 HasSubstr("bits/vertex"), HasSubstr("faces/s")));
}

TEST_F(EditLoop, LatticeOfAnotherMeshIsTakenOver) {
  expect_done(run_ramcdb(
      {"import", repo_, path("wavy.ply"), "--name", "fine", "--precision", "0.00001", "-q", "--chart-faces", "300"}));
  expect_done(run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "twin", "--lattice-of", "fine", "-q"}));
  const auto fine = only_object(run_ramcdb({"info", repo_, "--mesh", "fine", "--json"}).out);
  const auto twin = only_object(run_ramcdb({"info", repo_, "--mesh", "twin", "--json"}).out);
  EXPECT_EQ(fine["lattice"], twin["lattice"]);
  EXPECT_DOUBLE_EQ(fine["lattice"]["step"].get<double>(), 0.00002);
}

TEST_F(EditLoop, ChartsListsOnlyTheRegion) {
  const auto all = only_object(run_ramcdb({"charts", repo_, "--all", "--json"}).out);
  const auto near = only_object(run_ramcdb({"charts", repo_, "--near", "0.5,0.5,0", "--json"}).out);
  const auto grown = only_object(run_ramcdb({"charts", repo_, "--near", "0.5,0.5,0", "--grow", "1", "--json"}).out);
  ASSERT_EQ(near["charts"].size(), 1U);
  EXPECT_GT(grown["charts"].size(), near["charts"][0]["neighbours"].size());
  EXPECT_GT(all["charts"].size(), grown["charts"].size());
}

TEST_F(EditLoop, SeveralShapesAreUnited) {
  const Outcome outcome =
      run_ramcdb({"charts", repo_, "--charts", "1", "--charts", "3-4", "--box", "-1,-1,-1,-0.5,-0.5,-0.5", "--json"});
  expect_done(outcome);
  const auto charts = only_object(outcome.out)["charts"];
  ASSERT_EQ(charts.size(), 3U);
  EXPECT_EQ(charts[0]["id"], 1);
  EXPECT_EQ(charts[2]["id"], 4);
}

TEST_F(EditLoop, UneditedFileWritesNoVersion) {
  const std::string file = checked_out("middle.ply");
  EXPECT_THAT(run_ramcdb({"status", file}).out, HasSubstr("nothing changed"));
  const Outcome commit = run_ramcdb({"commit", file, "-m", "nothing"});
  expect_done(commit);
  EXPECT_THAT(commit.out, HasSubstr("nothing changed: no version written"));
  EXPECT_EQ(only_object(run_ramcdb({"commit", file, "-m", "nothing", "--json"}).out)["revision"], 1);
  EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 1U);
}

TEST_F(EditLoop, EditedVertexComesBackInTheNextVersion) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  EXPECT_THAT(run_ramcdb({"status", file}).out, HasSubstr("vertices moved    1"));
  EXPECT_THAT(run_ramcdb({"diff", file}).out, HasSubstr("largest move"));

  const Outcome commit = run_ramcdb({"commit", file, "-m", "lift a vertex", "--author", "Grace"});
  expect_done(commit);
  EXPECT_THAT(commit.out, HasSubstr("v2 after v1: 1 vertex moved"));

  EXPECT_THAT(run_ramcdb({"log", repo_, "-n", "1"}).out,
              AllOf(HasSubstr("Grace"), HasSubstr("lift a vertex"), Not(HasSubstr("Ada"))));
  EXPECT_THAT(run_ramcdb({"show", repo_, "HEAD"}).out, HasSubstr("vertices moved    1"));
  EXPECT_THAT(run_ramcdb({"diff", repo_, "1", "2"}).out, HasSubstr("vertices moved    1"));
  EXPECT_THAT(run_ramcdb({"diff", repo_, "2", "2"}).out, HasSubstr("no difference"));

  const auto step = only_object(run_ramcdb({"info", repo_, "--json"}).out)["lattice"]["step"].get<double>();
  const auto moved = only_object(run_ramcdb({"diff", repo_, "HEAD~1", "HEAD", "--json"}).out);
  EXPECT_NEAR(moved["max_displacement"].get<double>(), 0.05, step);
  expect_done(run_ramcdb({"verify", repo_}));
}

TEST_F(EditLoop, AttributesThatTheMeshDoesNotHaveAreNamed) {
  const std::string file = checked_out("middle.obj");
  std::istringstream lines(read_text(file));
  std::string painted;
  for (std::string line; std::getline(lines, line);) painted += line + (line.starts_with("v ") ? " 1 0 0\n" : "\n");
  write_text(file, painted);
  EXPECT_THAT(run_ramcdb({"status", file}).out,
              AllOf(HasSubstr("nothing changed"), HasSubstr("not taken         color")));
  const auto commit = only_object(run_ramcdb({"commit", file, "-m", "paint", "--json"}).out);
  EXPECT_EQ(commit["revision"], 1);
  EXPECT_EQ(commit["notes"]["attributes_not_taken"], nlohmann::json({"color"}));
}

/// Takes the last face out of a checked-out text PLY.
void drop_last_face(const std::string& file) {
  std::string ply = read_text(file);
  const std::size_t at = ply.find("element face ") + 13, end = ply.find('\n', at);
  ply.replace(at, end - at, std::to_string(std::stoi(ply.substr(at, end - at)) - 1));
  ply.erase(ply.rfind('\n', ply.size() - 2) + 1);
  write_text(file, ply);
}

TEST_F(EditLoop, FacesThatComeAndGoAreSaidChartByChart) {
  const std::string file = path("all.ply");
  expect_done(run_ramcdb({"checkout", repo_, "--all", "--ascii", "-o", file, "-q"}));
  edit(file);
  drop_last_face(file);
  EXPECT_THAT(run_ramcdb({"status", file}).out,
              AllOf(HasSubstr("faces removed     1"), HasSubstr("  re-meshed       1 ("), HasSubstr("  moved "),
                    HasSubstr("volume            not comparable")));
  const auto status = only_object(run_ramcdb({"status", file, "--json"}).out);
  EXPECT_EQ(status["faces_removed"], 1);
  EXPECT_TRUE(status["volume_change"].is_null());
  EXPECT_EQ(status["notes"]["frame"], "");
  const Outcome commit = run_ramcdb({"commit", file, "-m", "a hole"});
  expect_done(commit);
  EXPECT_THAT(commit.out, AllOf(HasSubstr("1 vertex moved"), HasSubstr("1 face removed")));
  const auto diff = only_object(run_ramcdb({"diff", repo_, "1", "2", "--json"}).out);
  EXPECT_EQ(diff["faces_removed"], 1);
  EXPECT_EQ(diff["vertices_moved"], 1);
}

TEST_F(EditLoop, HeatmapsOfFilesAndVersions) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  const Outcome of_file = run_ramcdb({"diff", file, "--heatmap", path("heat.ply")});
  expect_done(of_file);
  EXPECT_THAT(of_file.out, HasSubstr("heat.ply: dark blue where nothing moved to yellow for 0.0"));
  EXPECT_THAT(read_text(path("heat.ply")), AllOf(HasSubstr("uchar red"), HasSubstr("property float displacement")));
  expect_failure(run_ramcdb({"diff", file, "--heatmap", file}), 1);
  expect_failure(run_ramcdb({"diff", file, "--heatmap", path("heat.obj")}), 1);
  expect_failure(run_ramcdb({"diff", file, "--all"}), 2);
  expect_done(run_ramcdb({"commit", file, "-m", "lift", "-q"}));
  expect_done(run_ramcdb({"diff", repo_, "1", "2", "--heatmap", path("heat.glb"), "--all"}));
  EXPECT_THAT(read_text(path("heat.glb")), HasSubstr("COLOR_0"));
}

TEST_F(EditLoop, CommittedFileMayBeEditedOn) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  expect_done(run_ramcdb({"commit", file, "-m", "first", "-q"}));
  EXPECT_THAT(run_ramcdb({"status", file}).out, HasSubstr("nothing changed"));
  edit(file, -0.02);
  expect_done(run_ramcdb({"commit", file, "-m", "second", "-q"}));
  EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"][0]["id"], 3);
}

TEST_F(EditLoop, SecondEditorOfTheSameChartsGetsAConflict) {
  const std::string first = checked_out("first.ply");
  const std::string second = checked_out("second.ply");
  edit(first);
  edit(second, -0.05);
  expect_done(run_ramcdb({"commit", first, "-m", "first", "-q"}));

  EXPECT_THAT(run_ramcdb({"status", second}).out, HasSubstr("conflicts: charts "));
  expect_failure(run_ramcdb({"commit", second, "-m", "second"}), 3);
  const Outcome json = run_ramcdb({"commit", second, "-m", "second", "--json"});
  EXPECT_EQ(json.code, 3);
  EXPECT_FALSE(only_object(json.out)["conflicts"].empty());
  EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 2U);
}

TEST_F(EditLoop, ExportsOfAllVersionsStandSideBySide) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  expect_done(run_ramcdb({"commit", file, "-m", "lift", "-q"}));
  expect_done(run_ramcdb({"export", repo_, "--at", "1", "-o", path("old.obj"), "-q"}));
  expect_done(run_ramcdb({"export", repo_, "-o", path("new.obj"), "-q"}));
  EXPECT_NE(read_text(path("old.obj")), read_text(path("new.obj")));
  EXPECT_FALSE(std::filesystem::exists(path("new.obj.ramcdb.json"))) << "an export has no way back";
}

TEST_F(EditLoop, ExportIsTheSameOnAnyNumberOfThreads) {
  expect_done(run_ramcdb({"export", repo_, "-o", path("one.ply"), "-j", "1", "-q"}));
  expect_done(run_ramcdb({"export", repo_, "-o", path("four.ply"), "-j", "4", "-q"}));
  EXPECT_EQ(read_text(path("one.ply")), read_text(path("four.ply")));
}

TEST_F(EditLoop, PaintedFilesAreRefusedByCommit) {
  for (const char* color : {"chart", "bits", "version"}) {
    const std::string file = path(std::string(color) + ".ply");
    expect_done(run_ramcdb({"checkout", repo_, "--all", "-o", file, "--color", color, "-q"}));
    EXPECT_THAT(read_text(file), HasSubstr("red"));
    expect_failure(run_ramcdb({"commit", file, "-m", "paint"}), 1);
  }
}

TEST_F(EditLoop, QuietSaysNothing) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  for (const Arguments& arguments :
       {Arguments{"commit", file, "-m", "lift", "-q"}, Arguments{"export", repo_, "-o", path("out.ply"), "-q"},
        Arguments{"verify", repo_, "-q"}}) {
    const Outcome outcome = run_ramcdb(arguments);
    expect_done(outcome);
    EXPECT_EQ(outcome.out, "");
  }
}

}  // namespace
}  // namespace ramcdb::test
