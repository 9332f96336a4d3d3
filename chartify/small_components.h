#pragma once

#include <vector>

#include "chartify/recut.h"

namespace ramcdb::chartify {

/// Gives the small components that wait to the nearest chart with room, on the Hilbert curve before or behind them, up
/// to the target; the others fill charts of their own. Then writes all small components' faces into the partition.
void place_small_components(Recut& cut, std::vector<SmallComponent>& small);

}  // namespace ramcdb::chartify
