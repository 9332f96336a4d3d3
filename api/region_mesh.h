#pragma once

#include <span>
#include <vector>

#include "api/chart_loader.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// Some charts of one snapshot. A region as a rule is one such part; after a commit that went in beside other people's,
/// a checked-out file has charts of several versions.
struct RegionPart {
  const Snapshot::Impl* at = nullptr;
  std::vector<ChartId> charts;
};

/// Joins charts into one mesh: vertices with equal keys become one. Charts ascending; vertices in the order in which
/// the charts first name them.
[[nodiscard]] RegionMesh load_region(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost = nullptr,
                                     bool with_layers = false);

}  // namespace ramcdb::detail
