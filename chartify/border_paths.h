#pragma once

#include <cstdint>
#include <vector>

#include "chartify/half_edge_twins.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {

/// A mesh's vertices as far as its faces lie around them in one closed fan.
class ClosedFans {
 public:
  ClosedFans(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins);

  /// A half-edge that leaves the vertex; kNoTwin where its faces form another thing than one closed fan.
  [[nodiscard]] HalfEdge leaving(std::uint32_t vertex) const { return leaving_[vertex]; }

 private:
  std::vector<HalfEdge> leaving_;
};

/// The half-edges of a border between two charts, from corner to corner, those of the chart on its left.
using BorderPath = std::vector<HalfEdge>;

/// All borders between two different charts that run from one corner to another, in the order of their smallest
/// half-edges. Closed ones are left out.
[[nodiscard]] std::vector<BorderPath> trace_borders(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins,
                                                    const ClosedFans& fans,
                                                    const std::vector<std::uint32_t>& chart_of_face);

}  // namespace ramcdb::chartify
