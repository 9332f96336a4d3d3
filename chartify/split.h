#pragma once

#include <cstdint>
#include <vector>

#include "chartify/face_mover.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {

/// Of moving seeds, where a chart is split.
inline constexpr int kSplitIterations = 3;

/// Cuts chart c into parts[c] charts of about the same size, or leaves it alone where that is 0. Renumbers.
/// REQUIRES: connected charts.
void split_charts(const IndexedMesh& mesh, const Neighbours& neighbours, const std::vector<std::uint32_t>& parts,
                  Partition& partition);

/// The neighbours that are of one's own chart.
[[nodiscard]] Neighbours neighbours_within_charts(const Neighbours& neighbours,
                                                  const std::vector<std::uint32_t>& chart_of_face);

/// Splits charts far above the target: those that neighbours could not take faces from, as where a surface branches.
void split_oversized(const IndexedMesh& mesh, const Neighbours& neighbours, const SizeLimits& limits,
                     Partition& partition);

}  // namespace ramcdb::chartify
