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
  const auto has_values = [&](const Attribute& attribute) {
    const std::size_t count = attribute.info.of == AttributeOf::vertex   ? mesh.positions.size()
                              : attribute.info.of == AttributeOf::corner ? mesh.corners.size()
                                                                         : mesh.face_count();
    return attribute.values.size() == count * attribute.info.components;
  };
  const std::size_t corners = mesh.face_sizes.empty()
                                  ? mesh.face_count() * 3
                                  : std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), std::size_t{0});
  return !mesh.positions.empty() && corners == mesh.corners.size() &&
         std::all_of(mesh.positions.begin(), mesh.positions.end(), finite) &&
         std::all_of(mesh.corners.begin(), mesh.corners.end(), exists) &&
         (mesh.vertex_ids.empty() || mesh.vertex_ids.size() == mesh.positions.size()) &&
         std::all_of(mesh.attributes.begin(), mesh.attributes.end(), has_values);
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

std::vector<std::uint32_t> corners_of(const std::vector<Triangle>& faces) {
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : faces) corners.insert(corners.end(), t.begin(), t.end());
  return corners;
}

mesh_file::MeshData cut_to_triangles(const mesh_file::MeshData& mesh) {
  mesh_file::MeshData cut;
  cut.positions = mesh.positions;
  for (const Triangle& t : mesh_file::triangulate(mesh).corners)
    for (const std::uint32_t corner : t) cut.corners.push_back(mesh.corners[corner]);
  return cut;
}

std::vector<double> value_of(const Attribute& attribute, std::size_t at) {
  const auto first = attribute.values.begin() + static_cast<std::ptrdiff_t>(at * attribute.info.components);
  return {first, first + attribute.info.components};
}

Attribute attribute_of(const mesh_file::MeshData& mesh, std::string_view name) {
  for (const Attribute& attribute : mesh.attributes)
    if (attribute.info.name == name) return attribute;
  ADD_FAILURE() << "no attribute " << name;
  return {};
}

}  // namespace ramcdb::test
