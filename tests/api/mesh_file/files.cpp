#include "tests/api/mesh_file/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/gltf_builder.h"

namespace ramcdb::test {

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
  // A block of just their size, so that an address sanitizer sees one byte too far.
  const auto exact = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  return mesh_file::read_mesh_bytes({exact.get(), bytes.size()}, mesh_file::format_of(name), name);
}

mesh_file::MeshData read_glb(const GltfBuilder& file) {
  auto mesh = read_text("a.glb", file.glb());
  EXPECT_TRUE(is_sound(mesh));
  return mesh;
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

mesh_file::MeshOutput output_of(const std::vector<Point>& positions, const std::vector<Triangle>& faces,
                                mesh_file::Scalar scalar) {
  mesh_file::MeshOutput out;
  out.positions = positions;
  if (!faces.empty()) out.corners = {faces.front().data(), 3 * faces.size()};
  out.scalar = scalar;
  return out;
}

Attribute attribute(std::string_view name, AttributeOf of, NumberType type, std::uint8_t components, Meaning meaning,
                    std::vector<double> values) {
  Attribute made;
  made.info.name = name;
  made.info.of = of;
  made.info.type = type;
  made.info.components = components;
  made.info.meaning = meaning;
  made.values = std::move(values);
  return made;
}

Attribute find(const mesh_file::MeshData& mesh, std::string_view name) {
  for (const Attribute& attribute : mesh.attributes)
    if (attribute.info.name == name) return attribute;
  ADD_FAILURE() << "no attribute " << name;
  return {};
}

void expect_same(const std::vector<Attribute>& read, const std::vector<Attribute>& expected) {
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_TRUE(read[i].info == expected[i].info) << read[i].info.name << " is not as " << expected[i].info.name;
    ASSERT_EQ(read[i].values.size(), expected[i].values.size()) << read[i].info.name;
    for (std::size_t k = 0; k < read[i].values.size(); ++k) {
      const double a = read[i].values[k], b = expected[i].values[k];
      ASSERT_TRUE(std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
                  (std::isnan(a) && std::isnan(b)))
          << read[i].info.name << " number " << k << ": " << a << " is not " << b;
    }
  }
}

mesh_file::MeshData polygon_grid(std::uint32_t columns) {
  mesh_file::MeshData mesh;
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x)
      mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), 0.25 * (x % 3)});
  const std::uint32_t up = columns + 1;
  for (std::uint32_t x = 0; x < columns; ++x) {
    mesh.corners.insert(mesh.corners.end(), {x, x + 1, x + 1 + up, x + up});
    mesh.corners.insert(mesh.corners.end(), {x + up, x + 1 + up, x + 1 + 2 * up, x + up, x + 1 + 2 * up, x + 2 * up});
    mesh.face_sizes.insert(mesh.face_sizes.end(), {4, 3, 3});
  }
  mesh.corners.insert(mesh.corners.end(), {0, 1, 2, 2 + up, up});
  mesh.face_sizes.push_back(5);
  return mesh;
}

mesh_file::MeshData write_and_read(std::string_view name, const mesh_file::MeshOutput& out, bool ascii,
                                   std::vector<mesh_file::Dropped>* dropped) {
  const TempFolder scratch;
  const auto file = scratch / std::string(name);
  const auto left_out = mesh_file::write_mesh(file, mesh_file::format_of(file), out, ascii);
  if (dropped)
    *dropped = left_out;
  else
    EXPECT_TRUE(left_out.empty()) << left_out.front().what;
  return mesh_file::read_mesh(file);
}

}  // namespace ramcdb::test
