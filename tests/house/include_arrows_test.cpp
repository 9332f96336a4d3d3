#include "tests/house/include_arrows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/house/project_tree.h"

namespace ramcdb::house {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

TEST(IncludeArrows, PointDownInThisProject) { EXPECT_THAT(include_violations(project_root()), IsEmpty()); }

/// A tiny house in a folder of its own, correct until a test plants something.
class PlantedTree : public testing::Test {
 protected:
  PlantedTree() : root_(fresh_folder("planted_tree")) {
    for (const char* header : {"bytes.h", "repository.h", "patch.h"})
      write(std::string("api/include/ramcdb/") + header, "#include <vector>\n");
    write("codec/page.h", "#pragma once\n#include \"ramcdb/bytes.h\"\n");
    write("db/store.cpp", "#include <lmdb.h>\n#include \"ramcdb/bytes.h\"\n");
    write("chartify/cut.cpp", "#include <Eigen/Dense>\n");
    write("api/import.cpp", "#include \"codec/page.h\"\n#include \"ramcdb/repository.h\"\n");
    write("cli/main.cpp", "#include <CLI/CLI.hpp>\n#include \"ramcdb/repository.h\"\n");
  }
  ~PlantedTree() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  fs::path root_;
};

TEST_F(PlantedTree, CorrectTreePasses) { EXPECT_THAT(include_violations(root_), IsEmpty()); }

TEST_F(PlantedTree, EveryWrongArrowIsFoundAtItsLine) {
  const struct {
    const char *file, *include;
  } planted[] = {
      {"codec/bad.cpp", "\"db/store.h\""},      // sideways
      {"codec/bad.cpp", "\"api/import.h\""},    // upwards
      {"db/bad.h", "\"ramcdb/repository.h\""},  // upwards: public, but not vocabulary
      {"cli/bad.cpp", "\"codec/page.h\""},      // past the API
      {"api/bad.cpp", "\"cli/main.h\""},        // upwards
      {"api/include/ramcdb/ids.h", "\"ramcdb/repository.h\""},
      {"api/include/ramcdb/bad.h", "\"codec/page.h\""},
      {"api/bad.cpp", "<lmdb.h>"},
      {"db/store.h", "<sqlite3.h>"},
      {"codec/bad.cpp", "<Eigen/Dense>"},
      {"chartify/bad.h", "<Eigen/Dense>"},
      {"api/include/ramcdb/repository.h", "<OpenMesh/Core/IO/MeshIO.hh>"},
      {"api/bad.cpp", "<CLI/CLI.hpp>"},
  };
  for (const char* header : {"db/store.h", "api/import.h", "cli/main.h"}) write(header, "");
  for (const auto& [file, include] : planted) {
    SCOPED_TRACE(std::string(file) + " includes " + include);
    write(file, std::string("#pragma once\n  #  include ") + include + "  // a comment\n");
    EXPECT_THAT(include_violations(root_), ElementsAre(StartsWith(std::string(file) + ":2 includes ")));
    write(file, "");
  }
}

TEST_F(PlantedTree, IncludeThatIsNotWrittenFromTheRootIsFound) {
  write("codec/bad.cpp", "#include \"page.h\"\n");
  EXPECT_THAT(include_violations(root_), ElementsAre(StartsWith("codec/bad.cpp:1 includes page.h")));
}

TEST_F(PlantedTree, FolderWithoutSourcesIsNotTakenForAGoodOne) {
  fs::create_directories(root_ / "nothing_here");
  EXPECT_THROW((void)include_violations(root_ / "nothing_here"), std::runtime_error);
}

}  // namespace
}  // namespace ramcdb::house
