#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/api/mesh_file/files.h"

/// What the OFF reader takes, skips and refuses.
namespace ramcdb::test {
namespace {

using Indices = std::vector<std::uint32_t>;
using testing::HasSubstr;

const std::string kBody = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Off, FormsOfTheHeader) {
  for (const char* header :
       {"OFF\n4 1 0\n", "OFF 4 1 0\n", "OFF\n4 1\n", "4 1 0\n", "OFF # a comment\n# more\n\n4 1 0\n",
        "\n\nOFF\n\n4 1 5 # edges\n", "COFF\n4 1 0\n", "STCNOFF\n4 1 0\n"}) {
    const auto mesh = read_text("a.off", header + kBody + "3 0 1 2\n");
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2})) << header;
    EXPECT_EQ(mesh.positions.size(), 4U) << header;
    EXPECT_TRUE(mesh.dropped.empty()) << header;
  }
}

TEST(Off, Polygons) {
  const auto mesh = read_text("a.off", "OFF\n4 2 0\n" + kBody + "4 0 1 2 3 255 0 0\n3 0 1 2 # last\n");
  EXPECT_EQ(mesh.face_sizes, (Indices{4, 3}));
  EXPECT_TRUE(mesh.dropped.empty());
}

TEST(Off, WhatIsDroppedIsNamed) {
  const std::string body = "0 0 0 255 0 0 255\n1 0 0 0.1 0.2\n0 1 0\n3 0 1 2 7\n3 0 1 2 1 2 3 4 5\n3 0 1 2 256 0 0\n";
  const char* wrong = "vertices with more or fewer numbers than the file's first word says";
  for (const auto& [word, count] : {std::pair("COFF", 1U), {"NOFF", 2U}, {"STOFF", 1U}, {"OFF", 2U}, {"CNOFF", 2U}}) {
    const auto mesh = read_text("a.off", std::string(word) + "\n3 3 0\n" + body);
    EXPECT_EQ(dropped(mesh, wrong), count) << word;
    EXPECT_EQ(dropped(mesh, "face colours that are numbers of a colour map"), 1U);
    EXPECT_EQ(dropped(mesh, "further numbers behind faces"), 1U);
    EXPECT_EQ(dropped(mesh, "colours beyond 0..255"), 1U);
    EXPECT_EQ(mesh.dropped.size(), 4U);
    EXPECT_TRUE(is_sound(mesh));
  }
}

TEST(Off, CoordinatesMayStandOnLinesOfTheirOwn) {
  const auto mesh = read_text("a.off", "OFF\n3\n1\n0\n0\n0 0\n\n1 0 0\n0 1\n0\n3\n0\n1 2\n");
  EXPECT_EQ(mesh.positions, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.corners, (Indices{0, 1, 2}));
}

TEST(Off, TextBehindTheLastFaceIsNamed) {
  EXPECT_EQ(dropped(read_text("a.off", "OFF\n4 1 0\n" + kBody + "3 0 1 2\n3 0 1 2\n"), "text behind the last face"),
            1U);
}

TEST(Off, WhatIsRefused) {
  const std::pair<std::string, const char*> all[] = {
      {"", "missing"},
      {"OFF", "missing"},
      {"OFF\n0 0 0\n", "no vertex"},
      {"OFF BINARY\n", "cut off in its counts"},
      {"COFF BINARY\n", "binary OFF with colours"},
      {"4OFF\n1 0 0\n", "kind of OFF"},
      {"nOFF\n1 0 0\n", "kind of OFF"},
      {"OFF\n-4 1 0\n" + kBody, "the number of vertices is negative: -4"},
      {"OFF\n4 -1 0\n" + kBody, "the number of faces is negative: -1"},
      {"OFF\n4000000000 1 0\n" + kBody, "too short for 4000000000"},
      {"OFF\n4 4000000000 0\n" + kBody, "too short for 4000000000"},
      {"OFF\n9223372036854775807 9223372036854775807 0\n", "too short"},
      {"OFF\n9223372036854775808 1 0\n", "whole number"},
      {"OFF\n5 1 0\n" + kBody, "missing"},
      {"OFF\n4 2 0\n" + kBody + "3 0 1 2\n", "missing"},
      {"OFF\n4 1 0\n" + kBody + "0\n", "0 corners"},
      {"OFF\n4 1 0\n" + kBody + "1 0\n", "1 corners"},
      {"OFF\n4 1 0\n" + kBody + "2 0 1\n", "a.off:7)"},
      {"OFF\n4 1 0\n" + kBody + "-3 0 1 2\n", "-3 corners"},
      {"OFF\n4 1 0\n" + kBody + "4000000000 0 1 2\n", "more corners than"},
      {"OFF\n4 1 0\n" + kBody + "3 0 1 4\n", "vertex index 4 does not exist (4 vertices)"},
      {"OFF\n4 1 0\n" + kBody + "3 0 1 4\n", "a.off:7)"},
      {"OFF\n4 1 0\n" + kBody + "3 0 1 -1\n", "does not exist"},
      {"OFF\n4 1 0\n" + kBody + "3 0 1 2 1 2 red\n", "no number: 'red'"},
      {"NOFF\n1 0 0\n0 0 0 1 1 1,5\n", "a.off:3)"},
      {"OFF\n1 0 0\nnan 0 0\n", "a.off:3)"},
      {"OFF\n1 0 0\n0 inf 0\n", "not finite"},
      {"OFF\n1 0 0\n0 0 # 0\n", "missing"},
  };
  for (const auto& [text, words] : all) EXPECT_THAT(refusal("a.off", text), HasSubstr(words)) << text;
}

}  // namespace
}  // namespace ramcdb::test
