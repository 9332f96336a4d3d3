#pragma once

#include <cstdint>
#include <span>

#include "chartify/chartify.h"
#include "chartify/half_edge_twins.h"

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

  Topology& operator+=(const Topology& other);
};

[[nodiscard]] Topology analyze(const chartify::IndexedMesh& mesh);
[[nodiscard]] Topology analyze(const chartify::IndexedMesh& mesh, const chartify::Adjacency& adjacency);

// Of a mesh in parts: what each part has to itself, and what is between vertices that several parts have. The sum is
// what the whole mesh is like.

/// \param shared per vertex whether other parts have it as well
[[nodiscard]] Topology analyze_own(const chartify::IndexedMesh& part, std::span<const std::uint8_t> shared);
/// \param surroundings all faces around shared vertices, of all parts
[[nodiscard]] Topology analyze_shared(const chartify::IndexedMesh& surroundings, std::span<const std::uint8_t> shared);

}  // namespace ramcdb::detail
