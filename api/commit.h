#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "api/pending_edit.h"
#include "api/tip_publisher.h"
#include "ramcdb/figures.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// The name of an attempt: the same edit of the same checkout has one name, however often it is sent.
[[nodiscard]] std::string attempt_name(std::string_view nonce, std::string_view branch, const PendingEdit& edit);

/// What edits of different meshes do, before anything is coded: a report for each.
[[nodiscard]] std::vector<CommitReport> reports_of(std::span<const PendingEdit> edits);

/// The reports of the meshes of one version as one; that of one mesh as it is.
[[nodiscard]] CommitReport added_up(const std::vector<CommitReport>& reports);

/// Codes edits of different meshes on a version, merged where `options` say so. None where one of them meets conflicts:
/// those of all meshes are in the reports then. Edits that change nothing there are left out.
[[nodiscard]] std::optional<VersionDraft> draft_of(std::span<const PendingEdit> edits, VersionId tip,
                                                   const CommitOptions& options, std::vector<CommitReport>& reports);

/// Codes edits of different meshes, one at least, on the branch's tip and publishes them as one version (the commit
/// protocol: db/FORMAT.md), again where the tip moves meanwhile. Nothing changed: nothing is written. Conflicts come
/// back in the report, with nothing written. \param attempt from attempt_name(): a repeated commit is one commit.
[[nodiscard]] CommitReport commit_edits(std::span<const PendingEdit> edits, const CommitOptions& options,
                                        const std::string& attempt);
[[nodiscard]] CommitReport commit_edit(const PendingEdit& edit, const CommitOptions& options,
                                       const std::string& attempt);

/// After an edit was merged: publishes it unmerged, on its own base, as a version without a name (publish_nameless), so
/// that who goes on with the edit has a base to be compared with. What `merged` holds alike is shared with it, so
/// charts that nobody else changed count as unchanged there. None where that cannot be: where the edit's charts are of
/// several versions that do not fit together, or it makes new charts, whose ids others may have given to theirs.
[[nodiscard]] std::optional<VersionId> publish_unmerged(const PendingEdit& edit, VersionId merged,
                                                        const CommitOptions& options);

/// A version of one mesh that is made from the tip of a branch.
/// \param base a version that holds the mesh
/// \param operation what the version's figures call it
/// \param encode makes the edit from a tip; none when there is nothing to publish
/// \param report gets the version; counts of the edit for the version's figures are there before
void publish_on_tip(const Snapshot::Impl& base, const CommitOptions& options, std::string_view operation,
                    const std::string& attempt,
                    const std::function<std::optional<EncodedEdit>(const Snapshot::Impl& tip)>& encode,
                    CommitReport& report);

}  // namespace ramcdb::detail
