#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/half_edge_twins.h"

namespace ramcdb::chartify {

/// A wire that charts outside the mesh pass as well: its edges stay, and its ends stay corners.
struct FixedWire {
  std::vector<std::uint32_t> vertices;  ///< of the mesh, from begin to end corner; a closed wire has one at both ends
};

/// The part of a fixed wire that an edge or a wire is.
struct WireOrigin {
  std::uint32_t fixed = kNone;  ///< which one; kNone: it lies on none
  std::uint32_t first = 0;      ///< the position in its vertices where the part begins

  friend bool operator==(const WireOrigin&, const WireOrigin&) = default;
};

/// Which edges of a mesh lie on fixed wires.
class FixedEdges {
 public:
  /// Errors: invalid_argument where a wire runs along no edge of the mesh, or two along the same.
  FixedEdges(const IndexedMesh& mesh, const EdgeGroups& edges, std::span<const FixedWire> wires);

  [[nodiscard]] WireOrigin origin_of(std::uint32_t edge) const {
    return origin_.empty() ? WireOrigin{} : origin_[edge];
  }
  [[nodiscard]] bool contains(std::uint32_t edge) const { return origin_of(edge).fixed != kNone; }

 private:
  std::vector<WireOrigin> origin_;  ///< per edge; empty where no wire is fixed
};

}  // namespace ramcdb::chartify
