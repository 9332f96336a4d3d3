#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace ramcdb::test {

/// What OpenMesh's readers find in a file, before it becomes a mesh of half-edges: somebody else's opinion.
struct OpenMeshFile {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::uint32_t> corners;     ///< vertices of all faces, one face after the other
  std::vector<std::uint32_t> face_sizes;  ///< per face
};

/// Reads PLY, OBJ, OFF or STL. Throws std::runtime_error when OpenMesh does not.
[[nodiscard]] OpenMeshFile read_with_openmesh(const std::filesystem::path& file);

}  // namespace ramcdb::test
