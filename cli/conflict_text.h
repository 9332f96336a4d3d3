#pragma once

#include <string>
#include <vector>

#include "ramcdb/figures.h"

namespace ramcdb::cli {

/// The charts of a refused edit: "charts 4,5", of several meshes "charts 4,5 of a and 7 of b".
[[nodiscard]] std::string conflicting_charts(const CommitReport& report);

/// Where and why a merge failed, a line each, the first ones.
[[nodiscard]] std::string conflict_text(const std::vector<MergeConflict>& conflicts);

}  // namespace ramcdb::cli
