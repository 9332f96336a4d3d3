#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/api/mesh_file/files.h"

/// Colours, texture coordinates, normals, materials, groups, objects and smoothing in OBJ, there and back.
namespace ramcdb::test {
namespace {

using mesh_file::MeshData;
using mesh_file::Scalar;
using Names = std::vector<std::string>;
using Values = std::vector<double>;

const std::string kTextures = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

MeshData there_and_back(const MeshData& mesh) {
  const MeshData read = write_and_read("a.obj", output_of(mesh, Scalar::float64), false);
  EXPECT_EQ(bits(read.positions), bits(mesh.positions));
  EXPECT_EQ(read.corners, mesh.corners);
  EXPECT_EQ(read.face_sizes, mesh.face_sizes);
  EXPECT_EQ(read.references, mesh.references);
  EXPECT_TRUE(read.dropped.empty());
  return read;
}

Attribute named(std::string_view name, Meaning meaning, Names names, Values values) {
  Attribute made = attribute(name, AttributeOf::face, NumberType::uint32, 1, meaning, std::move(values));
  made.info.names = std::move(names);
  return made;
}

TEST(ObjAttributes, OneValuePerVertexIsOfVertices) {
  const MeshData mesh = read_text("a.obj", kFour + kTextures + "vn 0 0 1\nf 4/1/1 3/2/1 2/3/1\nf 4/1/1 2/3/1 1/4/1\n");
  expect_same(mesh.attributes, {attribute("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture,
                                          {0, 1, 1, 1, 1, 0, 0, 0}),
                                attribute("normal", AttributeOf::vertex, NumberType::float64, 3, Meaning::normal,
                                          {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})});
  EXPECT_TRUE(mesh.dropped.empty());
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, EqualValuesOnSeveralLinesAreOneValue) {
  const MeshData mesh = read_text("a.obj", kFour + "vn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//1\nf 3//2 4//2 1//2\n");
  ASSERT_EQ(mesh.attributes.size(), 1U);
  EXPECT_EQ(mesh.attributes[0].info.of, AttributeOf::vertex);
  EXPECT_TRUE(mesh.dropped.empty());
}

TEST(ObjAttributes, SeamsAreOfCorners) {
  const MeshData mesh = read_text("a.obj", kFour + kTextures + "f 1/1 2/2 3/3\nf 1/2 3/3 4/4\n");
  expect_same(mesh.attributes, {attribute("texture", AttributeOf::corner, NumberType::float64, 2, Meaning::texture,
                                          {0, 0, 1, 0, 1, 1, 1, 0, 1, 1, 0, 1})});
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, CornersWithoutAValue) {
  const MeshData mesh = read_text("a.obj", kFour + "vt 0.5 1 2\nvt 3\nvn 1 2 3\nf 1 2/1 3\nf 1/2 3//1 4\n");
  expect_same(
      mesh.attributes,
      {attribute("texture", AttributeOf::corner, NumberType::float64, 3, Meaning::texture,
                 {kNan, kNan, kNan, 0.5, 1, 2, kNan, kNan, kNan, 3, 0, 0, kNan, kNan, kNan, kNan, kNan, kNan}),
       attribute("normal", AttributeOf::corner, NumberType::float64, 3, Meaning::normal,
                 {kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, 1, 2, 3, kNan, kNan, kNan})});
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, IndicesMayPointForwardsAndBackwards) {
  const MeshData mesh = read_text("a.obj", kFour + "vt 9 9\nf 1/2 2/-1 3/3\nvt 1 0\nvt 0 1\n");
  expect_same(mesh.attributes, {attribute("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture,
                                          {1, 0, 9, 9, 0, 1, kNan, kNan})});
}

TEST(ObjAttributes, ColoursOfVertices) {
  const MeshData mesh = read_text("a.obj", "v 0 0 0\nv 1 0 0 0.1 0.2 0.3\nv 0 1 0 255 0 nan\nv 0 0 1 1\nf 1 2 3\n");
  expect_same(mesh.attributes, {attribute("color", AttributeOf::vertex, NumberType::float64, 3, Meaning::color,
                                          {kNan, kNan, kNan, 0.1, 0.2, 0.3, 255, 0, kNan, kNan, kNan, kNan})});
  EXPECT_EQ(dropped(mesh, "vertex weights"), 1U);
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, NamesOfFaces) {
  const std::string face = "f 1 2 3\n";
  const MeshData mesh =
      read_text("a.obj", "mtllib a b.mtl\nmtllib c.mtl\n" + kFour + face + "o body\ng left arm\nusemtl Mat #1\ns 1\n" +
                             face + "f 1 2 3 4\nusemtl skin\ns off\n" + face + "usemtl Mat #1\ng\ns 4294967295\n" +
                             face + "o \xe6\x89\x8b\nusemtl \n" + face);
  EXPECT_EQ(mesh.references, (Names{"mtllib a b.mtl", "mtllib c.mtl"}));
  EXPECT_TRUE(mesh.dropped.empty());
  expect_same(mesh.attributes, {named("object", Meaning::group, {"", "body", "\xe6\x89\x8b"}, {0, 1, 1, 1, 1, 2}),
                                named("group", Meaning::group, {"", "left arm"}, {0, 1, 1, 1, 0, 0}),
                                named("material", Meaning::material, {"", "Mat #1", "skin"}, {0, 1, 1, 2, 1, 0}),
                                named("smoothing", Meaning::other, {}, {0, 1, 1, 0, 4294967295, 4294967295})});
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, NamesFromTheFirstFaceOn) {
  const MeshData mesh = read_text("a.obj", kFour + "g b\nusemtl a\nf 1 2 3\ng a\nf 1 2 3\n");
  expect_same(mesh.attributes, {named("group", Meaning::group, {"b", "a"}, {0, 1}),
                                named("material", Meaning::material, {"a"}, {0, 0})});
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, PolygonsWithEverything) {
  MeshData mesh = polygon_grid(9);
  const std::size_t v = mesh.positions.size(), c = mesh.corners.size(), f = mesh.face_count();
  auto& all = mesh.attributes;
  const auto add = [&](std::string_view name, AttributeOf of, std::uint8_t components, Meaning meaning,
                       std::size_t count) {
    Values values;
    for (std::size_t i = 0; i < count * components; ++i) values.push_back(std::sin(static_cast<double>(i)));
    values[1] = -0.0;
    all.push_back(attribute(name, of, NumberType::float64, components, meaning, values));
  };
  add("color", AttributeOf::vertex, 3, Meaning::color, v);
  add("texture", AttributeOf::corner, 2, Meaning::texture, c);
  add("normal", AttributeOf::vertex, 3, Meaning::normal, v);
  Values numbers;
  for (std::size_t i = 0; i < f; ++i) numbers.push_back(i < 3 ? static_cast<double>(i) : static_cast<double>(i % 3));
  all.push_back(named("material", Meaning::material, {"a", "b", "c"}, numbers));
  all.push_back(named("smoothing", Meaning::other, {}, numbers));
  mesh.references = {"mtllib a.mtl"};
  expect_same(there_and_back(mesh).attributes, mesh.attributes);
}

TEST(ObjAttributes, LinesAreInOrderOfFirstUse) {
  MeshData mesh = read_text("a.obj", kFour + kTextures + "f 1/4 2/1 3/3\nf 1/1 3/2 4/4\n");
  const TempFolder scratch;
  (void)mesh_file::write_mesh(scratch / "a.obj", mesh_file::Format::obj, output_of(mesh, Scalar::float32));
  EXPECT_EQ(read_bytes(scratch / "a.obj"), kFour + "vt 0 1\nvt 0 0\nvt 1 1\nvt 1 0\nf 1/1 2/2 3/3\nf 1/2 3/4 4/1\n");
}

TEST(ObjAttributes, IntegerColoursAreWrittenFromZeroToOne) {
  MeshData mesh = polygon_grid(1);
  mesh.attributes = {attribute("color", AttributeOf::vertex, NumberType::uint8, 4, Meaning::color,
                               Values(4 * mesh.positions.size(), 51))};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData read = write_and_read("a.obj", output_of(mesh, Scalar::float32), false, &left_out);
  EXPECT_EQ(find(read, "color").values, Values(3 * mesh.positions.size(), 51.0 / 255.0));
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].what, "alpha of attribute 'color'");
}

