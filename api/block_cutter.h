#pragma once

#include "api/chart_spool.h"
#include "api/face_blocks.h"
#include "api/large_work.h"
#include "chartify/chartify.h"

namespace ramcdb::detail {

/// Cuts a mesh into charts block by block (chartify/block.h), several blocks without common vertices at a time. What
/// touches blocks that are still to be cut goes on to the first of them; where that has no room, it is done as it is.
/// \param sizes of blocks with what waits for them
[[nodiscard]] ChartSpool cut_blocks(const FaceBlocks& blocks, const MeshSpool& mesh, const Lattice& lattice,
                                    PartSizes sizes, const chartify::Options& options, const LargeWork& work);

}  // namespace ramcdb::detail
