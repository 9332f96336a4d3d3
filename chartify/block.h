#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/chartify.h"

/// Meshes larger than memory are cut block by block, in the order of their numbers. A chart that touches a later block
/// is not done: its faces are cut once more, with those of that block. What is done stays.
namespace ramcdb::chartify {

struct BlockCharts {
  Charts charts;
  std::vector<std::uint32_t> waits_for;  ///< per chart the first later block that it touches; kNone: it is done
};

/// Cuts a block, with what waited for it, into charts as chartify() does. Components of less than half the target that
/// touch later blocks are charts of their own.
/// \param later per vertex of the mesh the first later block that has it as well, or kNone
/// REQUIRES: canonical order. Errors: as chartify(), and invalid_argument for `later` of another number of vertices.
[[nodiscard]] BlockCharts cut_block(const IndexedMesh& mesh, std::span<const std::uint32_t> later,
                                    const Options& options);

}  // namespace ramcdb::chartify
