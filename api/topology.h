#pragma once

#include <cstdint>

#include "chartify/chartify.h"

namespace ramcdb::detail {

/// What a mesh is like, counted and reported; nothing of it is repaired. Faces are triangles, but edges and duplicates
/// are those of polygons where the mesh says which triangles are one.
struct Topology {
  std::uint64_t nonmanifold_edges = 0;     ///< edges with more than two faces
  std::uint64_t nonmanifold_vertices = 0;  ///< on no such edge, yet their faces do not form one fan
  std::uint64_t inconsistent_edges = 0;    ///< two faces pass the edge in the same direction
  std::uint64_t degenerate_faces = 0;      ///< name a vertex twice; they count in nothing above
  std::uint64_t duplicate_faces = 0;       ///< have the vertices of an earlier one
  std::uint64_t isolated_vertices = 0;     ///< in no face
};

[[nodiscard]] Topology analyze(const chartify::IndexedMesh& mesh);

}  // namespace ramcdb::detail
