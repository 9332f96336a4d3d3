#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/api/mesh_file/files.h"
#include "tests/api/mesh_file/samples.h"

/// What the PLY reader takes, skips and refuses, by hand-made files.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";

/// A text PLY with these properties behind x, y and z and these lines.
std::string ascii(std::string_view elements, std::string_view body) {
  return fmt::format("ply\nformat ascii 1.0\n{}end_header\n{}", elements, body);
}

std::string triangle(std::string_view faces, std::string_view face_lines) {
  return ascii(fmt::format("element vertex 3\n{}{}", kXyz, faces), fmt::format("0 0 0\n1 0 0\n0 1 0\n{}", face_lines));
}

constexpr const char* kOneFace = "element face 1\nproperty list uchar int vertex_indices\n";

TEST(Ply, AsciiWithoutNewlineAtTheEnd) {
  for (const char* end : {"", "\n", "\r\n", "\n\n\n"}) {
    const auto mesh = read_text("a.ply", triangle(kOneFace, "3 0 1 2") + end);
    EXPECT_TRUE(is_sound(mesh));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mesh.dropped.empty());
  }
}

TEST(Ply, AllEncodingsSayTheSame) {
  const auto text = read_text("a.ply", sample_ply(0));
  EXPECT_EQ(text.vertex_ids, (std::vector<std::uint64_t>{7, 0x100000008, 0x200000009, 0x30000000a}));
  const double none = std::numeric_limits<double>::quiet_NaN();
  Attribute q = attribute("face.q", AttributeOf::face, NumberType::float32, 1, Meaning::other, {-1.5, -1.5});
  q.info.fields = {"q"};
  expect_same(
      text.attributes,
      {attribute("color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color,
                 {200, 0, 9, 200, 0, 9, 200, 0, 9, 200, 0, 9}),
       attribute("texture", AttributeOf::vertex, NumberType::float64, 2, Meaning::texture,
                 {0, -0.25, 0.5, -0.25, 1, none, 1.5, -0.25}),
       attribute("q", AttributeOf::vertex, NumberType::int32, 1, Meaning::other, {-70000, -69999, -69998, -69997}),
       attribute("texnumber", AttributeOf::face, NumberType::uint16, 1, Meaning::other, {65535, 65535}),
       attribute("flags", AttributeOf::face, NumberType::int16, 1, Meaning::other, {-1, -1}),
       attribute("corner.texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture,
                 {0, 0.5, 1, 1.5, 2, 2.5, 0, 0.5, 1, 1.5, 2, 2.5}),
       q});
  EXPECT_EQ(dropped(text, "element 'camera'"), 1U);
  EXPECT_EQ(text.dropped.size(), 1U);
  for (const int encoding : {1, 2}) {
    const auto binary = read_text("a.ply", sample_ply(encoding));
    EXPECT_EQ(binary.positions.size(), text.positions.size());
    for (std::size_t v = 0; v < text.positions.size(); ++v)
      for (int a = 0; a < 3; ++a)
        EXPECT_EQ(static_cast<float>(binary.positions[v][a]), static_cast<float>(text.positions[v][a]));
    EXPECT_EQ(binary.corners, text.corners);
    EXPECT_EQ(binary.vertex_ids, text.vertex_ids);
    expect_same(binary.attributes, text.attributes);
    EXPECT_EQ(binary.dropped.size(), 1U);
  }
}

struct TypeNames {
  const char *name, *other;
  NumberType type;
  std::string bytes;  ///< of 7, lowest first
};

std::vector<TypeNames> all_types() {
  return {{"char", "int8", NumberType::int8, bytes_of(std::int8_t{7})},
          {"uchar", "uint8", NumberType::uint8, bytes_of(std::uint8_t{7})},
          {"short", "int16", NumberType::int16, bytes_of(std::int16_t{7})},
          {"ushort", "uint16", NumberType::uint16, bytes_of(std::uint16_t{7})},
          {"int", "int32", NumberType::int32, bytes_of(std::int32_t{7})},
          {"uint", "uint32", NumberType::uint32, bytes_of(std::uint32_t{7})},
          {"float", "float32", NumberType::float32, bytes_of(7.0F)},
          {"double", "float64", NumberType::float64, bytes_of(7.0)}};
}

TEST(Ply, NumbersOfAllTypesAreAttributesAndListsAreNamed) {
  for (const bool big : {false, true})
    for (const auto& type : all_types())
      for (const char* name : {type.name, type.other}) {
        const auto put = [&](std::string bytes) { return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes; };
        std::string body;
        for (int v = 0; v < 3; ++v)
          body += put(type.bytes) + bytes_of(v == 1 ? 1.0F : 0.0F, big) + bytes_of(v == 2 ? 1.0F : 0.0F, big) +
                  bytes_of(0.5F, big) + bytes_of(std::uint8_t{2}) + put(type.bytes) + put(type.bytes);
        const auto mesh = read_text(
            "a.ply",
            fmt::format("ply\nformat binary_{}_endian 1.0\nelement vertex 3\nproperty {} more\n{}property list "
                        "uchar {} many\nend_header\n{}",
                        big ? "big" : "little", name, kXyz, name, body));
        EXPECT_EQ(mesh.positions, (std::vector<Point>{{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}})) << name;
        expect_same(mesh.attributes, {attribute("more", AttributeOf::vertex, type.type, 1, Meaning::other, {7, 7, 7})});
        EXPECT_EQ(dropped(mesh, fmt::format("vertex property 'many' (list of {})", name)), 3U);
        EXPECT_EQ(mesh.dropped.size(), 1U);
      }
}

