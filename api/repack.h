#pragma once

#include "api/snapshot_impl.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// tables trained anew -> all charts coded anew -> one version on the tip of the branch. What the mesh takes before and
/// after is left to the caller, who has the snapshots.
[[nodiscard]] RepackReport repack_mesh(const Snapshot::Impl& at, const RepackOptions& options);

}  // namespace ramcdb::detail
