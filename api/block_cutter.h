#pragma once

#include "api/chart_spool.h"
#include "api/face_blocks.h"
#include "api/large_work.h"
#include "chartify/chartify.h"

namespace ramcdb::detail {

/// Cuts a mesh into charts block by block (chartify/block.h): what touches later blocks goes on to the first of them.
/// \param most_faces that are cut at a time: charts for which a later block has no room are done as they are
[[nodiscard]] ChartSpool cut_blocks(const FaceBlocks& blocks, const PointFile& points, const Lattice& lattice,
                                    std::uint64_t most_faces, const chartify::Options& options, const LargeWork& work);

}  // namespace ramcdb::detail
