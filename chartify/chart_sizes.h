#pragma once

#include <vector>

#include "chartify/recut.h"

namespace ramcdb::chartify {

/// Brings charts between a quarter of the target and twice the target, as far as the mesh lets them. Small ones join
/// the neighbour with the longest common border among those that stay within twice the target, or among all; without a
/// neighbour they are whole components and join the small ones that wait. Charts of up to half the target join the
/// neighbour with the longest common border among those that stay within the target: many edits would else leave ever
/// smaller charts. Large ones let their small components go and are then split.
/// REQUIRES: charts connected, but for small components aboard.
void keep_sizes(Recut& cut, std::vector<SmallComponent>& small);

}  // namespace ramcdb::chartify
