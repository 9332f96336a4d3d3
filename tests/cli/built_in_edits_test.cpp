#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/cli/scene.h"

/// smooth and transform, as a person types them.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

class BuiltInEdits : public SceneTest {
 protected:
  [[nodiscard]] std::size_t files() const {
    const std::filesystem::directory_iterator folder(repo_);
    return static_cast<std::size_t>(std::distance(begin(folder), end(folder)));
  }
};

TEST_F(BuiltInEdits, SmoothSaysWhatItDidAndMakesAVersion) {
  const Outcome outcome = run_ramcdb({"smooth", repo_, "--sphere", "0.5,0.5,0,0.2", "--iterations", "10", "-m",
                                      "smooth the middle", "--author", "Bo", "--memory", "16M"});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("v2 after v1"), HasSubstr("vertices moved"), HasSubstr("re-encoded")));
  EXPECT_THAT(run_ramcdb({"log", repo_}).out, AllOf(HasSubstr("smooth the middle"), HasSubstr("Bo")));
  EXPECT_THAT(run_ramcdb({"show", repo_, "2"}).out, HasSubstr("smooth"));
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(BuiltInEdits, SmoothJsonIsThatOfCommit) {
  const auto report = only_object(
      run_ramcdb({"smooth", repo_, "--all", "--iterations", "3", "--lambda", "1", "-m", "all", "--json"}).out);
  EXPECT_EQ(report["revision"], 2);
  EXPECT_EQ(report["charts_reencoded"], only_object(run_ramcdb({"info", repo_, "--json"}).out)["charts"]);
  EXPECT_EQ(report["conflicts"].size(), 0U);
  EXPECT_EQ(report["normals_left"].size(), 0U);
}

TEST_F(BuiltInEdits, TransformTakesEveryKindOfMap) {
  const std::vector<Arguments> maps = {{"--translate", "0,0,0.5"},
                                       {"--scale", "2", "--center", "0.5,0.5,0"},
                                       {"--scale", "1,1,0.5"},
                                       {"--rotate", "0,0,1,90", "--center", "0.5,0.5,0"},
                                       {"--matrix", "1,0,0,0,0,1,0,0,0,0,1,-0.25,0,0,0,1"}};
  for (std::size_t i = 0; i < maps.size(); ++i) {
    Arguments arguments{"transform", repo_, "--all", "-m", "map", "--json"};
    arguments.insert(arguments.end(), maps[i].begin(), maps[i].end());
    const Outcome outcome = run_ramcdb(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto report = only_object(outcome.out);
    EXPECT_EQ(report["revision"], i + 2);
  }
  const auto box = only_object(run_ramcdb({"info", repo_, "--json"}).out)["box"];
  EXPECT_NEAR(box["lo"][0].get<double>(), -0.5, 1e-3);  // scaled by 2 about its middle, and turned about that
  EXPECT_NEAR(box["hi"][1].get<double>(), 1.5, 1e-3);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(BuiltInEdits, TransformFadesOut) {
  const Outcome outcome = run_ramcdb(
      {"transform", repo_, "--near", "0.5,0.5,0", "--falloff", "0.2", "--translate", "0,0,0.1", "-m", "a hill"});
  expect_done(outcome);
  const auto corner = only_object(run_ramcdb({"charts", repo_, "--near", "0,0,0", "--json"}).out);
  EXPECT_EQ(corner["charts"][0]["version"], 1);
}

TEST_F(BuiltInEdits, DecimateTakesAShareOrANumber) {
  const auto faces = [&] { return only_object(run_ramcdb({"info", repo_, "--json"}).out)["faces"].get<int>(); };
  const int before = faces();
  const Outcome outcome = run_ramcdb({"decimate", repo_, "--all", "--ratio", "0.7", "-m", "coarser"});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("v2 after v1"), HasSubstr(" less in "), HasSubstr("merged with others")));
  EXPECT_NEAR(faces(), before * 0.7, before * 0.05);
  const auto report = only_object(
      run_ramcdb({"decimate", repo_, "--all", "--faces", std::to_string(before / 2), "-m", "x", "--json"}).out);
  EXPECT_EQ(report["revision"], 3);
  EXPECT_NEAR(faces(), before / 2, before * 0.05);
  EXPECT_THAT(run_ramcdb({"decimate", repo_, "--all", "--ratio", "1", "-m", "x"}).out, HasSubstr("no version written"));
  expect_failure(run_ramcdb({"decimate", repo_, "--all", "--ratio", "2", "-m", "x"}), 2);
  expect_failure(run_ramcdb({"decimate", repo_, "--all", "--ratio", "0.5", "--faces", "3", "-m", "x"}), 2);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(BuiltInEdits, ImportIntoAMesh) {
  const auto before = only_object(run_ramcdb({"info", repo_, "--json"}).out);
  const std::string mesh = before["mesh"], file = repo_ + ".more.ply";
  expect_done(run_ramcdb({"export", repo_, "-o", file}));
  const Outcome tried = run_ramcdb({"import", repo_, file, "--into", mesh, "--dry-run"});
  expect_done(tried);
  EXPECT_THAT(tried.out, AllOf(HasSubstr("added"), HasSubstr("nothing was written")));
  const Outcome outcome = run_ramcdb({"import", repo_, file, "--into", mesh, "-m", "once more"});
  expect_done(outcome);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("now version v2"), HasSubstr("error    none"), HasSubstr("new chart")));
  const auto after = only_object(run_ramcdb({"info", repo_, "--json"}).out);
  EXPECT_EQ(after["faces"], 2 * before["faces"].get<int>());
  EXPECT_EQ(after["components"], before["components"].get<int>() + before["components"].get<int>());
  const auto report = only_object(run_ramcdb({"import", repo_, file, "--into", mesh, "--json"}).out);
  EXPECT_EQ(report["faces"], before["faces"]);
  EXPECT_EQ(report["revision"], 3);
  expect_failure(run_ramcdb({"import", repo_, file, "--into", mesh, "--bits", "12"}), 2);
  expect_failure(run_ramcdb({"import", repo_, file, "--into", "nobody"}), 1);
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

