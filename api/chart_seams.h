#pragma once

#include <cstdint>
#include <vector>

#include "api/chart_spool.h"
#include "api/large_work.h"
#include "api/shared_vertices.h"
#include "api/topology.h"
#include "chartify/seams.h"

namespace ramcdb::detail {

/// What holds the batches of a mesh's charts together.
struct ChartSeams {
  SharedVertices shared;                          ///< by batches
  chartify::SeamNet net;                          ///< numbers are vertices of the whole mesh
  std::vector<std::vector<std::uint32_t>> wires;  ///< per batch those of the net that it has, ascending
  Topology topology;                              ///< of the whole mesh

  /// Per vertex of a batch whether others have it as well.
  [[nodiscard]] std::vector<std::uint8_t> shared_in(const ChartBatch& batch) const;
};

/// \param at_a_time how many batches are held
[[nodiscard]] ChartSeams find_seams(const ChartSpool& spool, const std::vector<ChartSpool::Batch>& batches,
                                    std::size_t at_a_time, const MeshSpool& mesh, const Lattice& lattice,
                                    const LargeWork& work);

}  // namespace ramcdb::detail
