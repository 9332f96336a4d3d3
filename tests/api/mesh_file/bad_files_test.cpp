#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/api/mesh_file/bad_files.h"
#include "tests/api/mesh_file/files.h"

namespace ramcdb::test {
namespace {

struct Table {
  std::string name;  ///< of a file
  std::vector<BadFile> (*files)();
};

class BadFiles : public testing::TestWithParam<Table> {};

/// As BadFile::expect has it.
std::string summary(const mesh_file::MeshData& mesh) {
  std::string text = fmt::format("reads {} {}", mesh.positions.size(), mesh.face_count());
  for (const auto& [what, count] : mesh.dropped) text += fmt::format("; {} x{}", what, count);
  return text;
}

TEST_P(BadFiles, AreRefusedWithThePlaceOrReadAsSaid) {
  for (const BadFile& file : GetParam().files()) {
    SCOPED_TRACE(file.name);
    try {
      const auto mesh = read_text(GetParam().name, file.bytes);
      EXPECT_EQ(summary(mesh), file.expect);
      EXPECT_TRUE(is_sound(mesh));
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_FALSE(is_read(file)) << text;
      EXPECT_THAT(text, testing::HasSubstr(file.expect));
      EXPECT_THAT(text, testing::HasSubstr(GetParam().name));
      EXPECT_THAT(text, testing::HasSubstr("): ")) << "it does not say how to go on";
      EXPECT_EQ(error.code(), file.code);
      EXPECT_EQ(text.find_first_of("\n\r\t"), text.npos);
      EXPECT_LT(text.size(), 300U);
    }
  }
}

TEST_P(BadFiles, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const BadFile& file : GetParam().files()) EXPECT_TRUE(names.insert(file.name).second) << file.name;
  EXPECT_GE(names.size(), 60U);
}

INSTANTIATE_TEST_SUITE_P(Tables, BadFiles,
                         testing::Values(Table{"a.ply", bad_ply_files}, Table{"a.obj", bad_obj_files},
                                         Table{"a.off", bad_off_files}, Table{"a.stl", bad_stl_files}),
                         [](const auto& test) { return test.param.name.substr(2); });

}  // namespace
}  // namespace ramcdb::test
