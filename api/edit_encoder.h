#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "api/chart_loader.h"
#include "api/region_mesh.h"

namespace ramcdb::detail {

/// Where a vertex goes.
struct VertexMove {
  VertexKey key;
  LatticePoint from, to;
};

/// A chart that was coded anew, and what it was decided on.
struct RecodedChart {
  PageChart base;  ///< as it stood: the tip must still have this very version
  PageChart entry;
  Buffer blob;
  codec::ChartCost cost_before, cost;
  bool expanded_range = false;
};

struct RecodedWire {
  PageWire base;
  Buffer blob;                     ///< empty without inner points
  std::uint64_t bytes_before = 0;  ///< checksum included
};

/// An edit, coded and ready to be placed on any version that still holds what it was decided on.
struct EncodedEdit {
  std::map<ChartId, RecodedChart> charts;
  std::map<WireId, RecodedWire> wires;
  std::map<CornerId, LatticePoint> corners;
};

/// Codes the charts and wires that moved vertices touch. A moved inner vertex touches its chart; a point of a wire, the
/// wire and every chart on it; a corner, all wires that end there and all charts around it, also those outside the
/// region, whose other vertices stay. No connectivity changes, so wires, corners and loops keep their ids.
/// \param parts the region that the keys belong to; keys of one part's charts refer to its version.
[[nodiscard]] EncodedEdit encode_moves(std::span<const RegionPart> parts, std::span<const VertexMove> moves,
                                       unsigned threads);

}  // namespace ramcdb::detail
