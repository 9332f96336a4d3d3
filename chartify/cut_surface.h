#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/fixed_wires.h"
#include "chartify/half_edge_twins.h"

namespace ramcdb::chartify {

/// A mesh cut open along the borders of its charts: faces of one chart are glued over edges that are not cut, and the
/// corners of glued faces around a vertex form fans. A fan is what a chart takes for a vertex; cut edges run between
/// open fans, and the half-edges on them form border loops with their chart on the left.
class CutSurface {
 public:
  /// Cuts every edge that two faces of one chart do not pass in opposite directions, and then as many more as it takes
  /// until vertices of several fans have open ones only, no loop has two vertices, and no two edges the same ends.
  /// \param fixed are cut as well
  /// \param corners vertices that have another fan outside the mesh
  CutSurface(const IndexedMesh& mesh, Adjacency adjacency, const std::vector<std::uint32_t>& chart_of_face,
             std::span<const FixedWire> fixed, std::span<const std::uint32_t> corners);

  /// All border half-edges, ascending.
  [[nodiscard]] const std::vector<HalfEdge>& borders() const { return borders_; }
  [[nodiscard]] bool is_border(HalfEdge h) const { return mate_[h] == kNoTwin; }
  /// The border half-edge that follows another on its loop.
  [[nodiscard]] HalfEdge next_on_border(HalfEdge h) const;
  /// The fan that the corner at the start of a half-edge belongs to.
  [[nodiscard]] std::uint32_t fan_of(HalfEdge h) const { return fan_of_[h]; }
  [[nodiscard]] std::size_t fan_count() const { return fans_.size(); }
  [[nodiscard]] bool is_closed(std::uint32_t fan) const { return fans_[fan].closed; }
  [[nodiscard]] std::uint32_t edge_of(HalfEdge h) const { return edges_.edge_of[h]; }
  [[nodiscard]] WireOrigin origin_of(std::uint32_t edge) const { return fixed_.origin_of(edge); }
  [[nodiscard]] std::size_t edge_count() const { return edges_.edge_count(); }
  [[nodiscard]] std::uint32_t start_of(HalfEdge h) const { return mesh_.faces[face_of(h)][h % 3]; }
  [[nodiscard]] std::uint32_t end_of(HalfEdge h) const { return start_of(next_in_face(h)); }

 private:
  struct Fan {
    HalfEdge first;  ///< the one farthest clockwise, or any of a closed fan
    bool closed;
  };

  void find_fans();
  /// All return how many edges they cut.
  std::size_t open_fans_of_split_vertices();
  std::size_t lengthen_short_loops();
  /// Where polygons stand several times: their diagonals between the same two fans.
  std::size_t part_doubled_edges();
  void cut(HalfEdge h);

  const IndexedMesh& mesh_;
  std::span<const std::uint32_t> corners_;
  EdgeGroups edges_;
  FixedEdges fixed_;
  std::vector<HalfEdge> mate_;     ///< the half-edge glued to this one
  std::vector<HalfEdge> borders_;  ///< those without; what find_fans has not seen yet stands behind the others
  std::vector<std::uint32_t> fan_of_;
  std::vector<Fan> fans_;
};

}  // namespace ramcdb::chartify
