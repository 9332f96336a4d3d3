#pragma once

#include <map>
#include <set>
#include <vector>

#include "api/snapshot_impl.h"
#include "ramcdb/region.h"

namespace ramcdb::detail {

/// The charts of a region, ascending: see Snapshot::find.
[[nodiscard]] std::vector<ChartId> find_charts(const Snapshot::Impl& at, const Region& region, ReadCost* cost);

/// Whether a chart's box meets a box, ball or frustum; false for the shapes that name charts.
[[nodiscard]] bool meets_shape(const MeshRecord& record, const LatticeBox& box, const RegionShape& shape);
/// The same of a box in model units.
[[nodiscard]] bool meets_shape(const Point& lo, const Point& hi, const RegionShape& shape);

/// Corners with their positions.
using CornerPlaces = std::map<CornerId, LatticePoint>;

/// All charts that have each of some corners, wherever in the index they stand: the positions lead to their pages.
[[nodiscard]] std::map<CornerId, std::set<ChartId>> charts_at_corners(const Snapshot::Impl& at,
                                                                      const CornerPlaces& corners,
                                                                      ReadCost* cost = nullptr);

}  // namespace ramcdb::detail
