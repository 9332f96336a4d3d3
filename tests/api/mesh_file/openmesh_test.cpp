#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/files.h"
#include "tests/support/meshes.h"
#include "tests/support/openmesh_reader.h"

/// Real meshes as OpenMesh reads them, and as it reads what we write of them.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

using PlainFace = std::vector<std::array<float, 3>>;

/// The face begun at its least corner; where several are, at the one with the least face after it.
PlainFace from_least_corner(const PlainFace& face) {
  const auto least = *std::min_element(face.begin(), face.end());
  PlainFace best;
  for (std::size_t begin = 0; begin < face.size(); ++begin) {
    if (face[begin] != least) continue;
    PlainFace turned = face;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(begin), turned.end());
    if (best.empty() || turned < best) best = std::move(turned);
  }
  return best;
}

/// Faces as the positions of their corners, as float32, begun at the least corner; sorted.
template <class Position>
std::vector<PlainFace> plain_faces(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> sizes,
                                   const Position& position) {
  std::vector<PlainFace> faces;
  std::size_t at = 0;
  for (std::size_t f = 0; at < corners.size(); ++f) {
    const std::size_t size = sizes.empty() ? 3 : sizes[f];
    PlainFace face;
    for (std::size_t i = 0; i < size; ++i) face.push_back(position(corners[at + i]));
    faces.push_back(from_least_corner(face));
    at += size;
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<PlainFace> faces_of(const mesh_file::MeshData& mesh) {
  return plain_faces(mesh.corners, mesh.face_sizes, [&](std::uint32_t v) {
    const Point& p = mesh.positions[v];
    return std::array{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  });
}

/// OpenMesh's reader of OBJ takes each vertex of a face once, and no face of two.
mesh_file::MeshData without_repeats(mesh_file::MeshData mesh) {
  std::vector<std::uint32_t> corners, sizes;
  std::size_t at = 0;
  for (std::size_t f = 0, count = mesh.face_count(); f < count; ++f) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    std::vector<std::uint32_t> face;
    for (std::size_t i = 0; i < size; ++i, ++at)
      if (std::find(face.begin(), face.end(), mesh.corners[at]) == face.end()) face.push_back(mesh.corners[at]);
    if (face.size() < 3) continue;
    corners.insert(corners.end(), face.begin(), face.end());
    sizes.push_back(static_cast<std::uint32_t>(face.size()));
  }
  mesh.corners = std::move(corners);
  mesh.face_sizes = std::move(sizes);
  return mesh;
}

std::vector<PlainFace> faces_of(const OpenMeshFile& mesh) {
  return plain_faces(mesh.corners, mesh.face_sizes, [&](std::uint32_t v) { return mesh.positions[v]; });
}

/// A mesh file of a format that both readers know, but for the one that we refuse on purpose.
bool openmesh_knows(const fs::path& file) {
  if (file.filename() == "toomanyvertices.stl") return false;
  try {
    const auto format = mesh_file::format_of(file);
    return format != mesh_file::Format::glb && format != mesh_file::Format::gltf;
  } catch (const Error&) {
    return false;
  }
}

/// OpenMesh takes the colours of faces in an OFF for corners.
bool has_coloured_faces(const mesh_file::MeshData& mesh) {
  return std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                     [](const Attribute& attribute) { return attribute.info.of == AttributeOf::face; });
}

/// Somebody else's reader finds the same vertices and faces in the files, and in what we write of them.
TEST(OtherReader, OpenMeshFindsTheSameInThemAndInOurs) {
  const auto folder = meshes_folder();
  if (!folder) GTEST_SKIP() << "real meshes: set RAMCDB_MESHES";
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "it takes minutes with sanitizers; RealMeshes reads the same files";
#endif
  const TempFolder scratch;
  std::size_t same = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*folder)) {
    const fs::path& file = entry.path();
    if (!entry.is_regular_file() || !openmesh_knows(file) || entry.file_size() > largest_real_file()) continue;
    SCOPED_TRACE(file.filename());
    const mesh_file::MeshData ours = mesh_file::read_mesh(file);
    if (mesh_file::format_of(file) == mesh_file::Format::off && has_coloured_faces(ours)) {
      fmt::print("skipped: OpenMesh does not read coloured faces of {}\n", file.string());
      continue;
    }
    const auto written = scratch / ("again" + file.extension().string());
    mesh_file::write_mesh(written, mesh_file::format_of(file), output_of(ours, mesh_file::Scalar::float32));
    const auto our_faces =
        faces_of(mesh_file::format_of(file) == mesh_file::Format::obj ? without_repeats(ours) : ours);
    try {
      for (const fs::path& each : {file, written}) {
        const OpenMeshFile theirs = read_with_openmesh(each);
        const auto their_faces = faces_of(theirs);
        if (ours.soup) {  // OpenMesh joins vertices of STL and leaves out what degenerates
          EXPECT_TRUE(std::includes(our_faces.begin(), our_faces.end(), their_faces.begin(), their_faces.end()));
        } else {
          EXPECT_EQ(theirs.positions.size(), ours.positions.size());
          EXPECT_TRUE(their_faces == our_faces) << each;
        }
      }
      ++same;
    } catch (const std::runtime_error& error) {
      fmt::print("skipped: {}\n", error.what());
    }
  }
  fmt::print("{} real meshes read by OpenMesh, too\n", same);
  EXPECT_GT(same, 0U);
}

}  // namespace
}  // namespace ramcdb::test