TEST_F(BuiltInEdits, WrongUsage) {
  const Arguments smooth{"smooth", repo_, "-m", "x"};
  const auto expect_wrong = [](Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(run_ramcdb(arguments), 2);
  };
  expect_wrong(smooth, {"--all"});
  expect_wrong(smooth, {"--iterations", "3"});
  for (const char* lambda : {"0", "-1", "1.01", "nan", "x"})
    expect_wrong(smooth, {"--all", "--iterations", "3", "--lambda", lambda});
  for (const char* memory : {"0", "-5", "12X", "M", "4GB", "99999999999T", ""})
    expect_wrong(smooth, {"--all", "--iterations", "3", "--memory", memory});
  const Arguments transform{"transform", repo_, "-m", "x", "--all"};
  expect_wrong(transform, {});
  expect_wrong(transform, {"--translate", "1,2"});
  expect_wrong(transform, {"--translate", "1,2,x"});
  expect_wrong(transform, {"--scale", "1,2"});
  expect_wrong(transform, {"--rotate", "0,0,1"});
  expect_wrong(transform, {"--matrix", "1,2,3"});
  expect_wrong(transform, {"--translate", "1,2,3", "--scale", "2"});
  expect_wrong(transform, {"--translate", "1,2,3", "--falloff", "-1"});
  EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 1U);
}

TEST_F(BuiltInEdits, WhatTheLibraryRefusesFails) {
  expect_failure(run_ramcdb({"smooth", repo_, "--charts", "999", "--iterations", "1", "-m", "x"}), 1);
  expect_failure(run_ramcdb({"transform", repo_, "--charts", "1", "--falloff", "1", "--scale", "2", "-m", "x"}), 1);
  expect_failure(run_ramcdb({"transform", repo_, "--all", "--translate", "1e30,0,0", "-m", "x"}), 1);
}

TEST_F(BuiltInEdits, StoppedOrKilledInTheMiddleLeavesNothing) {
  const std::size_t before = files();
  for (const int signal : {SIGINT, SIGKILL}) {
    // More than it could do before the signal comes.
    RunningProgram smooth({"smooth", repo_, "--all", "--iterations", "1000000", "-m", "x"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    smooth.send(signal);
    EXPECT_NE(smooth.wait().code, 0);
    EXPECT_EQ(files(), before);
    EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 1U);
  }
  expect_done(run_ramcdb({"verify", repo_, "-q"}));
}

}  // namespace
}  // namespace ramcdb::test
