#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// Input that cannot be taken ends with exit code 1 and one line, and leaves the repository as it was.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

class BadInput : public SceneTest {
 protected:
  void expect_import_refused(const std::string& name, const std::string& text) {
    SCOPED_TRACE(name);
    write_text(path(name), text);
    expect_failure(run_ramcdb({"import", repo_, path(name)}), 1);
    EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 1U);
  }
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, what.size(), with);
}

std::string small_ply(const std::string& vertices_and_faces) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         vertices_and_faces;
}

TEST_F(BadInput, MeshFiles) {
  const std::string good = wavy_ply(4);
  expect_import_refused("truncated.ply", good.substr(0, good.size() * 2 / 3));
  expect_import_refused("cut_in_header.ply", good.substr(0, 40));
  expect_import_refused("nan.ply", small_ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"));
  expect_import_refused("infinite.ply", small_ply("0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n"));
  expect_import_refused("index.ply", small_ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"));
  expect_import_refused("negative_index.ply", small_ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"));
  expect_import_refused("letters.ply", small_ply("0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"));
  expect_import_refused("empty.ply", replaced(replaced(small_ply(""), "vertex 3", "vertex 0"), "face 1", "face 0"));
  expect_import_refused("nothing.ply", "");
  expect_import_refused("not_a_mesh.ply", std::string(1000, '\x7f'));
  expect_import_refused("unknown.xyz", good);
}

TEST_F(BadInput, ErrorNamesTheFile) {
  write_text(path("nan.ply"), small_ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_THAT(run_ramcdb({"import", repo_, path("nan.ply")}).err, HasSubstr("nan.ply"));
}

TEST_F(BadInput, MissingThings) {
  expect_failure(run_ramcdb({"import", repo_, path("missing.ply")}), 1);
  expect_failure(run_ramcdb({"import", path("missing.ramcdb"), path("wavy.ply")}), 1);
  expect_failure(run_ramcdb({"info", repo_, "--mesh", "horse"}), 1);
  expect_failure(run_ramcdb({"info", repo_, "--at", "99"}), 1);
  expect_failure(run_ramcdb({"info", repo_, "--at", "no-such-branch"}), 1);
  expect_failure(run_ramcdb({"show", repo_, "HEAD~5"}), 1);
  expect_failure(run_ramcdb({"charts", repo_, "--charts", "1,99999"}), 1);
  expect_failure(run_ramcdb({"charts", repo_, "--box", "50,50,50,51,51,51"}), 1);
  expect_failure(run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "x", "--lattice-of", "horse"}), 1);
}

TEST_F(BadInput, WhatIsNotARepository) {
  std::filesystem::create_directory(path("folder"));
  write_text(path("file"), "text");
  for (const char* name : {"folder", "file", "nowhere"})
    for (const char* verb : {"ls", "info", "log", "verify"}) expect_failure(run_ramcdb({verb, path(name)}), 1);
}

TEST_F(BadInput, InitWhereSomethingIs) {
  expect_failure(run_ramcdb({"init", repo_}), 1);
  write_text(path("file"), "text");
  expect_failure(run_ramcdb({"init", path("file")}), 1);
  EXPECT_EQ(read_text(path("file")), "text");
  std::filesystem::create_directory(path("full"));
  write_text(path("full/letter"), "text");
  expect_failure(run_ramcdb({"init", path("full")}), 1);
}

TEST_F(BadInput, AMeshNameIsTakenOnce) { expect_failure(run_ramcdb({"import", repo_, path("wavy.ply")}), 1); }

TEST_F(BadInput, TheMeshMustBeNamedAmongSeveral) {
  expect_done(run_ramcdb({"import", repo_, path("wavy.ply"), "--name", "second", "-q"}));
  expect_failure(run_ramcdb({"info", repo_}), 1);
  expect_done(run_ramcdb({"info", repo_, "--mesh", "second"}));
}

TEST_F(BadInput, OutputThatCannotBeWritten) {
  write_text(path("file"), "text");
  // Below a regular file nobody may write, not even root.
  expect_failure(run_ramcdb({"checkout", repo_, "--all", "-o", path("file/out.ply")}), 1);
  expect_failure(run_ramcdb({"export", repo_, "-o", path("file/out.ply")}), 1);
  expect_failure(run_ramcdb({"export", repo_, "-o", path("no-such-folder/out.ply")}), 1);
  expect_failure(run_ramcdb({"init", path("file/repo")}), 1);
  EXPECT_EQ(read_text(path("file")), "text");
}

TEST_F(BadInput, OutputInAnUnknownFormat) {
  expect_failure(run_ramcdb({"export", repo_, "-o", path("out.docx")}), 1);
  expect_failure(run_ramcdb({"checkout", repo_, "--all", "-o", path("out")}), 1);
  EXPECT_FALSE(std::filesystem::exists(path("out.docx")));
}

TEST_F(BadInput, ExistingFilesAreOverwrittenByForceOnly) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  const std::string edited = read_text(file);
  for (const Arguments& arguments :
       {Arguments{"checkout", repo_, "--all", "-o", file, "-q"}, Arguments{"export", repo_, "-o", file, "-q"}}) {
    expect_failure(run_ramcdb(arguments), 1);
    EXPECT_EQ(read_text(file), edited);
    EXPECT_THAT(run_ramcdb(arguments).err, HasSubstr("--force"));
  }
  expect_done(run_ramcdb({"checkout", repo_, "--charts", "1", "-o", file, "--force", "-q"}));
  EXPECT_NE(read_text(file), edited);
}

TEST_F(BadInput, SidecarMissing) {
  const std::string file = checked_out("middle.ply");
  std::filesystem::remove(file + ".ramcdb.json");
  for (const Arguments& arguments :
       {Arguments{"status", file}, Arguments{"diff", file}, Arguments{"commit", file, "-m", "x"}})
    expect_failure(run_ramcdb(arguments), 1);
}

TEST_F(BadInput, SidecarThatIsNoSidecar) {
  const std::string file = checked_out("middle.ply");
  for (const char* text : {"", "{}", "not json", "{\"repository\": 7}", "[[[[[["}) {
    write_text(file + ".ramcdb.json", text);
    expect_failure(run_ramcdb({"status", file}), 1);
  }
}

TEST_F(BadInput, SidecarOfAnotherRepository) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  // The repository is replaced by another one with the same mesh in the same place.
  std::filesystem::remove_all(repo_);
  SetUp();
  expect_failure(run_ramcdb({"commit", file, "-m", "x"}), 1);
  expect_failure(run_ramcdb({"status", file}), 1);
}

