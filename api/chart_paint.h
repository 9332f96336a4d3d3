#pragma once

#include <span>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// A colour for each chart. Those by bits or version reach from blue for the least of these charts, over white, to red
/// for the most.
[[nodiscard]] std::vector<mesh_file::FaceColor> chart_colors(const Snapshot& snapshot,
                                                             const std::vector<ChartId>& charts, Paint paint);

}  // namespace ramcdb::detail
