#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/files.h"

namespace ramcdb::test {
namespace {

using mesh_file::MeshData;
using mesh_file::Scalar;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Two quads and a triangle over seven vertices, one of them alone.
MeshData sample() {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {5, 5, 5}};
  mesh.corners = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 5};
  mesh.face_sizes = {4, 4, 3};
  return mesh;
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> all;
  for (const double number : numbers) all.push_back(std::isnan(number) ? 1 : std::bit_cast<std::uint64_t>(number));
  return all;
}

MeshData write_and_read(const char* name, const MeshData& mesh, bool ascii = false,
                        std::vector<mesh_file::Dropped>* dropped = nullptr) {
  const ScratchFolder scratch;
  const auto file = scratch.file(name);
  auto left_out = mesh_file::write_mesh(
      file, mesh_file::format_of(file),
      {mesh.positions, mesh.corners, mesh.face_sizes, Scalar::float64, {}, {}, mesh.attributes, mesh.references},
      ascii);
  if (dropped) *dropped = std::move(left_out);
  return mesh_file::read_mesh(file);
}

void expect_same(const Attribute& read, const Attribute& written) {
  EXPECT_EQ(read.info.of, written.info.of) << written.info.name;
  EXPECT_EQ(read.info.type, written.info.type) << written.info.name;
  EXPECT_EQ(read.info.components, written.info.components) << written.info.name;
  EXPECT_EQ(read.info.meaning, written.info.meaning) << written.info.name;
  EXPECT_EQ(read.info.names, written.info.names) << written.info.name;
  EXPECT_EQ(bits_of(read.values), bits_of(written.values)) << written.info.name;
}

Attribute make(std::string name, AttributeOf of, NumberType type, std::uint8_t components, Meaning meaning,
               std::vector<double> values) {
  return {{std::move(name), of, type, components, meaning, {}, {}}, std::move(values)};
}

TEST(PlyAttributes, EveryTypeOfVertexAndFaceComesBack) {
  MeshData mesh = sample();
  constexpr double kExtremes[8][2] = {{-128, 127},
                                      {0, 255},
                                      {-32768, 32767},
                                      {0, 65535},
                                      {-2147483648.0, 2147483647},
                                      {0, 4294967295.0},
                                      {-0.0, 3.4028234663852886e38},
                                      {-5e-324, 1.7976931348623157e308}};
  for (int t = 1; t <= 8; ++t)
    for (const AttributeOf of : {AttributeOf::vertex, AttributeOf::face}) {
      std::vector<double> values;
      for (std::size_t i = 0; i < (of == AttributeOf::vertex ? 7 : 3); ++i) values.push_back(kExtremes[t - 1][i % 2]);
      mesh.attributes.push_back(make((of == AttributeOf::vertex ? "v" : "f") + std::to_string(t), of,
                                     static_cast<NumberType>(t), 1, Meaning::other, values));
    }
  for (const bool ascii : {false, true}) {
    const MeshData read = write_and_read("a.ply", mesh, ascii);
    EXPECT_TRUE(is_sound(read));
    EXPECT_EQ(read.corners, mesh.corners);
    EXPECT_EQ(read.face_sizes, mesh.face_sizes);
    EXPECT_EQ(read.attributes.size(), mesh.attributes.size());
    EXPECT_TRUE(read.dropped.empty());
    for (const Attribute& attribute : mesh.attributes) expect_same(attribute_of(read, attribute.info.name), attribute);
  }
}

