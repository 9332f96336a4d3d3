#include <csignal>
#include <thread>

#include "tests/cli/scene.h"

namespace ramcdb::test {
namespace {

class Interrupt : public SceneTest {};

TEST_F(Interrupt, CtrlCDuringImportLeavesEverythingAsItWas) {
  write_text(path("large.ply"), wavy_ply(500));
  RunningProgram import({"import", repo_, path("large.ply"), "-j", "1"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  import.send(SIGINT);
  const Outcome outcome = import.wait();
  expect_failure(outcome, 130);
  EXPECT_EQ(only_object(run_ramcdb({"ls", repo_, "--json"}).out)["meshes"].size(), 1U);
  expect_done(run_ramcdb({"verify", repo_}));
}

TEST_F(Interrupt, SecondCtrlCEndsAtOnce) {
  write_text(path("large.ply"), wavy_ply(500));
  RunningProgram import({"import", repo_, path("large.ply"), "-j", "1"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  import.send(SIGINT);
  import.send(SIGINT);
  EXPECT_EQ(import.wait().code, 130);
  expect_done(run_ramcdb({"verify", repo_}));
}

}  // namespace
}  // namespace ramcdb::test
