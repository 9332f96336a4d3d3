#include "tests/api/mesh_file/samples.h"

#include <fmt/format.h>

#include <limits>

#include "tests/api/mesh_file/files.h"
#include "tests/api/mesh_file/gltf_builder.h"

namespace ramcdb::test {
namespace {

constexpr float kPositions[4][3] = {{0, 0, 0}, {1.5F, 0, 0.1F}, {0, -2, 0}, {0.25F, 1, 3e-7F}};
constexpr int kFaces[2][4] = {{3, 0, 1, 2}, {3, 2, 1, 3}};

std::string binary_stl(std::string_view title, std::uint16_t attribute) {
  std::string bytes(title);
  bytes.resize(80, ' ');
  bytes += bytes_of(std::uint32_t{2});
  for (const auto& face : kFaces) {
    for (int a = 0; a < 3; ++a) bytes += bytes_of(0.0F);
    for (int c = 1; c < 4; ++c)
      for (int a = 0; a < 3; ++a) bytes += bytes_of(kPositions[face[c]][a]);
    bytes += bytes_of(attribute);
  }
  return bytes;
}

std::string ascii_stl() {
  std::string text = "solid two words\n";
  for (const auto& face : kFaces) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (int c = 1; c < 4; ++c)
      text += fmt::format("      vertex {} {} {}\n", kPositions[face[c]][0], kPositions[face[c]][1],
                          kPositions[face[c]][2]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid two words\n";
}

std::string vertex_lines(std::string_view before, std::string_view behind) {
  std::string text;
  for (const auto& p : kPositions) text += fmt::format("{}{} {} {}{}\n", before, p[0], p[1], p[2], behind);
  return text;
}

}  // namespace

std::string sample_ply(int encoding) {
  static constexpr const char* kNames[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string bytes = fmt::format(
      "ply\nformat {} 1.0\ncomment a sample\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uint ramcdb_id_hi\nproperty uint "
      "ramcdb_id_lo\nproperty double s\nproperty double t\nproperty int q\nelement face 2\nproperty ushort texnumber\n"
      "property list uchar int vertex_indices\nproperty short flags\nproperty list ushort float texcoord\n"
      "property float q\nelement camera 1\n"
      "property list uint double view\nproperty char kind\nend_header\n",
      kNames[encoding]);
  std::string line;
  const auto put = [&](auto value) {
    if (encoding)
      bytes += bytes_of(value, encoding == 2);
    else
      line += fmt::format("{}{}", line.empty() ? "" : " ", value);
  };
  const auto end_line = [&] {
    if (!encoding) bytes += line + "\n";
    line.clear();
  };
  for (std::uint32_t v = 0; v < 4; ++v) {
    for (int a = 0; a < 3; ++a) put(kPositions[v][a]);
    for (const std::uint8_t c : {std::uint8_t{200}, std::uint8_t{0}, std::uint8_t{9}}) put(c);
    put(v);
    put(v + 7);
    put(0.5 * v);
    put(v == 2 ? std::numeric_limits<double>::quiet_NaN() : -0.25);
    put(static_cast<std::int32_t>(v) - 70000);
    end_line();
  }
  for (const auto& face : kFaces) {
    put(std::uint16_t{65535});
    put(std::uint8_t{3});
    for (int c = 1; c < 4; ++c) put(face[c]);
    put(std::int16_t{-1});
    put(std::uint16_t{6});
    for (int i = 0; i < 6; ++i) put(0.5F * static_cast<float>(i));
    put(-1.5F);
    end_line();
  }
  put(std::uint32_t{2});
  put(0.5);
  put(-1.0);
  put(std::int8_t{-3});
  end_line();
  return bytes;
}

std::string sample_off(bool big_endian, bool colors) {
  std::string bytes = "OFF BINARY\n";
  const auto put = [&](auto value) { bytes += bytes_of(value, big_endian); };
  for (const int count : {4, 2, 0}) put(count);
  for (const float number : {0.0F, 0.0F, 0.0F, 1.5F, 0.0F, 0.25F, 0.0F, -2.0F, 0.0F, 0.25F, 1.0F, 3.0F}) put(number);
  for (const int number : {3, 0, 1, 2}) put(number);
  if (colors) put(0);
  for (const int number : {4, 2, 1, 3, 0}) put(number);
  if (colors) put(4);
  if (colors)
    for (const float number : {1.0F, 0.5F, 0.0F, 1.0F}) put(number);
  return bytes;
}

std::vector<Sample> samples() {
  const std::string faces = "3 0 1 2\n3 2 1 3\n";
  return {
      {"ascii.ply", sample_ply(0), 4, 2, true},
      {"little.ply", sample_ply(1), 4, 2, true},
      {"big.ply", sample_ply(2), 4, 2, true},
      {"plain.off", "OFF\n4 2 0\n" + vertex_lines("", "") + faces, 4, 2, true},
      {"colours.off", "COFF\n4 2 0\n" + vertex_lines("", " 255 0 0 255") + faces, 4, 2, true},
      {"all.off", "STCNOFF\n4 2 0\n" + vertex_lines("", " 0 0 1 9 99 255 .5 nan") + "3 0 1 2 1 2 3 4\n3 2 1 3\n", 4, 2,
       true},
      {"fractions.off", "CNOFF\n4 2 0\n" + vertex_lines("", " 0 0 1 0.5 1 .25") + "3 0 1 2 .1 2 3\n3 2 1 3\n", 4, 2,
       true},
      {"big.off", sample_off(true, true), 4, 2, true},
      {"little.off", sample_off(false, false), 4, 2, true},
      {"all.obj", "# a sample\nmtllib a.mtl\n" + vertex_lines("v ", "") + "vn 0 0 1\nf 1//1 2//1 3//1\nf -2 -3 -1\n", 4,
       2, false},
      {"more.obj",
       vertex_lines("v ", " .5 1 nan") +
           "vt 0 1\nvt .5 .5 1\nvn 0 0 1\no one\ng a b\nusemtl m\ns 1\nf 1/1/1 2/2/1 3/1/-1\n" +
           "usemtl n\ns off\no two\ng\nf -2/2 -3/-2 -1//1\n",
       4, 2, false},
      {"text.stl", ascii_stl(), 6, 2, true},
      {"binary.stl", binary_stl("binary", 0x8001), 6, 2, true},
      {"all.glb", gltf_sample().glb(), 12, 6, true},
      {"all.gltf", gltf_sample().gltf(), 12, 6, true},
      {"solid.stl", binary_stl("solid as some exporters write it", 0), 6, 2, true},
  };
}

}  // namespace ramcdb::test
