#include "chartify/fixed_wires.h"

#include <string>

#include "ramcdb/error.h"

namespace ramcdb::chartify {

FixedEdges::FixedEdges(const IndexedMesh& mesh, const EdgeGroups& edges, std::span<const FixedWire> wires) {
  if (wires.empty()) return;
  origin_.resize(edges.edge_count());
  for (std::uint32_t w = 0; w < wires.size(); ++w)
    for (std::uint32_t i = 0; i + 1 < wires[w].vertices.size(); ++i) {
      const std::uint32_t edge = find_edge(mesh, edges, wires[w].vertices[i], wires[w].vertices[i + 1]);
      if (edge == kNone || origin_[edge].fixed != kNone)
        throw Error(Errc::invalid_argument, edge == kNone ? "an edge that no face passes" : "an edge that another has",
                    "fixed wire " + std::to_string(w) + ", vertex " + std::to_string(i));
      origin_[edge] = {w, i};
    }
}

}  // namespace ramcdb::chartify