TEST(Ply, CoordinatesOfAllTypes) {
  for (const auto& type : all_types()) {
    const auto mesh = read_text("a.ply", fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty "
                                                     "{0} x\nproperty {0} y\nproperty {0} z\nend_header\n{1}{1}{1}",
                                                     type.name, type.bytes));
    EXPECT_EQ(mesh.positions, (std::vector<Point>{{7, 7, 7}})) << type.name;
  }
}

TEST(Ply, IndicesAndCountsOfAllIntegerTypes) {
  const auto types = all_types();
  for (std::size_t c = 0; c < 6; ++c)
    for (std::size_t i = 0; i < 6; ++i) {
      std::string bytes = fmt::format(
          "ply\nformat binary_little_endian 1.0\nelement vertex 8\n{}element face 1\nproperty list {} {} "
          "vertex_index\nend_header\n{}",
          kXyz, types[c].name, types[i].name, std::string(8 * 12, '\0'));
      bytes += types[c].bytes;
      for (int k = 0; k < 7; ++k) bytes += types[i].bytes;
      const auto mesh = read_text("a.ply", bytes);
      EXPECT_EQ(mesh.corners, std::vector<std::uint32_t>(7, 7));
      EXPECT_EQ(mesh.face_sizes, std::vector<std::uint32_t>{7});
    }
}

TEST(Ply, PolygonsKeepTheirSizes) {
  const auto mesh = read_text(
      "a.ply", ascii(fmt::format("element vertex 5\n{}element face 2\nproperty list uchar int vertex_indices\n", kXyz),
                     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 2\n4 0 1 2 3\n3 4 0 1\n"));
  EXPECT_EQ(mesh.face_sizes, (std::vector<std::uint32_t>{4, 3}));
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 0, 1}));
}

TEST(Ply, FacesBeforeVertices) {
  const auto mesh = read_text(
      "a.ply", ascii(fmt::format("{}element vertex 3\n{}", kOneFace, kXyz), "3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n"));
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{2, 1, 0}));
}

TEST(Ply, BytesBehindTheEndAreNamed) {
  EXPECT_EQ(dropped(read_text("a.ply", triangle(kOneFace, "3 0 1 2\n3 0 1 2\n")), "bytes behind the last element"), 1U);
  EXPECT_EQ(dropped(read_text("a.ply", sample_ply(1) + "x"), "bytes behind the last element"), 1U);
}

TEST(Ply, CountsThatTheFileHasNoRoomForAreRefusedBeforeMemoryIsTaken) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* count : {"5", "4000000000", "9223372036854775807", "18446744073709551616", "-1", "-4", "x", ""}) {
      const std::string start = fmt::format("ply\nformat {} 1.0\n", format);
      EXPECT_THAT(refusal("vertex.ply", fmt::format("{}element vertex {}\n{}end_header\n", start, count, kXyz)),
                  HasSubstr("vertex.ply"));
      const std::string zeros = start[11] == 'a' ? "0 0 0\n" : std::string(12, '\0');
      EXPECT_NE(refusal("face.ply", fmt::format("{}element vertex 1\n{}element face {}\nproperty list uchar int "
                                                "vertex_indices\nend_header\n{}",
                                                start, kXyz, count, zeros)),
                "");
      EXPECT_NE(refusal("other.ply", fmt::format("{}element vertex 1\n{}element other {}\nend_header\n{}", start, kXyz,
                                                 count, zeros)),
                "");
    }
}

TEST(Ply, ListsThatTheFileHasNoRoomForAreRefusedBeforeMemoryIsTaken) {
  for (const std::uint32_t count : {4U, 0x7fffffffU, 0xffffffffU})
    for (const char* name : {"vertex_indices", "other"}) {
      const std::string head = fmt::format(
          "ply\nformat binary_little_endian 1.0\nelement vertex 1\n{}element face 1\nproperty list uint int {}\n{}"
          "end_header\n{}",
          kXyz, name, name[0] == 'o' ? "property list uchar int vertex_indices\n" : "", std::string(12, '\0'));
      EXPECT_THAT(refusal("a.ply", head + bytes_of(count) + std::string(12, '\0')), HasSubstr("cut off"));
    }
  EXPECT_THAT(refusal("a.ply", triangle(kOneFace, "4000000000 0 1 2")), HasSubstr("cut off"));
}

