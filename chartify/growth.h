#pragma once

#include <cstdint>
#include <vector>

#include "chartify/partition.h"

/// Charts that grow from seed faces at the same time, and the seeds that wander to the middle of what grew: Lloyd's
/// method on the dual graph, in integers.
namespace ramcdb::chartify {

/// Cuts every region into as many charts as it says, of about equal size. What no seed of a region reaches stays kNone.
/// REQUIRES: no adjacency between faces of different regions.
/// \param iterations of moving the seeds and growing again
[[nodiscard]] Partition grow_charts(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions,
                                    int iterations, const Progress& progress, unsigned threads = 1);

/// Runs of equal length along the faces of each region, the middle of each run: with faces along a Hilbert curve, seeds
/// that are spread evenly.
[[nodiscard]] std::vector<std::uint32_t> spread_seeds(const Regions& regions);

}  // namespace ramcdb::chartify
