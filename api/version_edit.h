#pragma once

#include <span>

#include "api/commit.h"

namespace ramcdb::detail {

/// What lies between two versions of a mesh as an edit of the first one: of the charts that it has and the second one
/// has in another state or not at all, and of those around them: where whole charts come or go, these know the vertices
/// along which they do. Holds all these charts in memory. The snapshots must outlive the edit.
/// Throws invalid_argument when they do not hold the same mesh.
[[nodiscard]] PendingEdit edit_between(const Snapshot::Impl& from, const Snapshot::Impl& to, unsigned threads);

/// A mesh as an edit of a region, with its vertices and faces in the mesh's own order; corners of faces that stay are
/// turned as the region has them.
/// \param equal charts that both hold in the same state
[[nodiscard]] EditedRegion mesh_as_edit(const Snapshot::Impl& at, const RegionMesh& region, const RegionMesh& mesh,
                                        std::span<const ChartId> equal);

/// Commits onto a branch what `theirs` changed since `base`, merging three ways where the branch changed the same
/// charts. Conflicts come back in the report, with nothing written.
/// \param operation what the version's figures call it
/// \param second_parent the version that is merged; 0 for none
[[nodiscard]] CommitReport carry_over(const Snapshot::Impl& base, const Snapshot::Impl& theirs,
                                      const CommitOptions& options, std::string_view operation,
                                      VersionId second_parent);

/// Merges a branch or version into `options.branch`, all meshes of it: what only one side changed is taken by its root
/// pages, no blob is copied; where both changed a mesh, charts that both changed are merged three ways.
[[nodiscard]] MergeReport merge_version(const std::shared_ptr<db::Store>& store, VersionId theirs,
                                        const CommitOptions& options);

/// Takes back what a version did to a mesh, on top of what came later.
[[nodiscard]] CommitReport revert_version(const std::shared_ptr<db::Store>& store, VersionId version,
                                          std::string_view mesh, const CommitOptions& options);

}  // namespace ramcdb::detail
