#pragma once

#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "api/mesh_record.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// How the positions of a region are written into a file, so that reading it gives back every one of them: the lattice
/// point, or of a lossless mesh the last bit.
struct FileCoordinates {
  mesh_file::Scalar scalar = mesh_file::Scalar::float32;
  Point origin;                  ///< that they are relative to; model units
  Point file_origin;             ///< that the file itself says its float32 are relative to (glTF)
  std::vector<Point> positions;  ///< per vertex of the region, as written
};

/// float32 where it will do (and, for a whole mesh that is not to be edited, its file's numbers were no doubles), else
/// float32 relative to a point near the region when `may_shift`, else float64; and as FileOptions::local_origin says.
/// glTF has float32 only, but says in the file where they begin. Throws invalid_argument when the format has float32
/// only and that will not do, and when an origin is asked for that could not be undone.
[[nodiscard]] FileCoordinates coordinates_for(const Snapshot& snapshot, const RegionMesh& region,
                                              mesh_file::Format format, const FileOptions& options, bool may_shift);

// The same choice for a whole mesh that is not to be edited, without having all of it at hand.

/// Whether float32 lead back to all vertices of a region.
[[nodiscard]] bool floats_hold(const Snapshot& snapshot, const RegionMesh& region);
/// \param floats whether float32 hold all vertices
[[nodiscard]] mesh_file::Scalar scalar_for(const MeshRecord& record, mesh_file::Format format, bool floats);

}  // namespace ramcdb::detail
