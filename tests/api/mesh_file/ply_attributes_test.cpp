#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/mesh_file/attribute_names.h"
#include "tests/api/mesh_file/files.h"

/// Attributes of vertices, corners and faces in PLY, there and back.
namespace ramcdb::test {
namespace {

using mesh_file::MeshData;
using mesh_file::Scalar;
using testing::HasSubstr;

constexpr NumberType kTypes[] = {NumberType::int8,  NumberType::uint8,  NumberType::int16,   NumberType::uint16,
                                 NumberType::int32, NumberType::uint32, NumberType::float32, NumberType::float64};

/// Numbers of the type, its least and greatest with them.
std::vector<double> numbers(NumberType type, std::size_t count) {
  std::vector<double> values;
  const auto range = mesh_file::range_of(type);
  for (std::size_t i = 0; i < count; ++i) {
    const double any = std::sin(static_cast<double>(i + 1)) * 1e-3;
    if (type == NumberType::float64)
      values.push_back(i == 0 ? -0.0 : i == 1 ? std::numeric_limits<double>::denorm_min() : any);
    else if (type == NumberType::float32)
      values.push_back(static_cast<double>(i == 0   ? std::numeric_limits<float>::max()
                                           : i == 1 ? std::numeric_limits<float>::denorm_min()
                                                    : static_cast<float>(any)));
    else
      values.push_back(i == 0 ? range.least : i == 1 ? range.most : static_cast<double>(i % 100));
  }
  return values;
}

/// A grid of polygons with everything that PLY holds.
MeshData with_everything() {
  MeshData mesh = polygon_grid(7);
  const std::size_t v = mesh.positions.size(), f = mesh.face_count(), c = mesh.corners.size();
  auto& all = mesh.attributes;
  all.push_back(
      attribute("color", AttributeOf::vertex, NumberType::uint8, 4, Meaning::color, numbers(NumberType::uint8, 4 * v)));
  all.push_back(attribute("normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal,
                          numbers(NumberType::float32, 3 * v)));
  all.back().values[5] = all.back().values[4] = all.back().values[3] = kNan;
  all.push_back(attribute("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture,
                          numbers(NumberType::float64, 2 * v)));
  for (const NumberType type : kTypes)
    all.push_back(attribute(fmt::format("v{}", static_cast<int>(type)), AttributeOf::vertex, type, 1, Meaning::other,
                            numbers(type, v)));
  all.push_back(attribute("corner.texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture,
                          numbers(NumberType::float32, 2 * c)));
  for (std::size_t i = 0; i < 12; ++i) all.back().values[i] = kNan;  // the first face, and two corners of the second
  all.push_back(attribute("face.color", AttributeOf::face, NumberType::uint16, 3, Meaning::color,
                          numbers(NumberType::uint16, 3 * f)));
  all.push_back(
      attribute("face.v1", AttributeOf::face, NumberType::int32, 1, Meaning::other, numbers(NumberType::int32, f)));
  all.back().info.fields = {"v1"};
  for (const NumberType type : kTypes)
    all.push_back(attribute(fmt::format("f{}", static_cast<int>(type)), AttributeOf::face, type, 1, Meaning::other,
                            numbers(type, f)));
  mesh.references = {"texture skin one.png", "texture b.jpg"};
  return mesh;
}

TEST(PlyAttributes, EverythingComesBack) {
  const MeshData mesh = with_everything();
  for (const bool ascii : {false, true}) {
    const MeshData read = write_and_read("all.ply", output_of(mesh, Scalar::float64), ascii);
    EXPECT_EQ(bits(read.positions), bits(mesh.positions));
    EXPECT_EQ(read.corners, mesh.corners);
    EXPECT_EQ(read.face_sizes, mesh.face_sizes);
    EXPECT_EQ(read.references, mesh.references);
    EXPECT_TRUE(read.dropped.empty());
    expect_same(read.attributes, mesh.attributes);
    const MeshData twice = write_and_read("all.ply", output_of(read, Scalar::float64), !ascii);
    expect_same(twice.attributes, mesh.attributes);
  }
}

TEST(PlyAttributes, LargePolygons) {
  for (const std::uint32_t size : {127U, 128U, 255U, 256U, 70000U}) {
    MeshData mesh;
    for (std::uint32_t i = 0; i < size; ++i) {
      mesh.positions.push_back({static_cast<double>(i), static_cast<double>(i) * i, 0});
      mesh.corners.push_back(i);
    }
    mesh.face_sizes = {size};
    mesh.attributes = {attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture,
                                 numbers(NumberType::float32, 2 * std::size_t{size}))};
    for (const bool ascii : {false, true}) {
      const MeshData read = write_and_read("large.ply", output_of(mesh, Scalar::float64), ascii);
      EXPECT_EQ(read.corners, mesh.corners);
      expect_same(read.attributes, mesh.attributes);
    }
  }
}

std::string triangle(std::string_view vertex, std::string_view face, std::string_view behind_vertices,
                     std::string_view before_corners, std::string_view behind_corners) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n{}property float y\nproperty float z\nelement face "
      "1\n{}end_header\n0 {} 0 0\n1 {} 0 0\n0 {} 1 0\n{}3 0 1 2{}\n",
      vertex, face, behind_vertices, behind_vertices, behind_vertices, before_corners, behind_corners);
}

