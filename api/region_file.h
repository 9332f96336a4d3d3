#pragma once

#include <filesystem>
#include <vector>

#include "api/edit_encoder.h"
#include "api/mesh_file/mesh_file.h"
#include "api/region_mesh.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

struct WrittenRegion {
  Point local_origin;  ///< that the file's coordinates are relative to
  std::vector<mesh_file::Dropped> left_out;
};

/// Writes a region as a mesh file, with coordinates as `coordinates_for` chooses them.
[[nodiscard]] WrittenRegion write_region(const Snapshot& snapshot, const RegionMesh& region,
                                         const std::filesystem::path& file, const FileOptions& options, bool with_ids,
                                         bool may_shift);

/// What an edited file says about a region.
struct FileEdit {
  std::vector<VertexMove> moves;
  /// As the region's, with the file's values where it has any; empty when it has none.
  std::vector<Attribute> attributes;
};

/// Compares a file with the region that it was written from. It holds the same faces as the region (its polygons, or
/// the triangles that these are kept as), in any order, with any vertex numbering, as a soup or with split vertices.
/// Attributes are found by their names, or else by what they mean; those that the file lacks stay, and what it has in
/// addition is no edit. Throws invalid_argument, with places, when its connectivity differs.
/// \param trust_ids vertex ids in the file refer to this very region.
[[nodiscard]] FileEdit edit_in_file(const Snapshot::Impl& at, const RegionMesh& region, const mesh_file::MeshData& file,
                                    const Point& local_origin, bool trust_ids);

}  // namespace ramcdb::detail
