#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/api/mesh_file/files.h"

/// What the STL reader takes, skips and refuses.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n";
const std::vector<Point> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};

std::string binary(std::string_view title, std::uint32_t count, std::uint32_t facets, float last = 0.5F,
                   std::uint16_t attribute = 0) {
  std::string bytes(title);
  bytes.resize(80, '\0');
  bytes += bytes_of(count);
  for (std::uint32_t f = 0; f < facets; ++f) {
    for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, last}) bytes += bytes_of(value);
    bytes += bytes_of(attribute);
  }
  return bytes;
}

TEST(Stl, FormsOfText) {
  std::string loud;
  for (const char c : kFacet) loud += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const std::string& text : {"solid\n" + kFacet + "endsolid\n", "solid a b c\n" + kFacet + "endsolid a b c",
                                  "\n  solid\n\n" + kFacet + "\n endsolid\n\n", "SOLID X\n" + loud + "ENDSOLID X\n"}) {
    const auto mesh = read_text("a.stl", text);
    EXPECT_EQ(mesh.positions, kCorners) << text;
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mesh.soup);
  }
}

TEST(Stl, SeveralSolids) {
  const std::string solid = "solid a\n" + kFacet + kFacet + "endsolid a\n";
  EXPECT_EQ(read_text("a.stl", solid + solid).face_count(), 4U);
}

TEST(Stl, DoublesInText) {
  std::string text = "solid\n" + kFacet + "endsolid\n";
  text.replace(text.find("0.5"), 3, "0.12345678901234567");
  const auto mesh = read_text("a.stl", text);
  EXPECT_EQ(mesh.positions[2].z, 0.12345678901234567);
}

TEST(Stl, TheLengthTellsBinaryFromText) {
  for (const char* title : {"", "binary", "solid", "solid facet normal", "solid\nfacet normal 0 0 1\nouter loop\n"}) {
    const auto mesh = read_text("a.stl", binary(title, 2, 2));
    ASSERT_EQ(mesh.face_count(), 2U) << title;
    EXPECT_EQ(mesh.positions[5], kCorners[2]);
    EXPECT_TRUE(mesh.dropped.empty());
  }
}

TEST(Stl, WhatIsDroppedIsNamed) {
  const auto mesh = read_text("a.stl", binary("x", 2, 2, 0.5F, 7) + "tail");
  EXPECT_EQ(mesh.face_count(), 2U);
  EXPECT_EQ(mesh.dropped.size(), 1U);
  EXPECT_EQ(dropped(mesh, "bytes behind the last facet"), 4U);
}

TEST(Stl, AttributeBytesComeBack) {
  std::string bytes = binary("x", 3, 3);
  EXPECT_TRUE(read_text("a.stl", bytes).attributes.empty());
  bytes[84 + 2 * 50 - 2] = '\x34';
  bytes[84 + 2 * 50 - 1] = '\xff';
  const auto mesh = read_text("a.stl", bytes);
  expect_same(mesh.attributes,
              {attribute("attribute", AttributeOf::face, NumberType::uint16, 1, Meaning::other, {0, 0xff34, 0})});
  expect_same(write_and_read("a.stl", output_of(mesh, mesh_file::Scalar::float32), false).attributes, mesh.attributes);
}

TEST(Stl, PolygonsAreWrittenAsTriangles) {
  auto mesh = polygon_grid(3);
  std::vector<double> numbers;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) numbers.push_back(static_cast<double>(f + 1));
  mesh.attributes = {attribute("attribute", AttributeOf::face, NumberType::uint16, 1, Meaning::other, numbers),
                     attribute("q", AttributeOf::face, NumberType::uint16, 1, Meaning::other, numbers)};
  std::vector<mesh_file::Dropped> left_out;
  const auto read = write_and_read("a.stl", output_of(mesh, mesh_file::Scalar::float32), false, &left_out);
  const auto cut = mesh_file::triangulate(mesh);
  ASSERT_EQ(read.face_count(), cut.face.size());
  for (std::size_t t = 0; t < cut.face.size(); ++t) {
    EXPECT_EQ(read.attributes.at(0).values[t], numbers[cut.face[t]]);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(read.positions[3 * t + c], mesh.positions[mesh.corners[cut.corners[t][c]]]);
  }
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].what, "face attribute 'q'");
  EXPECT_EQ(left_out[0].count, mesh.face_count());
}

TEST(Stl, WhatIsRefused) {
  const std::string start = "solid\n";
  const std::pair<std::string, const char*> all[] = {
      {"", "too short"},
      {"x", "too short"},
      {"solid", "no 'endsolid'"},
      {"solid\nendsolid\n", "no facet"},
      {start + kFacet, "cut off"},
      {start + "vertex 0 0 0\n", "outside a facet"},
      {start + "facet\nendfacet\n", "0 vertices"},
      {start + "facet\nvertex 0 0 0\nvertex 0 0 1\nendfacet\n", "2 vertices"},
      {start + "facet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n", "a.stl:6)"},
      {start + "facet\nfacet\n", "inside another"},
      {start + "facet\nvertex 0 0\n", "missing"},
      {start + "facet\nvertex 0 0 nan\n", "not finite"},
      {start + "facet\nvertex 0 inf 0\n", "a.stl:3)"},
      {start + "face\n", "'face' is not STL"},
      {binary("x", 0, 0), "no vertex"},
      {binary("x", 1, 0), "1 triangles announced, room for 0"},
      {binary("x", 4000000000U, 1), "byte 80"},
      {binary("x", 0xffffffffU, 2), "cut off"},
      {binary("x", 2, 2).substr(0, 183), "room for 1"},
      {binary("x", 1, 1, std::numeric_limits<float>::quiet_NaN()), "vertex 2"},
      {binary("x", 1, 1, -std::numeric_limits<float>::infinity()), "not finite"},
  };
  for (const auto& [bytes, words] : all) EXPECT_THAT(refusal("a.stl", bytes), HasSubstr(words)) << bytes;
}

}  // namespace
}  // namespace ramcdb::test
