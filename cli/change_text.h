#pragma once

#include <string>
#include <vector>

#include "ramcdb/figures.h"

/// What status, diff and commit say alike about a change.
namespace ramcdb::cli {

/// What the edited file would change, and what others did meanwhile; several lines.
[[nodiscard]] std::string change_text(const ChangeReport& report, const std::string& file);

/// A row per changed chart; empty without changes.
[[nodiscard]] std::string per_chart_text(const std::vector<ChangeReport::ChartChange>& changes);

}  // namespace ramcdb::cli
