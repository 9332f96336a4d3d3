#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
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

/// The name of an attempt: the same edit of the same checkout has one name, however often it is sent.
[[nodiscard]] std::string attempt_name(std::string_view nonce, std::string_view branch, const PendingEdit& edit);

/// Codes the edit on the branch's tip and publishes it (the commit protocol: db/FORMAT.md), again where the tip moves
/// meanwhile. Nothing changed: nothing is written. Conflicts come back in the report, with nothing written.
/// \param attempt from attempt_name(): a repeated commit is one commit.
/// \param second_parent a version that the edit brings over; 0 for none
[[nodiscard]] CommitReport commit_edit(const PendingEdit& edit, const CommitOptions& options,
                                       const std::string& attempt, VersionId second_parent = {});

/// A version of one mesh that is made from the tip of a branch: coded without the writer's lock, and with it where the
/// tip moved twice meanwhile, so that it comes to an end.
/// \param base a version that holds the mesh
/// \param operation what the version's figures call it
/// \param encode makes the edit from a tip; none when there is nothing to publish
/// \param report gets the version; counts of the edit for the version's figures are there before
void publish_on_tip(const Snapshot::Impl& base, const CommitOptions& options, std::string_view operation,
                    const std::string& attempt,
                    const std::function<std::optional<EncodedEdit>(const Snapshot::Impl& tip)>& encode,
                    CommitReport& report);

}  // namespace ramcdb::detail
