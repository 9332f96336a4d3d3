#pragma once

#include "chartify/face_mover.h"

namespace ramcdb::chartify {

/// Lets charts above the cap hand faces of their borders to smaller neighbours.
void rebalance(FaceMover& mover, const SizeLimits& limits, std::uint32_t chart_count);

}  // namespace ramcdb::chartify
