#pragma once

#include <vector>

#include "api/change_set.h"
#include "ramcdb/figures.h"

namespace ramcdb::detail {

/// The chart that each face counts in: those of the region before an edit (faces that stay as in `after`), and those of
/// the edited mesh.
struct FaceCharts {
  std::vector<ChartId> before, after;
};

/// An edit in figures.
struct MeasuredChange {
  ChangeFigures total;
  std::vector<ChartChange> per_chart;  ///< of all charts of faces, ascending; untouched ones among them
};
[[nodiscard]] MeasuredChange measure_change(const Snapshot::Impl& at, const RegionMesh& region,
                                            const EditedRegion& edited, const ChangeSet& changes,
                                            const FaceCharts& charts);

/// How far each vertex of the edited mesh was moved, model units.
[[nodiscard]] std::vector<double> displacements_of(const EditedRegion& edited, const ChangeSet& changes);

}  // namespace ramcdb::detail
