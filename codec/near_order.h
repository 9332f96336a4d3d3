#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::codec {

/// The numbers `chosen` of points in an order in which neighbours are near; always the same for the same points.
[[nodiscard]] std::vector<std::uint32_t> near_order(std::span<const LatticePoint> points,
                                                    std::vector<std::uint32_t> chosen);

}  // namespace ramcdb::codec