TEST_F(BadInput, RepositoryOfACheckedOutFileIsGone) {
  const std::string file = checked_out("middle.ply");
  std::filesystem::remove_all(repo_);
  expect_failure(run_ramcdb({"status", file}), 1);
}

TEST_F(BadInput, CheckedOutFileWithOtherTriangles) {
  const std::string file = checked_out("middle.ply");
  write_text(file, wavy_ply(3));
  expect_failure(run_ramcdb({"commit", file, "-m", "x"}), 1);
  write_text(file, read_text(file).substr(0, 300));
  expect_failure(run_ramcdb({"commit", file, "-m", "x"}), 1);
  EXPECT_EQ(only_object(run_ramcdb({"log", repo_, "--json"}).out)["revisions"].size(), 1U);
}

TEST_F(BadInput, DamagedStoreIsExitCodeFour) {
  // The whole file with charts becomes noise behind its first pages: whatever a reader meets, it must call it damage.
  for (const auto& entry : std::filesystem::recursive_directory_iterator(repo_)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".mdb" || entry.file_size() < 16384) continue;
    std::string bytes = read_text(entry.path().string());
    for (std::size_t i = 8192; i < bytes.size(); ++i)
      if (i % 4096 > 1024) bytes[i] = static_cast<char>(bytes[i] ^ 0x5a);
    write_text(entry.path().string(), bytes);
  }
  const Outcome outcome = run_ramcdb({"verify", repo_, "-q"});
  expect_failure(outcome, 4);
}

}  // namespace
}  // namespace ramcdb::test
