#pragma once

#include <cstdint>
#include <vector>

#include "chartify/chartify.h"

namespace ramcdb::chartify {

/// Half-edge 3 * face + i runs from corner i of its face to the next corner.
using HalfEdge = std::uint32_t;
inline constexpr HalfEdge kNoTwin = ~HalfEdge{0};

inline std::uint32_t face_of(HalfEdge h) { return h / 3; }
inline HalfEdge next_in_face(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline HalfEdge previous_in_face(HalfEdge h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// The half-edges of a mesh, grouped by the edge they lie on.
struct EdgeGroups {
  std::vector<std::uint32_t> edge_of;  ///< per half-edge
  std::vector<std::uint32_t> first;    ///< per edge, and one more: where its half-edges begin in `half_edges`
  std::vector<HalfEdge> half_edges;    ///< ascending within an edge

  [[nodiscard]] std::size_t edge_count() const { return first.size() - 1; }
};

/// Edges are numbered by their vertex pairs, ascending.
[[nodiscard]] EdgeGroups group_half_edges(const IndexedMesh& mesh);

/// The edge between two vertices, found by halving; kNone where the mesh has none.
[[nodiscard]] std::uint32_t find_edge(const IndexedMesh& mesh, const EdgeGroups& edges, std::uint32_t u,
                                      std::uint32_t v);

/// For every half-edge the one that two different faces share with it in opposite directions, where just these two lie
/// on the edge, or where both belong to one polygon; kNoTwin elsewhere. Faces are adjacent over such edges and no
/// others.
[[nodiscard]] std::vector<HalfEdge> find_twins(const IndexedMesh& mesh, const EdgeGroups& edges);

/// What meets at the edges of a mesh: all who cut it or look at it ask.
struct Adjacency {
  EdgeGroups edges;
  std::vector<HalfEdge> twins;

  explicit Adjacency(const IndexedMesh& mesh) : edges(group_half_edges(mesh)), twins(find_twins(mesh, edges)) {}
};

}  // namespace ramcdb::chartify
