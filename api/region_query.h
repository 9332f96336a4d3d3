#pragma once

#include <set>
#include <vector>

#include "api/snapshot_impl.h"
#include "ramcdb/region.h"

namespace ramcdb::detail {

/// The charts of a region, ascending: see Snapshot::find.
[[nodiscard]] std::vector<ChartId> find_charts(const Snapshot::Impl& at, const Region& region, ReadCost* cost);

/// Whether a chart's box meets a box, ball or frustum; false for the shapes that name charts.
[[nodiscard]] bool meets_shape(const MeshRecord& record, const LatticeBox& box, const RegionShape& shape);

/// All charts that have a corner, wherever in the index they stand: the position leads to their pages.
[[nodiscard]] std::set<ChartId> charts_at_corner(const Snapshot::Impl& at, CornerId corner, LatticePoint position,
                                                 ReadCost* cost = nullptr);

}  // namespace ramcdb::detail