TEST(ObjAttributes, WhatTheFormatCannotHoldIsNamed) {
  MeshData mesh = read_text("a.obj", kFour + "f 1 2 3\n");
  mesh.attributes = {attribute("normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal, Values(12, 1)),
                     attribute("second", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal, Values(12, 1)),
                     attribute("q", AttributeOf::face, NumberType::float32, 1, Meaning::other, {1}),
                     attribute("m", AttributeOf::face, NumberType::float32, 1, Meaning::material, {1}),
                     named("group", Meaning::group, {" a\nb\\"}, {0})};
  mesh.references = {"texture a.png", "mtllib a\n"};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData read = write_and_read("a.obj", output_of(mesh, Scalar::float32), false, &left_out);
  MeshData counted;
  counted.dropped = left_out;
  EXPECT_EQ(dropped(counted, "vertex attribute 'second'"), 4U);
  EXPECT_EQ(dropped(counted, "face attribute 'q'"), 1U);
  EXPECT_EQ(dropped(counted, "face attribute 'm'"), 1U);
  EXPECT_EQ(dropped(counted, "attribute 'normal' of vertices without a face"), 1U);
  EXPECT_EQ(dropped(counted, "names of attribute 'group' with characters that were changed"), 1U);
  EXPECT_EQ(dropped(counted, "reference 'texture a.png'"), 1U);
  EXPECT_EQ(dropped(counted, "reference 'mtllib a\\x0a'"), 1U);
  EXPECT_EQ(left_out.size(), 7U);
  EXPECT_EQ(find(read, "group").info.names, Names{"a_b_"});
}

}  // namespace
}  // namespace ramcdb::test
