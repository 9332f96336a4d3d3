#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "tests/api/mesh_file/sound_mesh.h"
#include "tests/support/temp_folder.h"

/// Small files for the tests of readers and writers.
namespace ramcdb::test {

class GltfBuilder;

/// A number that is none, and a value of an attribute that is not there.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// The corners of a square, as an OBJ file has them.
inline const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

void write_bytes(const std::filesystem::path& file, std::string_view bytes);
[[nodiscard]] std::string read_bytes(const std::filesystem::path& file);

/// Reads bytes as a file of this name; the extension chooses the format.
[[nodiscard]] mesh_file::MeshData read_text(std::string_view name, std::string_view bytes);

/// Reads a built file; the test fails when the mesh is not sound.
[[nodiscard]] mesh_file::MeshData read_glb(const GltfBuilder& file);

/// The text of the ramcdb::Error that reading throws; fails the test and returns "" when none is thrown, when it does
/// not name the file, or does not say how to go on.
[[nodiscard]] std::string refusal(std::string_view name, std::string_view bytes);

/// How often `what` was dropped; 0 when it is not named.
[[nodiscard]] std::uint64_t dropped(const mesh_file::MeshData& mesh, std::string_view what);

/// The bit patterns of all coordinates, so that -0 differs from 0.
[[nodiscard]] std::vector<std::uint64_t> bits(const std::vector<Point>& positions);

/// The faces of a mesh of triangles.
[[nodiscard]] std::vector<Triangle> triangles(const mesh_file::MeshData& mesh);

/// A mesh to write, whose parts must live on.
[[nodiscard]] mesh_file::MeshOutput output_of(const std::vector<Point>& positions, const std::vector<Triangle>& faces,
                                              mesh_file::Scalar scalar);

/// An attribute of these values.
[[nodiscard]] Attribute attribute(std::string_view name, AttributeOf of, NumberType type, std::uint8_t components,
                                  Meaning meaning, std::vector<double> values);

/// The attribute of this name; fails the test and returns an empty one when there is none.
[[nodiscard]] Attribute find(const mesh_file::MeshData& mesh, std::string_view name);

/// Fails the test unless both have the same attributes in the same order, every bit of every value; one NaN is another.
void expect_same(const std::vector<Attribute>& read, const std::vector<Attribute>& expected);

/// Quads, a pentagon and triangles over a grid, `columns` cells wide.
[[nodiscard]] mesh_file::MeshData polygon_grid(std::uint32_t columns);

/// What comes back from a file of this name.
[[nodiscard]] mesh_file::MeshData write_and_read(std::string_view name, const mesh_file::MeshOutput& out, bool ascii,
                                                 std::vector<mesh_file::Dropped>* dropped = nullptr);

/// The bytes of `value`, lowest first or highest first.
template <class T>
[[nodiscard]] std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

}  // namespace ramcdb::test
