#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// A mesh with fewer faces, in the numbering of the mesh that it was made from.
struct DecimatedFaces {
  std::vector<Triangle> faces;
  /// Per face the face that it was: `faces[i][k]` took the place of that one's corner k, so where both name the same
  /// vertex the corner is the old one. A face all of whose corners are old is that very face. Ascending.
  std::vector<std::uint32_t> source_face;
  std::vector<std::uint32_t> kept;  ///< vertices that are still there, ascending; those without a face too
};

/// While it lives, OpenMesh does not write to the standard error which faces it does not take. All threads share this.
class QuietOpenMesh {
 public:
  QuietOpenMesh();
  ~QuietOpenMesh();
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

 private:
  bool was_enabled_;
};

/// Takes faces away where that changes the surface least, until `target_faces` are left or no more can go: OpenMesh's
/// decimater, edges collapsed to one of their ends by quadric error, no face turned by more than 90 degrees. What stays
/// keeps its place. A pure function: equal input gives equal output for one build.
///
/// Vertices that are `locked` or on an edge without exactly two faces stay, with all edges between such vertices, and
/// no new edge joins two of them: charts that are decimated apart fit together without an edge of more than two faces.
/// Degenerate faces and others that OpenMesh does not take stay as they are, with their vertices.
/// \param faces name vertices below positions.size()
/// \param locked per vertex
[[nodiscard]] DecimatedFaces decimate_faces(std::span<const Point> positions, std::span<const Triangle> faces,
                                            const std::vector<bool>& locked, std::size_t target_faces);

}  // namespace ramcdb::detail
