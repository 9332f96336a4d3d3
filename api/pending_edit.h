#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/edit_encoder.h"
#include "api/region_mesh.h"
#include "ramcdb/figures.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// An edit as it waits to be committed.
struct PendingEdit {
  std::vector<RegionPart> parts;  ///< what `region` was loaded from
  RegionMesh region;              ///< with attributes
  EditedRegion edited;
  ChangeSet changes;
  FileNotes notes;
  std::string operation = "commit";  ///< what the version's figures call it
  /// Whether charts outside the region may be cut anew where an edit leaves too small a one beside them.
  bool may_recut_outside = false;

  /// The newest version of its parts.
  [[nodiscard]] const Snapshot::Impl& base() const;
};

/// What an edit means, before anything is coded.
[[nodiscard]] ChangeReport describe_edit(const PendingEdit& edit);

/// Fills in tip, changed_by_others and conflicts of a report, against the tip of `branch`.
void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch);

/// The charts of a region that `version` holds in another state than the region does, and that `version` did not write
/// itself: what others changed before it.
[[nodiscard]] std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version);

/// The charts of a region that an index holds in a state other than the region's, ascending.
[[nodiscard]] std::vector<ChartId> charts_other_than(std::span<const RegionPart> parts, const PageIndex& there);
/// Those that it holds in the region's state.
[[nodiscard]] std::vector<ChartId> charts_as_in(std::span<const RegionPart> parts, const PageIndex& there);

/// The index of the mesh that `base` is of, at another version. Throws conflict where it is not there.
[[nodiscard]] PageIndex index_at(const Snapshot::Impl& base, VersionId version);

[[nodiscard]] std::vector<ChartId> common(const std::vector<ChartId>& charts, const std::set<ChartId>& others);

}  // namespace ramcdb::detail
