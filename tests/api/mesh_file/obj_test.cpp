#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>

#include "api/mesh_file/file_bytes.h"
#include "tests/api/mesh_file/files.h"

/// What the OBJ reader takes, skips and refuses.
namespace ramcdb::test {
namespace {

using Indices = std::vector<std::uint32_t>;
using testing::HasSubstr;

TEST(Obj, FormsOfCorners) {
  for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//2 3//3", "f 1/1/1 2/2/2 3/3/3", "f -4 -3 -2",
                           "f -4/-1/-1 -3/-1/-1 -2//-1", "f\t1\t2\t3\t", "  f 1 2 3  ", "f +1 2 3", "f 1/ 2/ 3/",
                           "f 1 2 3 # a triangle", "f 1 2 3 #and its end"}) {
    const auto mesh = read_text("a.obj", kFour + face);
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2})) << face;
    EXPECT_TRUE(mesh.face_sizes.empty());
    const auto full = read_text("a.obj", kFour + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n" + face);
    EXPECT_EQ(full.corners, mesh.corners) << face;
    for (const auto& d : full.dropped) EXPECT_EQ(d.what.find("do not exist"), d.what.npos) << face << d.what;
  }
}

TEST(Obj, NegativeIndicesCountFromTheNewestVertex) {
  const auto mesh = read_text("a.obj", kFour + "f -4 -3 -2\nv 2 2 2\nf -1 -2 -5\n");
  EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 4, 3, 0}));
}

TEST(Obj, PolygonsAndTriangles) {
  const auto mesh = read_text("a.obj", kFour + "f 1 2 3 4\nf 1 2 3\n");
  EXPECT_EQ(mesh.face_sizes, (Indices{4, 3}));
  EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 3, 0, 1, 2}));
}

TEST(Obj, APolygonBehindTriangles) {
  const auto mesh = read_text("a.obj", kFour + "f 1 2 3\nf 2 3 4\nf 1 2 3 4\nf 1 2 3\n");
  EXPECT_EQ(mesh.face_sizes, (Indices{3, 3, 4, 3}));
  EXPECT_TRUE(is_sound(mesh));
}

TEST(Obj, FacesMayStandBeforeTheirVertices) {
  EXPECT_EQ(read_text("a.obj", "f 3 2 1\n" + kFour).corners, (Indices{2, 1, 0}));
}

TEST(Obj, LinesGoOnBehindABackslash) {
  for (const char* end : {"\\\n", "\\\r\n", "\\ \n", " \\\n\\\n"}) {
    const auto mesh = read_text("a.obj", kFour + "f 1 2" + end + " 3" + end + " 4\nf 1 2 3\nv 5 " + end + "5 5\n");
    EXPECT_EQ(mesh.face_sizes, (Indices{4, 3}));
    EXPECT_EQ(mesh.positions.back(), (Point{5, 5, 5}));
  }
}

