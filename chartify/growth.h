#pragma once

#include <cstdint>
#include <vector>

#include "chartify/partition.h"

/// Charts that grow from seed faces at the same time, and the seeds that wander to the middle of what grew: Lloyd's
/// method on the dual graph, in integers.
namespace ramcdb::chartify {

/// Cuts the components of at least half the target into about size / target charts each. Faces of smaller components
/// stay kNone.
/// \param iterations of moving the seeds and growing again
[[nodiscard]] Partition grow_charts(const IndexedMesh& mesh, const Neighbours& neighbours, const Components& components,
                                    std::uint32_t target, int iterations, const Progress& progress);

}  // namespace ramcdb::chartify