constexpr const char* kList = "property list uchar int vertex_indices\n";

std::string of_vertices(std::string_view properties, std::string_view values) {
  return triangle(properties, kList, values, "", "");
}

TEST(PlyAttributes, NamesOfColoursNormalsAndTextureCoordinates) {
  struct Case {
    std::string properties, name;
    Meaning meaning;
    std::vector<std::string> fields;
  };
  const std::vector<Case> all = {
      {"uchar red green blue", "color", Meaning::color, {}},
      {"uchar red green blue alpha", "color", Meaning::color, {}},
      {"float r g b", "color", Meaning::color, {"r", "g", "b"}},
      {"float r g b a", "color", Meaning::color, {"r", "g", "b", "a"}},
      {"ushort diffuse_red diffuse_green diffuse_blue",
       "color",
       Meaning::color,
       {"diffuse_red", "diffuse_green", "diffuse_blue"}},
      {"double nx ny nz", "normal", Meaning::normal, {}},
      {"float s t", "texture", Meaning::texture, {}},
      {"float u v", "texture", Meaning::texture, {"u", "v"}},
      {"float texture_u texture_v", "texture", Meaning::texture, {"texture_u", "texture_v"}},
  };
  for (const Case& c : all) {
    std::vector<std::string> words;
    for (std::size_t begin = 0, end = 0; begin <= c.properties.size(); begin = end + 1) {
      end = std::min(c.properties.find(' ', begin), c.properties.size());
      words.push_back(c.properties.substr(begin, end - begin));
    }
    std::string properties, values;
    std::vector<double> expected;
    for (std::size_t i = words.size(); i-- > 1;) {  // in the file backwards
      properties += fmt::format("property {} {}\n", words[0], words[i]);
      values += fmt::format("{} ", i);
    }
    for (int v = 0; v < 3; ++v)
      for (std::size_t i = 1; i < words.size(); ++i) expected.push_back(static_cast<double>(i));
    const MeshData mesh = read_text("a.ply", of_vertices(properties, values));
    ASSERT_EQ(mesh.attributes.size(), 1U) << c.properties;
    const AttributeInfo& info = mesh.attributes[0].info;
    EXPECT_EQ(info.name, c.name);
    EXPECT_EQ(info.meaning, c.meaning);
    EXPECT_EQ(info.fields, c.fields) << c.properties;
    EXPECT_EQ(mesh.attributes[0].values, expected) << c.properties;
  }
}

