#pragma once

#include <vector>

#include "api/page_index.h"

namespace ramcdb::detail {

/// How the charts of a mesh differ between two versions; all ascending.
struct ChartDifference {
  std::vector<ChartId> changed;  ///< both have them, in different states
  std::vector<ChartId> added, removed;

  [[nodiscard]] bool empty() const { return changed.empty() && added.empty() && removed.empty(); }
};

/// Walks both trees of index pages and skips what they share: the cost follows the difference.
[[nodiscard]] ChartDifference chart_difference(const PageIndex& from, const PageIndex& to, ReadCost* cost = nullptr);

}  // namespace ramcdb::detail
