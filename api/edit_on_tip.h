#pragma once

#include <optional>

#include "api/pending_edit.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Codes an edit on a tip that holds its charts as the edit's region does.
[[nodiscard]] EncodedEdit encode_on(const Snapshot::Impl& tip, const PendingEdit& edit, const CommitOptions& options);

/// Codes an edit on any tip, merged where others changed the same charts. None, with the conflicts in the report, where
/// that cannot be or was not asked for.
[[nodiscard]] std::optional<EncodedEdit> encode_or_merge(const Snapshot::Impl& tip, const PendingEdit& edit,
                                                         const CommitOptions& options, CommitReport& report);

}  // namespace ramcdb::detail