TEST(PlyAttributes, ColoursNormalsAndTextureCoordinatesComeBack) {
  MeshData mesh = sample();
  std::vector<double> color, normal, texture, wedges;
  for (int i = 0; i < 28; ++i) color.push_back(i * 9);
  for (int i = 0; i < 21; ++i) normal.push_back(0.25 * i);
  for (int i = 0; i < 14; ++i) texture.push_back(0.125 * i);
  for (int i = 0; i < 22; ++i) wedges.push_back(i >= 4 && i < 6 ? kNone : 0.5 * i);
  mesh.attributes = {make("color", AttributeOf::vertex, NumberType::uint8, 4, Meaning::color, color),
                     make("normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal, normal),
                     make("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture, texture),
                     make("face.texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture, wedges)};
  mesh.attributes[2].info.fields = {"s", "t"};
  mesh.references = {"texture my skin.png"};
  for (const bool ascii : {false, true}) {
    const MeshData read = write_and_read("a.ply", mesh, ascii);
    ASSERT_EQ(read.attributes.size(), 4U);
    for (const Attribute& attribute : mesh.attributes) expect_same(attribute_of(read, attribute.info.name), attribute);
    EXPECT_EQ(attribute_of(read, "texture").info.fields, (std::vector<std::string>{"s", "t"}));
    EXPECT_EQ(read.references, mesh.references);
  }
}

TEST(PlyAttributes, PropertiesOfTwoTypesStayApart) {
  const MeshData read = read_text("a.ply",
                                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                  "property float z\nproperty uchar red\nproperty uchar green\nproperty float blue\n"
                                  "property int quality\nelement face 1\nproperty int quality\n"
                                  "property list uchar int vertex_indices\nend_header\n"
                                  "0 0 0 1 2 0.5 -7\n1 0 0 1 2 0.5 -7\n0 1 0 1 2 0.5 -7\n9 3 0 1 2\n");
  EXPECT_EQ(read.attributes.size(), 5U);
  EXPECT_EQ(attribute_of(read, "blue").values, (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(attribute_of(read, "quality").info.of, AttributeOf::vertex);
  EXPECT_EQ(attribute_of(read, "face.quality").values, (std::vector<double>{9}));
  EXPECT_EQ(attribute_of(read, "face.quality").info.fields, (std::vector<std::string>{"quality"}));
}

TEST(PlyAttributes, NumbersBeyondTheirTypeAreRefusedWithTheirLine) {
  for (const char* number : {"256", "-1", "1.5", "nan"})
    EXPECT_NE(refusal("a.ply", std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                                           "y\nproperty float z\nproperty uchar red\nend_header\n0 0 0 ") +
                                   number + "\n")
                  .find(":9"),
              std::string::npos)
        << number;
}

TEST(ObjAttributes, SeamsColoursMaterialsAndGroupsComeBack) {
  MeshData mesh = sample();
  std::vector<double> color, wedges, normals;
  for (int i = 0; i < 21; ++i) color.push_back(i / 32.0);
  for (int i = 0; i < 22; ++i) wedges.push_back(i >= 4 && i < 6 ? kNone : (i % 7) / 8.0);
  for (int i = 0; i < 33; ++i) normals.push_back(i >= 9 && i < 12 ? kNone : (i % 5) / 4.0);
  mesh.attributes = {make("color", AttributeOf::vertex, NumberType::float64, 3, Meaning::color, color),
                     make("texture", AttributeOf::corner, NumberType::float64, 2, Meaning::texture, wedges),
                     make("normal", AttributeOf::corner, NumberType::float64, 3, Meaning::normal, normals),
                     make("material", AttributeOf::face, NumberType::uint32, 1, Meaning::material, {0, 1, 0}),
                     make("group", AttributeOf::face, NumberType::uint32, 1, Meaning::group, {0, 0, 1}),
                     make("object", AttributeOf::face, NumberType::uint32, 1, Meaning::group, {0, 0, 0}),
                     make("smoothing", AttributeOf::face, NumberType::uint32, 1, Meaning::other, {0, 3, 0})};
  mesh.attributes[3].info.names = {"red brick", "glass"};
  mesh.attributes[4].info.names = {"", "roof"};
  mesh.attributes[5].info.names = {"house"};
  mesh.references = {"mtllib house.mtl"};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData read = write_and_read("a.obj", mesh, false, &left_out);
  EXPECT_TRUE(left_out.empty());
  EXPECT_TRUE(read.dropped.empty());
  EXPECT_EQ(read.corners, mesh.corners);
  EXPECT_EQ(read.face_sizes, mesh.face_sizes);
  EXPECT_EQ(read.references, mesh.references);
  ASSERT_EQ(read.attributes.size(), mesh.attributes.size());
  for (const Attribute& attribute : mesh.attributes) expect_same(attribute_of(read, attribute.info.name), attribute);
}

TEST(ObjAttributes, ValuesThatAreOnePerVertexAreOfVertices) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 1 0\nf 1/1 2/2 3/3\nf 2/5 4/4 3/3\n";
  const Attribute texture = attribute_of(read_text("a.obj", text), "texture");
  EXPECT_EQ(texture.info.of, AttributeOf::vertex);
  EXPECT_EQ(texture.values, (std::vector<double>{0, 0, 1, 0, 0, 1, 1, 1}));
  EXPECT_EQ(attribute_of(read_text("a.obj", text + "f 1/4 2/2 4/4\n"), "texture").info.of, AttributeOf::corner);
}

TEST(ObjAttributes, IndicesBeyondTheValuesAreRefused) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  EXPECT_NE(refusal("a.obj", start + "f 1/1 2/2 3/1\n").find(":6"), std::string::npos);
  EXPECT_NE(refusal("a.obj", start + "f 1//1 2//1 3//9\n").find(":6"), std::string::npos);
  EXPECT_NE(refusal("a.obj", start + "f 1/-2 2/1 3/1\n").find(":6"), std::string::npos);
  EXPECT_NE(refusal("a.obj", start + "f 1/0 2/1 3/1\n").find(":6"), std::string::npos);
}

TEST(OffAttributes, ColoursNormalsAndTextureCoordinatesComeBack) {
  MeshData mesh = sample();
  std::vector<double> bytes, floats, normal, texture;
  for (int i = 0; i < 28; ++i) bytes.push_back(i * 9);
  for (int i = 0; i < 21; ++i) floats.push_back(i / 32.0), normal.push_back(0.5 * i);
  for (int i = 0; i < 14; ++i) texture.push_back(0.25 * i);
  for (const auto& color : {make("color", AttributeOf::vertex, NumberType::uint8, 4, Meaning::color, bytes),
                            make("color", AttributeOf::vertex, NumberType::float64, 3, Meaning::color, floats)})
    for (int which = 1; which < 16; ++which) {
      mesh.attributes.clear();
      if (which & 1) mesh.attributes.push_back(color);
      if (which & 2)
        mesh.attributes.push_back(make("normal", AttributeOf::vertex, NumberType::float64, 3, Meaning::normal, normal));
      if (which & 4)
        mesh.attributes.push_back(
            make("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture, texture));
      if (which & 8)
        mesh.attributes.push_back(make(which & 1 ? "face.color" : "color", AttributeOf::face, NumberType::uint8, 3,
                                       Meaning::color, {1, 2, 3, 4, 5, 6, 7, 8, 9}));
      const MeshData read = write_and_read("a.off", mesh);
      EXPECT_EQ(read.face_sizes, mesh.face_sizes);
      ASSERT_EQ(read.attributes.size(), mesh.attributes.size()) << which;
      for (const Attribute& attribute : mesh.attributes)
        expect_same(attribute_of(read, attribute.info.name), attribute);
    }
}

TEST(StlAttributes, PolygonsBecomeTrianglesAndBytesStay) {
  MeshData mesh = sample();
  mesh.attributes = {make("attribute", AttributeOf::face, NumberType::uint16, 1, Meaning::other, {7, 0, 65535})};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData read = write_and_read("a.stl", mesh, false, &left_out);
  EXPECT_EQ(attribute_of(read, "attribute").values, (std::vector<double>{7, 7, 0, 0, 65535}));
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].count, 2U);
}

TEST(Attributes, WhatAFormatCannotHoldIsNamed) {
  MeshData mesh = sample();
  mesh.attributes = {
      make("heat", AttributeOf::vertex, NumberType::float32, 1, Meaning::other, std::vector<double>(7, 1))};
  for (const char* name : {"a.obj", "a.off", "a.stl"}) {
    std::vector<mesh_file::Dropped> left_out;
    (void)write_and_read(name, mesh, false, &left_out);
    ASSERT_FALSE(left_out.empty()) << name;
    EXPECT_EQ(left_out.back().what, "vertex attribute 'heat' (float)") << name;
    EXPECT_EQ(left_out.back().count, 7U) << name;
  }
}

TEST(Attributes, EveryPrefixOfAFileIsRefusedOrSound) {
  MeshData mesh = sample();
  mesh.attributes = {
      make("color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, std::vector<double>(21, 9)),
      make("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture, std::vector<double>(22, 0.5)),
      make("flags", AttributeOf::face, NumberType::int32, 1, Meaning::other, {1, 2, 3})};
  const ScratchFolder scratch;
  for (const auto& [name, ascii] : {std::pair{"a.ply", false}, {"a.ply", true}, {"a.obj", false}, {"a.off", false}}) {
    const auto file = scratch.file(name);
    (void)mesh_file::write_mesh(
        file, mesh_file::format_of(file),
        {mesh.positions, mesh.corners, mesh.face_sizes, Scalar::float64, {}, {}, mesh.attributes, {}}, ascii);
    const std::string bytes = read_bytes(file);
    std::size_t refused = 0;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      try {
        EXPECT_TRUE(is_sound(read_text(name, std::string_view(bytes).substr(0, size)))) << name << ' ' << size;
      } catch (const Error&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, bytes.size() / 5) << name;
  }
}

}  // namespace
}  // namespace ramcdb::test
