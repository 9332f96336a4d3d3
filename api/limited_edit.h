#pragma once

#include <set>
#include <vector>

#include "api/edited_region.h"
#include "api/snapshot_impl.h"
#include "ramcdb/region.h"

namespace ramcdb::detail {

/// Where in a mesh an edit may change anything.
struct EditLimits {
  std::vector<RegionShape> shapes;  ///< boxes, balls and frusta: what meets them
  std::set<ChartId> charts;         ///< whole charts, their borders with them
};

/// A region as limits of an edit that makes `to` of `from`: its boxes, balls and frusta as they are, through charts;
/// with `grow`, and where it names charts, whole charts, as `from` has them. Throws not_found as Snapshot::find, but
/// for charts that only `to` has.
[[nodiscard]] EditLimits limits_of(const Region& region, const Snapshot::Impl& from, const Snapshot::Impl& to);

/// What an edit does within limits. A vertex that stays is inside where its place, before or after, is; values of faces
/// and corners where the face's bounding box meets the limits. Faces that come and go are done or left by islands:
/// faces that share vertices, or are of one polygon, and all their vertices go together, as soon as one of them is
/// inside. \param mesh what `edited` was made from (mesh_as_edit): it has the same faces, with their charts
[[nodiscard]] EditedRegion limited(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                                   const RegionMesh& mesh, const EditLimits& limits);

}  // namespace ramcdb::detail
