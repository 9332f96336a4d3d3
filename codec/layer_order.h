#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// An order of a chart's vertices, faces and corners that its layers are coded in. It follows from connectivity alone:
/// moving vertices leaves it as it is, so that layers need no new coding with the geometry. Where connectivity gives
/// nothing to begin at (components without border, vertices without faces, charts that are no manifold surface) it
/// follows the chart's own numbering.
///
/// Faces are visited breadth first from the border: each through a half-edge that a visited face or a loop lies behind.
class LayerOrder {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// `chart`'s faces must name vertices that it has.
  explicit LayerOrder(const Chart& chart);

  /// Vertices, each behind those that it may be predicted from.
  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Per visited face the corner (3 * face + 0..2) it was entered at: the edge from there to the next corner is the one
  /// that was crossed.
  [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }
  /// The corner whose edge is the other side of the edge from `corner` to the next one; kNone on borders. Where more
  /// faces meet at an edge, they are paired.
  [[nodiscard]] std::uint32_t twin(std::uint32_t corner) const { return twins_[corner]; }
  /// When a face is visited, counted from 0.
  [[nodiscard]] std::uint32_t visit_of(std::uint32_t face) const { return visits_[face]; }

  [[nodiscard]] static std::uint32_t next(std::uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; }
  [[nodiscard]] static std::uint32_t prev(std::uint32_t c) { return c % 3 == 0 ? c + 2 : c - 1; }

 private:
  void visit(const Chart& chart, std::uint32_t entry);
  void reach(std::uint32_t vertex);

  std::vector<std::uint32_t> vertices_, entries_, twins_, visits_;
  std::vector<bool> reached_;
};

}  // namespace ramcdb::codec
