#include "tests/api/mesh_file/samples.h"

#include <fmt/format.h>

#include "tests/api/mesh_file/files.h"

namespace ramcdb::test {
namespace {

constexpr float kPositions[4][3] = {{0, 0, 0}, {1.5F, 0, 0.1F}, {0, -2, 0}, {0.25F, 1, 3e-7F}};
constexpr int kFaces[2][4] = {{3, 0, 1, 2}, {3, 2, 1, 3}};

std::string binary_stl(std::string_view title) {
  std::string bytes(title);
  bytes.resize(80, ' ');
  bytes += bytes_of(std::uint32_t{2});
  for (const auto& face : kFaces) {
    for (int a = 0; a < 3; ++a) bytes += bytes_of(0.0F);
    for (int c = 1; c < 4; ++c)
      for (int a = 0; a < 3; ++a) bytes += bytes_of(kPositions[face[c]][a]);
    bytes += bytes_of(std::uint16_t{0});
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
      "property uchar red\nproperty uint ramcdb_id_hi\nproperty uint ramcdb_id_lo\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty short flags\nelement camera 1\n"
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
    put(std::uint8_t{200});
    put(v);
    put(v + 7);
    end_line();
  }
  for (const auto& face : kFaces) {
    put(std::uint8_t{3});
    for (int c = 1; c < 4; ++c) put(face[c]);
    put(std::int16_t{-1});
    end_line();
  }
  put(std::uint32_t{2});
  put(0.5);
  put(-1.0);
  put(std::int8_t{-3});
  end_line();
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
      {"all.obj", "# a sample\nmtllib a.mtl\n" + vertex_lines("v ", "") + "vn 0 0 1\nf 1//1 2//1 3//1\nf -2 -3 -1\n", 4,
       2, false},
      {"text.stl", ascii_stl(), 6, 2, true},
      {"binary.stl", binary_stl("binary"), 6, 2, true},
      {"solid.stl", binary_stl("solid as some exporters write it"), 6, 2, true},
  };
}

}  // namespace ramcdb::test