TEST(Ply, IndicesOutOfRangeInBinary) {
  for (const std::int32_t wrong : {1, -1, 0x7fffffff})
    for (const std::uint8_t corners : {std::uint8_t{3}, std::uint8_t{4}})
      for (int at = 0; at < corners; ++at) {
        std::string bytes =
            fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex 1\n{}{}end_header\n", kXyz, kOneFace);
        bytes += std::string(12, '\0') + bytes_of(corners);
        for (int c = 0; c < corners; ++c) bytes += bytes_of(c == at ? wrong : 0);
        EXPECT_THAT(refusal("a.ply", bytes), HasSubstr(wrong < 0 ? "-1 is negative" : "does not exist (1 vertices)"));
      }
}

struct Refused {
  const char *name, *words;
  std::string bytes;
};

std::string one_vertex(float x) {
  return fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex 1\n{}end_header\n", kXyz) + bytes_of(x) +
         std::string(8, '\0');
}

TEST(Ply, WhatIsRefused) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const Refused all[] = {
      {"empty.ply", "not PLY", ""},
      {"no_ply.ply", "not PLY", "plyx\n"},
      {"no_format.ply", "no format", fmt::format("ply\nelement vertex 1\n{}end_header\n0 0 0\n", kXyz)},
      {"two_formats.ply", "twice", "ply\nformat ascii 1.0\nformat ascii 1.0\n"},
      {"format.ply", "encoding 'utf8'", "ply\nformat utf8 1.0\n"},
      {"no_end.ply", "does not end", "ply\nformat ascii 1.0\n"},
      {"no_vertex.ply", "no element 'vertex'", ascii("", "")},
      {"no_vertices.ply", "no vertex", ascii(fmt::format("element vertex 0\n{}", kXyz), "")},
      {"no_z.ply", "no x, y and z", ascii("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n")},
      {"list_x.ply", "no x, y and z",
       ascii("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n", "0 0 0\n")},
      {"two_x.ply", "twice", ascii(fmt::format("element vertex 1\nproperty float x\n{}", kXyz), "0 0 0 0\n")},
      {"two_vertex.ply", "twice",
       ascii(fmt::format("element vertex 1\n{0}element vertex 1\n{0}", kXyz), "0 0 0 0 0 0")},
      {"type.ply", "unknown type 'long'", ascii("element vertex 1\nproperty long x\n", "0")},
      {"count_type.ply", "count type", ascii("element face 1\nproperty list float int vertex_indices\n", "3 0 0 0")},
      {"early.ply", "before any element", ascii("property float x\n", "")},
      {"line.ply", "unknown header line", ascii("elements vertex 1\n", "")},
      {"no_list.ply", "no list", triangle("element face 1\nproperty int flags\n", "0\n")},
      {"float_list.ply", "no list",
       triangle("element face 1\nproperty list uchar float vertex_indices\n", "3 0 1 2\n")},
      {"strips.ply", "strips", triangle("element tristrips 1\nproperty list int int vertex_indices\n", "3 0 1 2\n")},
      {"corners0.ply:13", "0 corners", triangle(faces, "0\n\n\n\n\n\n\n\n")},
      {"corners1.ply:13", "1 corners", triangle(faces, "1 0\n\n\n\n\n\n\n\n")},
      {"corners2.ply:13", "2 corners", triangle(faces, "2 0 1\n\n\n\n\n\n\n\n")},
      {"corners_negative.ply:13", "negative", triangle(faces, "-3 0 1 2\n")},
      {"index3.ply:13", "vertex index 3", triangle(faces, "3 0 1 3\n")},
      {"index_negative.ply:13", "negative", triangle(faces, "3 0 -1 2\n")},
      {"index_huge.ply:13", "whole number", triangle(faces, "3 0 1 99999999999999999999\n")},
      {"index_fraction.ply:13", "whole number", triangle(faces, "3 0 1 1.5\n")},
      {"nan.ply:8", "not finite", ascii(fmt::format("element vertex 1\n{}", kXyz), "nan 0 0\n")},
      {"inf.ply:8", "not finite", ascii(fmt::format("element vertex 1\n{}", kXyz), "0 -inf 0\n")},
      {"huge.ply:8", "too large", ascii(fmt::format("element vertex 1\n{}", kXyz), "0 0 1e999\n")},
      {"word.ply:8", "no number: 'zero'", ascii(fmt::format("element vertex 1\n{}", kXyz), "0 zero 0\n")},
      {"binary_nan.ply", "vertex 0", one_vertex(std::numeric_limits<float>::quiet_NaN())},
      {"binary_inf.ply", "vertex 0", one_vertex(-infinity)},
  };
  for (const auto& [place, words, bytes] : all) {
    const std::string name = std::string(place).substr(0, std::string(place).find(':'));
    const std::string text = refusal(name, bytes);
    EXPECT_THAT(text, HasSubstr(words)) << place;
    EXPECT_THAT(text, HasSubstr(place));
  }
}

}  // namespace
}  // namespace ramcdb::test
