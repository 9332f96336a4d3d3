#pragma once

#include <span>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Where the vertices of a mesh are. The spans must outlive it.
struct MeshPoints {
  const Lattice& lattice;
  std::span<const LatticePoint> points;
  std::span<const Point> exact;  ///< model units; empty unless the mesh is lossless

  /// Model units.
  [[nodiscard]] Point position(std::size_t vertex) const {
    return exact.empty() ? lattice.position(points[vertex]) : exact[vertex];
  }
};

/// How the positions of a mesh are written into a file, so that reading it gives back every one of them: the lattice
/// point, or of a lossless mesh the last bit.
struct FileCoordinates {
  mesh_file::Scalar scalar = mesh_file::Scalar::float32;
  Point origin;       ///< that they are relative to; model units
  Point file_origin;  ///< that the file itself says its float32 are relative to (glTF)

  /// A position as it is written.
  [[nodiscard]] Point in_file(const Point& position) const;
};

/// float32 where it will do (and, for a whole mesh that is not to be edited, its file's numbers were no doubles:
/// `written_as`), else float32 relative to a point near the mesh when `may_shift`, else float64; and as
/// FileOptions::local_origin says. glTF has float32 only, but says in the file where they begin. Throws
/// invalid_argument when the format has float32 only and that will not do, and when an origin is asked for that could
/// not be undone.
[[nodiscard]] FileCoordinates coordinates_for(const MeshPoints& mesh, NumberType written_as, mesh_file::Format format,
                                              const FileOptions& options, bool may_shift);

}  // namespace ramcdb::detail
