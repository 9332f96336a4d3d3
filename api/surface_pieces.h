#pragma once

#include <cstdint>

#include "api/page_index.h"
#include "ramcdb/chart.h"
#include "ramcdb/wire_net.h"

namespace ramcdb::detail {

/// How the faces of a chart hang together within it.
[[nodiscard]] ChartPieces pieces_of(const Chart& chart);

/// What only a whole mesh shows.
struct SurfaceCounts {
  std::uint64_t components = 0;      ///< sets of faces that are joined by shared vertices
  std::uint64_t boundary_loops = 0;  ///< connected sets of edges that one face passes, and that just once
};

/// Counts by the charts' pieces, wires and corners: reads all leaf pages.
[[nodiscard]] SurfaceCounts count_surfaces(const PageIndex& pages);

}  // namespace ramcdb::detail
