#pragma once

#include <filesystem>
#include <vector>

#include "api/edit_encoder.h"
#include "api/mesh_file/mesh_file.h"
#include "api/region_mesh.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Writes a region as a mesh file: coordinates as 32-bit floats where these give back every lattice point, else as
/// doubles. Returns the local origin that the file's coordinates are relative to: zero unless the format holds nothing
/// but floats and those would not do, and `may_shift`; without it, that is refused.
[[nodiscard]] Point write_region(const Snapshot& snapshot, const RegionMesh& region, const std::filesystem::path& file,
                                 const FileOptions& options, bool with_ids, bool may_shift);

/// The vertices that a file moved. The file holds the same faces as the region, in any order, with any vertex
/// numbering, as a soup or with split vertices. Throws invalid_argument, with places, when its connectivity differs.
/// \param trust_ids vertex ids in the file refer to this very region.
[[nodiscard]] std::vector<VertexMove> moves_in_file(const RegionMesh& region, const Lattice& lattice,
                                                    mesh_file::MeshData& file, const Point& local_origin,
                                                    bool trust_ids);

}  // namespace ramcdb::detail
