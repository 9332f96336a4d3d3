#pragma once

#include <string_view>

#include "api/spooled_edit.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Moves vertices of any number of charts as one version, with a few charts in memory at a time: codes all blobs to a
/// file first, without a lock; then takes the writer's lock, compares with the branch's tip, puts the blobs, flushing
/// them in between, and publishes (db/FORMAT.md, "Commit"). Nothing moved: nothing is written. Conflicts come back in
/// the report, with nothing written.
/// \param operation what the version's figures call it
[[nodiscard]] CommitReport commit_streamed(const Snapshot::Impl& at, const StreamedMoves& moves,
                                           const CommitOptions& options, std::string_view operation);

}  // namespace ramcdb::detail
