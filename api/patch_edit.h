#pragma once

#include <memory>
#include <span>

#include "api/edited_region.h"
#include "ramcdb/patch.h"

namespace ramcdb::detail {

/// What became of a patch's region. Throws invalid_argument, with places, where copies of one non-manifold vertex moved
/// apart, and for positions that the lattice does not have.
[[nodiscard]] EditedRegion edited_in_patch(const Patch& patch);

/// Patches of one version as one edit of the region of all their charts. Throws invalid_argument where two of them
/// moved a vertex that they share to different places or gave it different values.
[[nodiscard]] EditedRegion edited_in_patches(std::span<const std::unique_ptr<Patch>> patches, const RegionMesh& region);

}  // namespace ramcdb::detail
