#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/partition.h"

namespace ramcdb::chartify {

/// Puts the faces of no chart, whole components of them, into charts of up to `target` faces along the Hilbert curve.
void pack_small_components(const Regions& components, std::uint32_t target, Partition& partition);

/// Gives each isolated vertex to the chart of the face before it on the Hilbert curve, and makes charts of their own
/// where very many would come to one. Returns a chart for each, in the order of the mesh's isolated vertices.
/// \param wished per isolated vertex the chart to go to while it has room, or kNone; empty: no wishes
/// REQUIRES: canonical order, every face in a chart.
[[nodiscard]] std::vector<std::uint32_t> place_isolated_vertices(const IndexedMesh& mesh, std::uint32_t target,
                                                                 Partition& partition,
                                                                 std::span<const std::uint32_t> wished = {});
/// Ascending.
[[nodiscard]] std::vector<std::uint32_t> isolated_vertices(const IndexedMesh& mesh);

}  // namespace ramcdb::chartify
