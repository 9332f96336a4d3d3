#pragma once

#include <span>

#include "api/commit.h"

namespace ramcdb::detail {

/// What lies between two versions of a mesh as an edit of the first one: of the charts that it has and the second one
/// has in another state or not at all, and of those around them: where whole charts come or go, these know the vertices
/// along which they do. Holds all these charts in memory. The snapshots must outlive the edit.
/// Throws invalid_argument when they do not hold the same mesh.
/// \param within what of it; all when not said (limited_edit.h)
[[nodiscard]] PendingEdit edit_between(const Snapshot::Impl& from, const Snapshot::Impl& to, unsigned threads,
                                       const std::optional<Region>& within = {});

/// A mesh as an edit of a region, with its vertices and faces in the mesh's own order; corners of faces that stay are
/// turned as the region has them.
/// \param equal charts that both hold in the same state
[[nodiscard]] EditedRegion mesh_as_edit(const Snapshot::Impl& at, const RegionMesh& region, const RegionMesh& mesh,
                                        std::span<const ChartId> equal);

/// Merges a branch or version into `options.branch` as one version, all meshes of it: what only one side changed is
/// taken by its root pages, no blob is copied; where both changed a mesh, charts that both changed are merged three
/// ways.
[[nodiscard]] MergeReport merge_version(const std::shared_ptr<db::Store>& store, VersionId theirs,
                                        const CommitOptions& options);

/// Takes back what a version did to a mesh, or to all that it changed, on top of what came later.
/// \param within what of it; all when not said (limited_edit.h)
[[nodiscard]] CommitReport revert_version(const std::shared_ptr<db::Store>& store, VersionId version,
                                          std::string_view mesh, const std::optional<Region>& within,
                                          const CommitOptions& options);

}  // namespace ramcdb::detail
