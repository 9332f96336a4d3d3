#pragma once

#include <span>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "api/region_faces.h"

namespace ramcdb::detail {

/// Which vertex, corner and face of a file the vertices of a region and the corners and faces of `RegionFaces` are;
/// ~0 for vertices that the file does not have.
struct FilePlaces {
  std::span<const std::uint32_t> vertices, corners, faces;
};

/// The region's attributes with the values that the file has for them. An attribute of the file is the region's if it
/// has the same name or, failing that, if it is the only one of its meaning; values per vertex do for corners. Numbers
/// of colours are converted between bytes and 0..1.
[[nodiscard]] std::vector<Attribute> attributes_in_file(const RegionMesh& region, const RegionFaces& faces,
                                                        const mesh_file::MeshData& file, const FilePlaces& places);

}  // namespace ramcdb::detail
