#pragma once

#include "chartify/face_mover.h"

namespace ramcdb::chartify {

/// Replaces the border between two charts by the cheapest path between its corners through the two charts, where that
/// is shorter and leaves both of fitting size. Faces change sides; corners stay where they are.
/// \param rules which faces may change sides; nullptr: all
void straighten_borders(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const SizeLimits& limits,
                        Partition& partition, const MoveRules* rules = nullptr);

}  // namespace ramcdb::chartify
