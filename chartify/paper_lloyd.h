#pragma once

#include "chartify/half_edge_twins.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {

/// Lloyd's method with the cost function (1)-(3) of the paper, section 4.2, lambda = alpha = 1, until no seed moves.
/// Seeds are spread along the Hilbert curve instead of drawn at random.
[[nodiscard]] Partition paper_lloyd(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions,
                                    const Progress& progress);

/// The repairs of section 4.3: charts that one neighbour surrounds join it, ring-shaped charts are cut in three, and of
/// two charts that share two borders the larger is cut in two.
void repair_topology(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                     Partition& partition);

}  // namespace ramcdb::chartify
