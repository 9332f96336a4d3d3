#pragma once

#include "api/snapshot_impl.h"
#include "ramcdb/figures.h"

namespace ramcdb::detail {

/// Walks the two versions' pages side by side, skips equal ones, and compares what is left chart by chart.
[[nodiscard]] DiffReport diff_versions(const Snapshot::Impl& from, const Snapshot::Impl& to, unsigned threads);

}  // namespace ramcdb::detail