TEST(Obj, CommentsDoNotGoOn) {
  const auto mesh = read_text("a.obj", "# from C:\\models\\\nv 0 0 0\n  # C:\\\nv 1 0 0 # C:\\\n#\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions.size(), 3U);
}

TEST(Obj, WhatIsDroppedIsNamed) {
  const auto mesh =
      read_text("a.obj", kFour +
                             "vn 0 0 1\nvn 0 0 1\nvt 0 0\nusemtl red\nusemtl blue\ng one\no two\no three\n"
                             "s off\ns on\ns 1\nl 1 2\nv 0 0 1 255 0 0 1\nv 0 0 2 1\nf 1/5/-3 2//1 3\ng\n");
  EXPECT_EQ(mesh.positions.size(), 6U);
  EXPECT_EQ(dropped(mesh, "normals (vn)"), 1U);
  EXPECT_EQ(dropped(mesh, "corners that name normals (vn) that do not exist"), 1U);
  EXPECT_EQ(dropped(mesh, "texture coordinates (vt)"), 1U);
  EXPECT_EQ(dropped(mesh, "corners that name texture coordinates (vt) that do not exist"), 1U);
  EXPECT_EQ(dropped(mesh, "materials (usemtl)"), 1U);
  EXPECT_EQ(dropped(mesh, "groups (g)"), 1U);
  EXPECT_EQ(dropped(mesh, "objects (o)"), 1U);
  EXPECT_EQ(dropped(mesh, "'s' lines"), 2U);
  EXPECT_EQ(dropped(mesh, "'l' lines"), 1U);
  EXPECT_EQ(dropped(mesh, "vertex colours"), 1U);
  EXPECT_EQ(dropped(mesh, "vertex weights"), 2U);
  EXPECT_EQ(mesh.dropped.size(), 11U);
}

TEST(Obj, MadeUpKeywordsCostNeitherTimeNorMemory) {
  std::string text = kFour;
  for (int i = 0; i < 200000; ++i) text += fmt::format("x{}\n", i);
  const auto mesh = read_text("a.obj", text);
  EXPECT_EQ(mesh.dropped.size(), mesh_file::DroppedCounter::kMostNames + 1);
  EXPECT_EQ(dropped(mesh, "things of other names"), 200000 - mesh_file::DroppedCounter::kMostNames);
}

TEST(Obj, NamesOfWhatIsDroppedArePrintable) {
  const auto mesh = read_text("a.obj", kFour + "\xff\x1b[2J" + std::string(1000, 'x') + "\n");
  EXPECT_EQ(dropped(mesh, "'\\xff\\x1b[2J" + std::string(35, 'x') + "' lines"), 1U);
}

TEST(Obj, NumbersAreTheNearestDoubles) {
  for (const char* number : {"0.1", ".1", "1e-1", "+0.1", "562345.1", "123456789.123456789", "1e-310",
                             "0.30000001192092896", "16777217", "4.9e-324", "1e300", "-0"}) {
    const auto mesh = read_text("a.obj", std::string("v ") + number + " 0 0\n");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(mesh.positions[0].x),
              std::bit_cast<std::uint64_t>(std::strtod(number, nullptr)))
        << number;
  }
}

TEST(Obj, WhatIsRefused) {
  const std::pair<std::string, const char*> all[] = {
      {"", "no vertex"},
      {"# nothing\n", "no vertex"},
      {"f 1 2 3\n", ":1): "},
      {kFour + "f 1 2 5\nf 1 2 3\n", "vertex index 5 does not exist (4 vertices)"},
      {kFour + "f 1 2 5\nf 1 2 3\n", ":5): "},
      {kFour + "f 1 2 -5\n", ":5): "},
      {kFour + "f 1 2 0\n", "vertex index 0"},
      {kFour + "f 1 2 9223372036854775807\n", "does not exist"},
      {kFour + "f 1 2 -9223372036854775808\n", "does not exist"},
      {kFour + "f 1 2 9223372036854775808\n", "whole number"},
      {kFour + "f 1 2 4294967296\n", "does not exist"},
      {kFour + "f\n", "0 corners"},
      {kFour + "f 1\n", "1 corners"},
      {kFour + "f 1 2\n", "2 corners"},
      {kFour + "f 1 2 /3\n", "missing"},
      {kFour + "f 1 2 3.0\n", "whole number"},
      {kFour + "f 1 2 +-3\n", "whole number"},
      {kFour + "f 1/x 2 3\n", "texture coordinates (vt): an index is no whole number: 'x'"},
      {kFour + "f 1/1/1/1 2 3\n", "a corner has more than three indices"},
      {kFour + "vn 0 0\n", "normals (vn) with 2 numbers"},
      {kFour + "vt\n", "texture coordinates (vt) with 0 numbers"},
      {kFour + "vt 0 1,5\n", "no number: '1,5'"},
      {"v 0 0 0 1 0 red\n", "no number: 'red'"},
      {"v 0 0\n", "missing"},
      {"v 0 0 # 0\n", "missing"},
      {"v 0 0 nan\n", "not finite"},
      {"v 0 0 -inf\n", "not finite"},
      {"v 0 0 1e999\n", "too large"},
      {"v 0 0 +-1\n", "no number"},
      {"v 0 0 1,5\n", "no number: '1,5'"},
      {"v 0 0 0x10\n", "no number"},
      {"v 0 0 1.5f\n", "no number"},
  };
  for (const auto& [text, words] : all) EXPECT_THAT(refusal("a.obj", text), HasSubstr(words)) << text;
}

}  // namespace
}  // namespace ramcdb::test