TEST(PlyAttributes, NumbersOfDifferentTypesAreNotOneValue) {
  const MeshData mesh = read_text(
      "a.ply",
      of_vertices("property uchar red\nproperty uchar green\nproperty float blue\nproperty float nx\n", "1 2 3 4"));
  ASSERT_EQ(mesh.attributes.size(), 4U);
  for (const char* name : {"red", "green", "blue", "nx"}) EXPECT_EQ(find(mesh, name).info.meaning, Meaning::other);
  const MeshData alpha =
      read_text("a.ply", of_vertices("property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                     "property float alpha\n",
                                     "1 2 3 0.5"));
  EXPECT_EQ(find(alpha, "color").values, (std::vector<double>{1, 2, 3, 1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(find(alpha, "alpha").values, (std::vector<double>{0.5, 0.5, 0.5}));
}

TEST(PlyAttributes, NamesAreUniqueAndComeBack) {
  const std::string text = triangle(
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float r\nproperty float g\nproperty "
      "float "
      "b\nproperty int q\nproperty int q\nproperty int color\n",
      fmt::format("property int q\n{}property uchar texnumber\nproperty int color\n", kList), "1 2 3 4 5 6 7 8 9",
      "10 ", " 11 12");
  const MeshData mesh = read_text("a.ply", text);
  std::vector<std::string> names;
  for (const Attribute& a : mesh.attributes) names.push_back(a.info.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"color", "color_2", "q", "q_2", "color_3", "face.q", "texnumber", "face.color"}));
  EXPECT_EQ(find(mesh, "face.q").info.fields, std::vector<std::string>{"q"});
  EXPECT_EQ(find(mesh, "face.q").values, std::vector<double>{10});
  EXPECT_EQ(find(mesh, "texnumber").values, std::vector<double>{11});
  EXPECT_EQ(find(mesh, "q_2").values, (std::vector<double>{8, 8, 8}));
  const MeshData again = write_and_read("a.ply", output_of(mesh, Scalar::float32), true);
  ASSERT_EQ(again.attributes.size(), mesh.attributes.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(again.attributes[i].values, mesh.attributes[i].values);
}

TEST(PlyAttributes, TexcoordBeforeAndBehindTheCorners) {
  const std::string texcoord = "property list uchar float texcoord\n";
  const std::vector<double> expected{0, 0.25, 0.5, 0.75, kNan, kNan};
  const Attribute uv = attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture, expected);
  expect_same(read_text("a.ply", triangle("", texcoord + kList, "", "6 0 .25 .5 .75 nan nan ", "")).attributes, {uv});
  expect_same(read_text("a.ply", triangle("", kList + texcoord, "", "", " 6 0 .25 .5 .75 nan nan")).attributes, {uv});
  const Attribute none =
      attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture, std::vector<double>(6, kNan));
  const MeshData empty = read_text("a.ply", triangle("", kList + texcoord, "", "", " 0"));
  expect_same(empty.attributes, {none});
  EXPECT_TRUE(empty.dropped.empty());
  const MeshData wrong = read_text("a.ply", triangle("", kList + texcoord, "", "", " 4 1 2 3 4"));
  expect_same(wrong.attributes, {none});
  EXPECT_EQ(dropped(wrong, "lists 'texcoord' without two numbers per corner"), 1U);
  EXPECT_THAT(refusal("a.ply", triangle("", kList + texcoord, "", "", " 200 1 2")), HasSubstr("cut off"));
}

TEST(PlyAttributes, BigEndian) {
  std::string bytes = fmt::format(
      "ply\nformat binary_big_endian 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty double x\nproperty "
      "float y\nproperty short z\nproperty ushort red\nproperty ushort green\nproperty ushort blue\nproperty int "
      "i\nelement face 1\nproperty char kind\n{}property list uint double texcoord\nproperty float area\nend_header\n",
      kList);
  for (int v = 0; v < 3; ++v) {
    bytes += bytes_of(1.5, true) + bytes_of(0.5F, true) + bytes_of(std::int16_t{-3}, true);
    for (const std::uint16_t c : {std::uint16_t{1}, std::uint16_t{0x1234}, std::uint16_t{0xffff}})
      bytes += bytes_of(c, true);
    bytes += bytes_of(std::int32_t{-0x1234567}, true);
  }
  bytes += bytes_of(std::int8_t{-5}) + bytes_of(std::uint8_t{3});
  for (std::int32_t c = 0; c < 3; ++c) bytes += bytes_of(c, true);
  bytes += bytes_of(std::uint32_t{6}, true);
  for (int i = 0; i < 6; ++i) bytes += bytes_of(0.1 * i, true);
  bytes += bytes_of(0.3F, true);
  const MeshData mesh = read_text("a.ply", bytes);
  EXPECT_EQ(mesh.positions, std::vector<Point>(3, {1.5, 0.5, -3}));
  EXPECT_EQ(mesh.references, std::vector<std::string>{"texture a.png"});
  expect_same(
      mesh.attributes,
      {attribute("color", AttributeOf::vertex, NumberType::uint16, 3, Meaning::color,
                 {1, 0x1234, 0xffff, 1, 0x1234, 0xffff, 1, 0x1234, 0xffff}),
       attribute("i", AttributeOf::vertex, NumberType::int32, 1, Meaning::other, {-0x1234567, -0x1234567, -0x1234567}),
       attribute("kind", AttributeOf::face, NumberType::int8, 1, Meaning::other, {-5}),
       attribute("texture", AttributeOf::corner, NumberType::float64, 2, Meaning::texture,
                 {0.1 * 0, 0.1 * 1, 0.1 * 2, 0.1 * 3, 0.1 * 4, 0.1 * 5}),
       attribute("area", AttributeOf::face, NumberType::float32, 1, Meaning::other, {static_cast<double>(0.3F)})});
}

