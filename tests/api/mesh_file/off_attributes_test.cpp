#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/api/mesh_file/files.h"

/// Colours, normals and texture coordinates in the OFF family, there and back.
namespace ramcdb::test {
namespace {

using mesh_file::MeshData;
using mesh_file::Scalar;
using Values = std::vector<double>;

Attribute color(AttributeOf of, NumberType type, std::uint8_t components, Values values) {
  return attribute("color", of, type, components, Meaning::color, std::move(values));
}
Attribute normal(Values values) {
  return attribute("normal", AttributeOf::vertex, NumberType::float64, 3, Meaning::normal, std::move(values));
}
Attribute texture(Values values) {
  return attribute("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture, std::move(values));
}

/// Three vertices with these numbers behind them and a face with these.
MeshData read(std::string_view word, const std::string (&vertices)[3], std::string_view face) {
  return read_text("a.off", fmt::format("{}\n3 1 0\n0 0 0 {}\n1 0 0 {}\n0 1 0 {}\n3 0 1 2 {}\n", word, vertices[0],
                                        vertices[1], vertices[2], face));
}

/// The mesh comes back, under this first word.
void expect_back(const MeshData& mesh, std::string_view word) {
  EXPECT_TRUE(mesh.dropped.empty());
  const TempFolder scratch;
  const auto file = scratch / "a.off";
  EXPECT_TRUE(mesh_file::write_mesh(file, mesh_file::Format::off, output_of(mesh, Scalar::float64)).empty());
  const std::string text = read_bytes(file);
  EXPECT_EQ(text.substr(0, text.find('\n')), word);
  const MeshData again = mesh_file::read_mesh(file);
  EXPECT_EQ(bits(again.positions), bits(mesh.positions));
  EXPECT_EQ(again.corners, mesh.corners);
  EXPECT_EQ(again.face_sizes, mesh.face_sizes);
  expect_same(again.attributes, mesh.attributes);
}

TEST(OffAttributes, Words) {
  const MeshData colors = read("COFF", {"255 0 1", "1 2 3", "0 0 0"}, "");
  expect_same(colors.attributes, {color(AttributeOf::vertex, NumberType::uint8, 3, {255, 0, 1, 1, 2, 3, 0, 0, 0})});
  expect_back(colors, "COFF");
  const MeshData normals = read("NOFF", {"0 0 1", "0 0.6 0.8", "1 0 0"}, "");
  expect_same(normals.attributes, {normal({0, 0, 1, 0, 0.6, 0.8, 1, 0, 0})});
  expect_back(normals, "NOFF");
  const MeshData textures = read("STOFF", {"0 0", "0.25 1", "2 3"}, "");
  expect_same(textures.attributes, {texture({0, 0, 0.25, 1, 2, 3})});
  expect_back(textures, "STOFF");
  for (const char* word : {"STCNOFF", "STNCOFF"}) {
    const MeshData all =
        read(word, {"0 0 1 10 20 30 40 .5 .25", "0 1 0 11 21 31 41 .75 1", "1 0 0 12 22 32 42 0 9"}, "");
    expect_same(all.attributes,
                {color(AttributeOf::vertex, NumberType::uint8, 4, {10, 20, 30, 40, 11, 21, 31, 41, 12, 22, 32, 42}),
                 normal({0, 0, 1, 0, 1, 0, 1, 0, 0}), texture({0.5, 0.25, 0.75, 1, 0, 9})});
    expect_back(all, "STCNOFF");
  }
}

TEST(OffAttributes, FractionsAndWholeNumbers) {
  const auto vertex = [](NumberType type, std::uint8_t components, Values values) {
    return std::vector<Attribute>{color(AttributeOf::vertex, type, components, std::move(values))};
  };
  const MeshData fractions = read("COFF", {"1.0 0.0 0.5", "0.1 0.2 0.3", "1 1 1"}, "");
  expect_same(fractions.attributes, vertex(NumberType::float64, 3, {1, 0, 0.5, 0.1, 0.2, 0.3, 1, 1, 1}));
  expect_back(fractions, "COFF");
  const MeshData white = read("COFF", {"1.0 1.0 1.0", "0.0 0.0 0.0", "1.0 1.0 1.0"}, "");
  expect_same(white.attributes, vertex(NumberType::float64, 3, {1, 1, 1, 0, 0, 0, 1, 1, 1}));
  expect_back(white, "COFF");
  const MeshData dark = read("COFF", {"1 1 1", "0 0 0", "1 1 1"}, "");
  expect_same(dark.attributes, vertex(NumberType::uint8, 3, {1, 1, 1, 0, 0, 0, 1, 1, 1}));
  expect_back(dark, "COFF");
  const MeshData mixed = read("COFF", {"255 0 51 255", "0.1 0.2 0.3", "0 1 0"}, "");
  expect_same(mixed.attributes, vertex(NumberType::float64, 4, {1, 0, 0.2, 1, 0.1, 0.2, 0.3, 1, 0, 1, 0, 1}));
  expect_back(mixed, "COFF");
  const MeshData alpha = read("COFF", {"255 0 51", "1 2 3 4", "0 0 0"}, "");
  expect_same(alpha.attributes, vertex(NumberType::uint8, 4, {255, 0, 51, 255, 1, 2, 3, 4, 0, 0, 0, 255}));
  expect_back(alpha, "COFF");
}

TEST(OffAttributes, VerticesWithoutAValue) {
  const MeshData mesh = read("CNOFF", {"", "0 0 1 1 2 3", "nan nan nan 4 5 6"}, "");
  expect_same(mesh.attributes, {color(AttributeOf::vertex, NumberType::uint8, 3, {kNan, kNan, kNan, 1, 2, 3, 4, 5, 6}),
                                normal({kNan, kNan, kNan, 0, 0, 1, kNan, kNan, kNan})});
  expect_back(mesh, "CNOFF");
}

TEST(OffAttributes, ColoursOfFaces) {
  const MeshData mesh = read_text(
      "a.off",
      "COFF\n4 3 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n1 1 0 9 9 9\n0 1 0 9 9 9\n4 0 1 2 3 255 0 7\n3 0 1 2\n3 2 1 0 1 2 3\n");
  Attribute faces = color(AttributeOf::face, NumberType::uint8, 3, {255, 0, 7, kNan, kNan, kNan, 1, 2, 3});
  faces.info.name = "face.color";
  expect_same(mesh.attributes, {color(AttributeOf::vertex, NumberType::uint8, 3, Values(12, 9)), faces});
  expect_back(mesh, "COFF");
  const MeshData fractions = read("OFF", {"", "", ""}, "0.5 1 0 0.25");
  expect_same(fractions.attributes, {color(AttributeOf::face, NumberType::float64, 4, {0.5, 1, 0, 0.25})});
  expect_back(fractions, "OFF");
}

TEST(OffAttributes, PaintedFaces) {
  MeshData mesh = polygon_grid(2);
  const std::vector<mesh_file::FaceColor> colors(mesh.face_count(), {1, 200, 255});
  Values values;
  for (std::size_t f = 0; f < colors.size(); ++f) values.insert(values.end(), {1, 200, 255});
  mesh.attributes = {color(AttributeOf::face, NumberType::uint8, 3, Values(values.size(), 5))};
  auto out = output_of(mesh, Scalar::float32);
  out.face_colors = colors;
  for (const char* name : {"a.off", "a.ply"}) {
    std::vector<mesh_file::Dropped> left_out;
    const MeshData painted = write_and_read(name, out, false, &left_out);
    EXPECT_EQ(painted.face_sizes, mesh.face_sizes);
    expect_same(painted.attributes, {color(AttributeOf::face, NumberType::uint8, 3, values)});
    ASSERT_EQ(left_out.size(), 1U);
    EXPECT_EQ(left_out[0].what, "face attribute 'color'");
  }
}

TEST(OffAttributes, WhatTheFormatCannotHoldIsNamed) {
  MeshData mesh = polygon_grid(1);
  const std::size_t v = mesh.positions.size(), c = mesh.corners.size(), f = mesh.face_count();
  mesh.attributes = {color(AttributeOf::vertex, NumberType::uint16, 3, Values(3 * v, 13107)), normal(Values(3 * v, 1)),
                     attribute("q", AttributeOf::vertex, NumberType::float32, 1, Meaning::other, Values(v, 1)),
                     attribute("uv", AttributeOf::corner, NumberType::float32, 2, Meaning::texture, Values(2 * c, 1)),
                     attribute("m", AttributeOf::face, NumberType::float32, 1, Meaning::material, Values(f, 1))};
  mesh.references = {"texture a.png"};
  std::vector<mesh_file::Dropped> left_out;
  const MeshData back = write_and_read("a.off", output_of(mesh, Scalar::float32), false, &left_out);
  EXPECT_EQ(back.face_sizes, mesh.face_sizes);
  EXPECT_EQ(find(back, "color").values, Values(3 * v, 0.2));
  MeshData counted;
  counted.dropped = left_out;
  EXPECT_EQ(dropped(counted, "vertex attribute 'q'"), v);
  EXPECT_EQ(dropped(counted, "corner attribute 'uv'"), c);
  EXPECT_EQ(dropped(counted, "face attribute 'm'"), f);
  EXPECT_EQ(dropped(counted, "reference 'texture a.png'"), 1U);
  EXPECT_EQ(left_out.size(), 4U);
}

}  // namespace
}  // namespace ramcdb::test
