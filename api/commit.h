#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "api/edit_encoder.h"
#include "ramcdb/figures.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// What an edit means, before anything is coded.
[[nodiscard]] ChangeReport describe_edit(const RegionMesh& region, const Edit& edit);

/// Fills in tip, changed_by_others and conflicts of a report on moves in `parts`, against the tip of `branch`.
void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch);

/// The charts of a region that `version` holds in another state than the region does, and that `version` did not write
/// itself: what others changed before it.
[[nodiscard]] std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version);

/// The name of an attempt: the same edit of the same checkout has one name, however often it is sent.
[[nodiscard]] std::string attempt_name(std::string_view nonce, std::string_view branch, const Edit& edit);

/// Steps 1 to 6 of the commit protocol (db/FORMAT.md), with the writer's lock held throughout: puts an edit that was
/// coded on `base` on top of the branch's tip. Conflicts come back in the report, with nothing written.
/// \param operation what the version's figures call it
void publish_edit(const Snapshot::Impl& base, const EncodedEdit& edit, const CommitOptions& options,
                  std::string_view operation, const std::string& attempt, CommitReport& report);

/// Codes the edit, decides against the branch's tip and publishes. Nothing changed: nothing is written. Conflicts come
/// back in the report, with nothing written. \param attempt from attempt_name(): a repeated commit is one commit.
[[nodiscard]] CommitReport commit_edit(std::span<const RegionPart> parts, const ChangeReport& change, const Edit& edit,
                                       const CommitOptions& options, const std::string& attempt);

}  // namespace ramcdb::detail