TEST(PlyAttributes, TextNumbersOfATypeAreInItsRange) {
  const auto read = [](const std::string& type, const std::string& value) {
    return of_vertices("property " + type + " q\n", value);
  };
  const std::pair<const char*, const char*> wrong[] = {{"uchar", "256"},
                                                       {"uchar", "-1"},
                                                       {"char", "128"},
                                                       {"char", "-129"},
                                                       {"short", "32768"},
                                                       {"ushort", "-1"},
                                                       {"int", "2147483648"},
                                                       {"uint", "4294967296"},
                                                       {"uint", "-1"},
                                                       {"int", "1.5"},
                                                       {"uchar", "nan"},
                                                       {"int", "inf"},
                                                       {"int", "x"},
                                                       {"float", "1e39"},
                                                       {"double", "1e999"},
                                                       {"float", "1,5"},
                                                       {"uint", "99999999999999999999"}};
  for (const auto& [type, value] : wrong)
    EXPECT_THAT(refusal("a.ply", read(type, value)), HasSubstr("a.ply:11)")) << value;
  const std::tuple<const char*, const char*, double> right[] = {{"uchar", "255", 255},
                                                                {"char", "-128", -128},
                                                                {"uchar", "255.0", 255},
                                                                {"int", "-2147483648", -2147483648.0},
                                                                {"uint", "4294967295", 4294967295.0},
                                                                {"float", "0.1", static_cast<double>(0.1F)},
                                                                {"double", "0.1", 0.1},
                                                                {"float", "nan", kNan},
                                                                {"double", "NaN", kNan},
                                                                {"float", "-inf", -HUGE_VAL},
                                                                {"int", "+7", 7},
                                                                {"float", "1e-60", 0}};
  for (const auto& [type, value, expected] : right) {
    const double q = find(read_text("a.ply", read(type, value)), "q").values.at(2);
    EXPECT_TRUE(q == expected || (std::isnan(q) && std::isnan(expected))) << type << ' ' << value << ' ' << q;
  }
}

TEST(PlyAttributes, WhatTheFormatCannotHoldIsNamed) {
  MeshData mesh = polygon_grid(2);
  const std::size_t v = mesh.positions.size(), c = mesh.corners.size(), f = mesh.face_count();
  mesh.attributes = {
      attribute("uvw", AttributeOf::corner, NumberType::float32, 3, Meaning::texture, std::vector<double>(3 * c, 1)),
      attribute("c", AttributeOf::corner, NumberType::uint8, 1, Meaning::other, std::vector<double>(c, 1)),
      attribute("material", AttributeOf::face, NumberType::uint32, 1, Meaning::material, std::vector<double>(f, 1)),
      attribute("n m", AttributeOf::vertex, NumberType::uint8, 2, Meaning::other, std::vector<double>(2 * v, 1))};
  mesh.attributes[2].info.names = {"red", "blue"};
  mesh.attributes[3].values[4] = mesh.attributes[3].values[5] = kNan;
  mesh.references = {"mtllib a.mtl", "texture a\nb"};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData read = write_and_read("a.ply", output_of(mesh, Scalar::float32), true, &left_out);
  MeshData named;
  named.dropped = left_out;
  EXPECT_EQ(dropped(named, "corner attribute 'uvw'"), c);
  EXPECT_EQ(dropped(named, "corner attribute 'c'"), c);
  EXPECT_EQ(dropped(named, "names of attribute 'material'"), 2U);
  EXPECT_EQ(dropped(named, "missing values of attribute 'n m', written as 0"), 2U);
  EXPECT_EQ(dropped(named, "reference 'mtllib a.mtl'"), 1U);
  EXPECT_EQ(dropped(named, "reference 'texture a\\x0ab'"), 1U);
  EXPECT_EQ(left_out.size(), 6U);
  EXPECT_EQ(find(read, "material").values, std::vector<double>(f, 1));
  EXPECT_EQ(find(read, "n_m_1").values[2], 0);
}

TEST(PlyAttributes, TooManyAreNamed) {
  std::string properties, values;
  for (int i = 0; i < 1000; ++i) {
    properties += "property uchar q\n";
    values += "1 ";
  }
  const MeshData mesh = read_text("a.ply", of_vertices(properties, values));
  EXPECT_EQ(mesh.attributes.size(), 256U);
  EXPECT_TRUE(is_sound(mesh));
  EXPECT_EQ(dropped(mesh, "vertex property 'q' (uchar)"), 3 * (1000U - 256U));
}

}  // namespace
}  // namespace ramcdb::test
