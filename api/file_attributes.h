#pragma once

#include <cstdint>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// Which vertex, corner and face of a file the vertices, corners (3 * face + 0..2) and faces of a mesh are; ~0 for
/// those that the file does not have.
struct FilePlaces {
  std::vector<std::uint32_t> vertices, corners, faces;
};

/// Gives the attributes of a mesh the values that a file has for them. An attribute of the file is the mesh's if it has
/// the same name or, failing that, if it is the only one of its meaning; values per vertex do for corners. Numbers of
/// colours are converted between bytes and 0..1. Returns how many attributes the file has nothing for.
std::uint64_t take_values(const mesh_file::MeshData& file, const FilePlaces& places, RegionMesh& mesh);

/// The attributes of a file that none of a mesh's would take values from.
[[nodiscard]] std::vector<const Attribute*> attributes_without_place(const mesh_file::MeshData& file,
                                                                     const RegionMesh& mesh);

}  // namespace ramcdb::detail
