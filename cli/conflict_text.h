#pragma once

#include <string>
#include <vector>

#include "ramcdb/figures.h"

namespace ramcdb::cli {

/// Where and why a merge failed, a line each, the first ones.
[[nodiscard]] std::string conflict_text(const std::vector<MergeConflict>& conflicts);

}  // namespace ramcdb::cli
