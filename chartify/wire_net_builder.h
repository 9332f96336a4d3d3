#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/chartify.h"
#include "chartify/fixed_wires.h"
#include "ramcdb/chart.h"

namespace ramcdb::chartify {

/// A wire as the path of mesh vertices from its begin corner to its end corner, both included. Indices of charts,
/// wires and corners are positions in WireNet, counted from 0.
struct NetWire {
  std::vector<std::uint32_t> vertices;
  std::uint32_t begin_corner = 0, end_corner = 0;
  std::vector<std::uint32_t> charts;  ///< ascending, a chart once per pass
};

struct NetLoopStep {
  std::uint32_t wire = 0;
  bool reversed = false;
};

struct NetChart {
  std::vector<std::vector<NetLoopStep>> loops;
  Chart chart;
  std::vector<std::uint32_t> mesh_vertex;  ///< local vertex of `chart` -> mesh vertex; border vertices may repeat one
  std::vector<std::uint32_t> mesh_face;    ///< face of `chart` -> mesh face, whose corners come in the same order
};

/// The wire-net of a chartified mesh (paper, section 3): every chart with its loops, every wire once, every corner.
///
/// An edge is cut, and lies on a wire, unless exactly two faces of the same chart pass it in opposite directions.
/// Where the faces around a vertex form several fans, closed ones are slit open along an edge, and a loop of two
/// vertices is lengthened by one edge, so that all local copies of a vertex are known through wires. A corner ends
/// wires: any vertex where other than two cut edges meet, or where a loop does not go on from one to the other. A
/// closed wire without a corner gets one at its smallest position.
///
/// The edges of fixed wires are all cut, and the ends of these wires are corners. A wire that lies on one is the whole
/// of it or a part between new corners, runs in its direction and says so in `origin`; no other edges are on it.
struct WireNet {
  std::vector<std::uint32_t> corners;  ///< mesh vertex of each corner
  std::vector<NetWire> wires;          ///< in the order in which charts' loops first pass them, and so directed
                                       ///< unless fixed
  std::vector<NetChart> charts;
  std::vector<WireOrigin> origin;  ///< per wire
};

/// \param fixed wires that charts outside the mesh pass too. REQUIRES: all their edges are edges of the mesh, and no
///        other edge of the mesh is one of charts outside
/// \param corners vertices that stay corners whatever the mesh says, as others outside it end wires there or touch it
///        in just this vertex; those without a face are left alone
/// Errors: invalid_argument where a fixed wire runs along no edge of the mesh, or two along the same.
[[nodiscard]] WireNet build_wire_net(const IndexedMesh& mesh, const Charts& charts,
                                     std::span<const FixedWire> fixed = {},
                                     std::span<const std::uint32_t> corners = {});
/// Of a whole mesh, whose adjacency it uses up. \param threads change the time, never the result
[[nodiscard]] WireNet build_wire_net(const IndexedMesh& mesh, Adjacency adjacency, const Charts& charts,
                                     unsigned threads);

}  // namespace ramcdb::chartify
