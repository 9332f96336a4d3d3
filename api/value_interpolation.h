#pragma once

#include <cstdint>

#include "api/edited_region.h"

namespace ramcdb::detail {

/// Gives what is new in an edited region values from the surface that the region was, where it has none (NaN): of
/// floats the mean over the closest triangle by barycentric coordinates (normals of length 1 again), of integers those
/// of its closest corner. Returns how many values were made up so.
std::uint64_t interpolate_new(const RegionMesh& region, EditedRegion& edited);

}  // namespace ramcdb::detail
