#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "ramcdb/bytes.h"
#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

namespace ramcdb {

/// A chart as plain values. It is an oriented triangle surface, manifold in its local vertices: every edge has at most
/// two faces, two faces pass a shared edge in opposite directions, and the faces around a local vertex form one open
/// or one closed fan. Where the mesh itself is not like that, one mesh vertex is several local vertices, all of them
/// on border loops, and the wires keep their identity.
struct Chart {
  /// Vertices per border loop. A loop runs with the chart's interior on its left: its edge i -> i+1 is a directed edge
  /// of one of the faces. No loop has exactly two vertices.
  std::vector<std::uint32_t> loop_sizes;
  /// First the border vertices, loop after loop, then the inner ones. Inner vertices without a face are isolated.
  std::vector<LatticePoint> positions;
  std::vector<Triangle> faces;

  [[nodiscard]] std::uint32_t border_count() const {
    return std::accumulate(loop_sizes.begin(), loop_sizes.end(), std::uint32_t{0});
  }
  friend bool operator==(const Chart&, const Chart&) = default;
};

/// A wire as plain values: all its points from its begin corner to its end corner, both included. At least two points;
/// a closed wire has the same corner, hence the same point, at both ends.
struct Wire {
  std::vector<LatticePoint> points;

  friend bool operator==(const Wire&, const Wire&) = default;
};

/// A wire as a border loop passes it.
struct DirectedWire {
  WireId wire;
  bool reversed = false;

  friend bool operator==(const DirectedWire&, const DirectedWire&) = default;
};

/// A border loop as the wires it passes; it starts at the start of its first wire.
using WireLoop = std::vector<DirectedWire>;

}  // namespace ramcdb
