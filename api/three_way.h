#pragma once

#include <span>
#include <vector>

#include "api/edited_region.h"
#include "api/snapshot_impl.h"
#include "ramcdb/figures.h"

namespace ramcdb::detail {

/// An edit carried over to what others made of its region meanwhile.
struct MergedEdit {
  EditedRegion edited;                   ///< of the tip's region
  std::vector<MergeConflict> conflicts;  ///< not empty: `edited` is nothing
  bool theirs_moved = false;             ///< others moved vertices of the region, or changed its faces
};

/// Merges three ways: what either side alone did is taken; what both did alike, once: moved or removed the same, added
/// the same faces at the same places. A vertex that both moved to different places, a value that both changed, faces
/// that one side changed where the other one did, and vertices that one side uses and the other one removed are
/// conflicts.
/// \param tip a version, of which `theirs` is what became of all charts of `base`; both with attributes
/// \param ours an edit of `base`
/// \param equal charts that `base` and `theirs` hold in the same state
[[nodiscard]] MergedEdit merge_edits(const Snapshot::Impl& tip, const RegionMesh& base, const EditedRegion& ours,
                                     const RegionMesh& theirs, std::span<const ChartId> equal);

}  // namespace ramcdb::detail
