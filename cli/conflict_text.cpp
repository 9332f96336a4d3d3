#include "cli/conflict_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace ramcdb::cli {

std::string conflict_text(const std::vector<MergeConflict>& conflicts) {
  constexpr std::size_t kMost = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, conflicts.size()); ++i) {
    const Point& p = conflicts[i].place;
    text += fmt::format("\n  chart {} near {:.9g},{:.9g},{:.9g}: {}", conflicts[i].chart.value, p.x, p.y, p.z,
                        conflicts[i].what);
  }
  if (conflicts.size() > kMost) text += fmt::format("\n  and {} more places", conflicts.size() - kMost);
  return text + "\n";
}

}  // namespace ramcdb::cli
