#pragma once

#include <cstdint>
#include <span>

#include "chartify/partition.h"

namespace ramcdb::chartify {

/// Gives the faces of every polygon to the chart that has most of them, the first of equal ones.
/// REQUIRES: every face in a chart.
void keep_polygons_whole(std::span<const std::uint32_t> polygon_of_face, Partition& partition);

}  // namespace ramcdb::chartify
