#pragma once

#include <cstdint>
#include <vector>

#include "codec/dense_front.h"
#include "codec/half_edges.h"

/// The walk of dense_walk.h is the same for encoder and decoder. What only the encoder knows, the chart itself, it asks
/// of a guide; the decoder's guide answers nothing, and the answers come from the stream.
namespace ramcdb::codec {

class NoGuide {
 public:
  void on_border(std::uint32_t /*node*/) {}
  std::uint32_t begin_fan(std::uint32_t /*before_pivot*/, std::uint32_t /*pivot*/) { return 0; }
  bool apex_is_known() const { return false; }
  LatticePoint apex() const { return {}; }
  std::uint32_t apex_node(const DenseFront& /*front*/) const { return kNone; }
  void apex_placed(std::uint32_t /*vertex*/) {}
  void face_opened(std::uint32_t /*current*/, std::uint32_t /*new_node*/) {}
  void fan_closed(std::uint32_t /*current*/) {}
  std::array<LatticePoint, 3> next_seed() { return {}; }
  void seed_placed(std::uint32_t /*first_vertex*/, std::uint32_t /*first_node*/) {}
  LatticePoint next_isolated(std::uint32_t /*vertex*/) { return {}; }
};

/// Leads the walk over a chart, and remembers which vertex and face of it became which.
class ChartGuide {
 public:
  ChartGuide(const Chart& chart, const HalfEdges& edges);

  /// A loop's node for border vertex `node`, of the same number.
  void on_border(std::uint32_t node) { set_edge(node, edges_.at_border(node)); }

  /// Turns to the face at the open side of a node's edge.
  void turn_to(std::uint32_t node) { at_ = edge_of_node_[node]; }
  /// Turns to the open corner between two nodes; returns the number of edges inside it.
  std::uint32_t begin_fan(std::uint32_t before_pivot, std::uint32_t pivot);
  /// About the third vertex of the face at hand.
  [[nodiscard]] bool apex_is_known() const { return local_[apex_vertex()] != kNone; }
  [[nodiscard]] LatticePoint apex() const { return chart_.positions[apex_vertex()]; }
  [[nodiscard]] std::uint32_t apex_node(const DenseFront& front) const {
    return apex_corner([&](std::uint32_t node) { return front[node].live != kNone; }).node;
  }
  /// The corner of the front that the face at hand lies in with its third vertex.
  struct Corner {
    std::uint32_t node = kNone;
    std::uint32_t faces_after = 0;  ///< of the corner, on the far side of the face
  };
  template <class IsLive>
  [[nodiscard]] Corner apex_corner(const IsLive& is_live) const;
  /// Of the chart.
  [[nodiscard]] std::uint32_t apex_vertex() const { return edges_.origin(HalfEdges::prev(at_)); }
  void apex_placed(std::uint32_t vertex) { place(apex_vertex(), vertex); }
  /// The face at hand was decoded: its edge from the apex to the pivot is that of `new_node`, the one from `current` to
  /// the apex that of `current`. Goes on to the next face of the fan.
  void face_opened(std::uint32_t current, std::uint32_t new_node);
  void fan_closed(std::uint32_t current);

  /// The closed component that begins with the least face: least by the sequence of its three positions, from whichever
  /// corner it is least, so that the choice does not depend on how the chart numbers things; ties by number.
  std::array<LatticePoint, 3> next_seed();
  void seed_placed(std::uint32_t first_vertex, std::uint32_t first_node);
  /// Vertices without faces, by position.
  LatticePoint next_isolated(std::uint32_t vertex);

  /// Vertex of the walk -> vertex of the chart.
  [[nodiscard]] const std::vector<std::uint32_t>& source_vertices() const { return source_; }
  /// Face of the walk -> the half-edge of the chart from its first to its second corner.
  [[nodiscard]] const std::vector<std::uint32_t>& source_faces() const { return face_edges_; }

 private:
  void place(std::uint32_t chart_vertex, std::uint32_t vertex);
  void set_edge(std::uint32_t node, std::uint32_t half_edge);
  void find_seeds();
  void find_isolated();

  const Chart& chart_;
  const HalfEdges& edges_;
  std::uint32_t at_ = kNone;                 ///< half-edge from current to pivot in the face at hand
  std::vector<std::uint32_t> edge_of_node_;  ///< node -> half-edge on its open side
  std::vector<std::uint32_t> node_of_edge_;
  std::vector<std::uint32_t> local_;   ///< vertex of the chart -> of the walk, kNone before it is placed
  std::vector<std::uint32_t> source_;  ///< the other way round
  std::vector<std::uint32_t> face_edges_;
  std::vector<std::uint32_t> seeds_;  ///< first half-edges of faces that may begin a closed component, last one first
  bool seeds_known_ = false;
  std::vector<std::uint32_t> isolated_;  ///< last one first
  bool isolated_known_ = false;
};

/// Its node is the one whose edge ends the apex's fan.
template <class IsLive>
ChartGuide::Corner ChartGuide::apex_corner(const IsLive& is_live) const {
  Corner corner;
  for (std::uint32_t out = HalfEdges::prev(at_);; out = HalfEdges::next(edges_.twin(out)), ++corner.faces_after) {
    corner.node = node_of_edge_[out];
    if (corner.node != kNone && is_live(corner.node) && edge_of_node_[corner.node] == out) return corner;
  }
}

}  // namespace ramcdb::codec
