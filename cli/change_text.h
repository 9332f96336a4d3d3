#pragma once

#include <string>
#include <vector>

#include "ramcdb/figures.h"

/// What status, diff and commit say alike about a change.
namespace ramcdb::cli {

/// "re-meshed", "moved", "attributes", "re-cut only".
[[nodiscard]] const char* class_text(ChangeClass change_class);

/// How much changed, a line per figure that is not 0, and the charts of each class; empty where nothing did.
[[nodiscard]] std::string figures_text(const ChangeFigures& figures, const std::vector<ChartChange>& charts);

/// How an edited file was understood, a line each; empty where there is nothing to say.
[[nodiscard]] std::string notes_text(const FileNotes& notes);

/// What the edited file would change, and what others did meanwhile; several lines.
[[nodiscard]] std::string change_text(const ChangeReport& report, const std::string& file);

/// A row per chart, without those that were only cut or coded anew; empty without changes.
[[nodiscard]] std::string per_chart_text(const std::vector<ChartChange>& changes);

/// Where a heat map was written, and what its last colour stands for.
[[nodiscard]] std::string heatmap_text(const std::string& file, const ChangeFigures& figures);

}  // namespace ramcdb::cli
