#pragma once

#include <optional>

#include "codec/dense_walk.h"

namespace ramcdb::codec {

/// A chart as the dense coder wrote or read it.
struct DenseChart {
  std::vector<LatticePoint> positions;  ///< border first, inner ones in the order of coding
  std::vector<Triangle> faces;
  std::uint64_t connectivity_cost = 0;  ///< in 1/256 bit
  std::uint64_t geometry_cost = 0;
};

struct DenseStream {
  Buffer bytes;
  DenseChart coded;
  DenseMisses misses;
  std::vector<std::uint32_t> source_vertex;  ///< of coded -> of the chart that was encoded
  std::vector<std::uint32_t> source_corner;  ///< face of coded -> corner of the chart that was encoded
};

/// Codes inner vertices and faces of a chart. Nothing when its faces are not a manifold surface that ends at its loops.
/// REQUIRES: indices in range, inner vertices within context.box.
[[nodiscard]] std::optional<DenseStream> encode_dense(const Chart& chart, const DenseContext& context);

/// Throws corrupt when `stream` is not one that encode_dense wrote with the same context.
[[nodiscard]] DenseChart decode_dense(Bytes stream, const DenseContext& context);

/// The edge_exponent of a chart's context: of the mean length of its edges, 0 to 31. Does not depend on numbering.
[[nodiscard]] int mean_edge_exponent(const Chart& chart);

}  // namespace ramcdb::codec
