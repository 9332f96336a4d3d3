#include <gmock/gmock.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

#include "tests/cli/scene.h"

/// A disk that is full is said to be full, and nothing changes.
namespace ramcdb::test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

/// A little disk of its own, in memory.
class SmallDisk {
 public:
  SmallDisk(std::string folder, const std::string& size) : folder_(std::move(folder)) {
    std::filesystem::create_directory(folder_);
    mounted_ = ::mount("none", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    if (!mounted_) reason_ = std::strerror(errno);
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  [[nodiscard]] bool mounted() const { return mounted_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

 private:
  std::string folder_, reason_;
  bool mounted_ = false;
};

class DiskFull : public SceneTest {};

TEST_F(DiskFull, ImportOfAMeshThatDoesNotFit) {
  write_text(path("large.ply"), wavy_ply(150));
  int refused = 0, taken = 0;
  for (const char* size : {"120k", "200k", "300k", "400k", "600k", "900k", "8m"}) {
    SCOPED_TRACE(size);
    const SmallDisk disk(path(std::string("disk-") + size), size);
    if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small disk: " << disk.reason();
    const std::string repo = disk.path("r");
    const Outcome init = run_ramcdb({"init", repo});
    if (init.code != 0) {
      expect_failure(init, 1);
      continue;
    }
    const Outcome import = run_ramcdb({"import", repo, path("large.ply"), "--bits", "20", "-q"});
    if (import.code == 0) {
      ++taken;
      EXPECT_EQ(run_ramcdb({"verify", repo}).code, 0);
      continue;
    }
    ++refused;
    expect_failure(import, 1);
    EXPECT_THAT(import.err, HasSubstr("disk full"));
    EXPECT_EQ(only_object(run_ramcdb({"ls", repo, "--json"}).out)["meshes"].size(), 0U);
    EXPECT_EQ(run_ramcdb({"verify", repo}).code, 0);
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(taken, 0);
}

TEST_F(DiskFull, CommitAfterCommitUntilNothingFits) {
  const SmallDisk disk(path("disk"), "500k");
  if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small disk: " << disk.reason();
  const std::string repo = disk.path("r"), file = path("edited.ply");
  expect_done(run_ramcdb({"init", repo, "-q"}));
  expect_done(run_ramcdb({"import", repo, path("wavy.ply"), "--chart-faces", "500", "-q"}));
  expect_done(run_ramcdb({"checkout", repo, "--all", "-o", file, "--ascii", "-q"}));
  Outcome commit;
  for (int round = 0; round < 1000 && commit.code == 0; ++round) {
    edit(file, 0.001);
    commit = run_ramcdb({"commit", file, "-m", "more", "-q"});
  }
  expect_failure(commit, 1);
  EXPECT_THAT(commit.err, HasSubstr("disk full"));
  const auto versions = only_object(run_ramcdb({"log", repo, "--json"}).out)["revisions"].size();
  EXPECT_GT(versions, 1U);
  EXPECT_EQ(run_ramcdb({"verify", repo}).code, 0);
  EXPECT_EQ(run_ramcdb({"commit", file, "-m", "again", "-q"}).code, 1) << "and says so again";
  EXPECT_EQ(only_object(run_ramcdb({"log", repo, "--json"}).out)["revisions"].size(), versions);
}

TEST_F(DiskFull, OutputFilesAreWholeOrNotThere) {
  const SmallDisk disk(path("disk"), "8k");
  if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small disk: " << disk.reason();
  const Outcome outcome = run_ramcdb({"checkout", repo_, "--all", "-o", disk.path("out.ply")});
  expect_failure(outcome, 1);
  EXPECT_THAT(outcome.err, AnyOf(HasSubstr("disk full"), HasSubstr("No space left")));
  EXPECT_FALSE(std::filesystem::exists(disk.path("out.ply")));
}

}  // namespace
}  // namespace ramcdb::test
