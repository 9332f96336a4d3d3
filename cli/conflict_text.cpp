#include "cli/conflict_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/chart_list.h"

namespace ramcdb::cli {

std::string conflicting_charts(const CommitReport& report) {
  if (report.per_mesh.empty()) return "charts " + chart_list(report.conflicts);
  std::string text;
  for (const CommitReport& of_mesh : report.per_mesh)
    if (!of_mesh.conflicts.empty())
      text += (text.empty() ? "charts " : " and ") + chart_list(of_mesh.conflicts) + " of " + of_mesh.mesh;
  return text;
}

std::string conflict_text(const std::vector<MergeConflict>& conflicts) {
  constexpr std::size_t kMost = 10;
  const bool several = !conflicts.empty() && conflicts.front().mesh != conflicts.back().mesh;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, conflicts.size()); ++i) {
    const Point& p = conflicts[i].place;
    text +=
        fmt::format("\n  {}chart {} near {:.9g},{:.9g},{:.9g}: {}", several ? "mesh " + conflicts[i].mesh + ", " : "",
                    conflicts[i].chart.value, p.x, p.y, p.z, conflicts[i].what);
  }
  if (conflicts.size() > kMost) text += fmt::format("\n  and {} more places", conflicts.size() - kMost);
  return text + "\n";
}

}  // namespace ramcdb::cli
