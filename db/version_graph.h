#pragma once

#include <functional>
#include <vector>

#include "ramcdb/ids.h"

/// Questions about who descends from whom. A version's number is larger than those of its parents, so that going
/// through versions by descending number meets every one before its ancestors.
namespace ramcdb::db {

/// The parents of a version, all older than it; none for a version that is not there (pruned).
using ParentsOf = std::function<std::vector<VersionId>(VersionId)>;

/// The best common ancestor: one from which no other common ancestor descends; of several such (criss-cross merges)
/// the newest. A version is its own ancestor. 0 when there is none.
[[nodiscard]] VersionId merge_base(const ParentsOf& parents, VersionId a, VersionId b);

/// Whether `old` is `version` or an ancestor of it. Version 0 is everybody's.
[[nodiscard]] bool is_ancestor(const ParentsOf& parents, VersionId old, VersionId version);

/// What `from` descends from (itself included) and none of `others` does, ascending.
[[nodiscard]] std::vector<VersionId> only_in(const ParentsOf& parents, VersionId from,
                                             const std::vector<VersionId>& others);

}  // namespace ramcdb::db
