#include "tests/api/mesh_file/files.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>

#include "ramcdb/error.h"

namespace ramcdb::test {

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "ramcdb_files_XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("no scratch folder");
  folder_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::remove(file);  // many times faster than truncating on file systems that flush truncated files
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

mesh_file::MeshData read_text(std::string_view name, std::string_view bytes) {
  static const ScratchFolder scratch;
  const auto file = scratch.file(name);
  write_bytes(file, bytes);
  return mesh_file::read_mesh(file);
}

std::string refusal(std::string_view name, std::string_view bytes) {
  try {
    (void)read_text(name, bytes);
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(name), std::string::npos) << "no file name: " << text;
    EXPECT_NE(text.find("): "), std::string::npos) << "no way to go on: " << text;
    return text;
  }
  ADD_FAILURE() << name << " was read";
  return {};
}

std::uint64_t dropped(const mesh_file::MeshData& mesh, std::string_view what) {
  for (const auto& d : mesh.dropped)
    if (d.what == what) return d.count;
  return 0;
}

bool is_sound(const mesh_file::MeshData& mesh) {
  const auto finite = [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  const auto exists = [&](std::uint32_t v) { return v < mesh.positions.size(); };
  const std::size_t corners = mesh.face_sizes.empty()
                                  ? mesh.face_count() * 3
                                  : std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), std::size_t{0});
  return !mesh.positions.empty() && corners == mesh.corners.size() &&
         std::all_of(mesh.positions.begin(), mesh.positions.end(), finite) &&
         std::all_of(mesh.corners.begin(), mesh.corners.end(), exists) &&
         (mesh.vertex_ids.empty() || mesh.vertex_ids.size() == mesh.positions.size());
}

std::vector<std::uint64_t> bits(const std::vector<Point>& positions) {
  std::vector<std::uint64_t> all;
  for (const Point& p : positions)
    for (int a = 0; a < 3; ++a) all.push_back(std::bit_cast<std::uint64_t>(p[a]));
  return all;
}

std::vector<Triangle> triangles(const mesh_file::MeshData& mesh) {
  std::vector<Triangle> faces;
  for (std::size_t c = 0; c + 2 < mesh.corners.size(); c += 3)
    faces.push_back({mesh.corners[c], mesh.corners[c + 1], mesh.corners[c + 2]});
  return faces;
}

}  // namespace ramcdb::test
