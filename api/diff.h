#pragma once

#include "api/snapshot_impl.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// See Repository::diff.
[[nodiscard]] DiffReport diff_versions(const Snapshot::Impl& from, const Snapshot::Impl& to,
                                       const DiffOptions& options);

}  // namespace ramcdb::detail
