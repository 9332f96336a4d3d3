#pragma once

#include <optional>
#include <span>
#include <vector>

#include "codec/dense_surface.h"
#include "codec/tables.h"
#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"

/// The fast profile: connectivity first, then all misses, then all positions, each in a loop of its own.
///
///   fast   = isolated:varint joins:varint side_size:varint side degrees residuals
///
/// side: large degrees, joins, and vertices without neighbours, of an adaptive range coder; degrees: fast_steps.h;
/// residuals: fast_residuals.h.
namespace ramcdb::codec {

struct FastContext {
  std::span<const LatticePoint> border;
  std::span<const std::uint32_t> loop_sizes;
  ChartCounts counts;
  LatticeBox box;  ///< of all inner vertices
  const CoderTables* tables = nullptr;
};

/// A chart as the fast coder wrote or read it.
struct FastChart {
  std::vector<LatticePoint> positions;  ///< border first, inner ones in the order of coding
  std::vector<Triangle> faces;
  std::uint64_t connectivity_cost = 0;  ///< in 1/256 bit
  std::uint64_t geometry_cost = 0;
};

struct FastStream {
  Buffer bytes;
  FastChart coded;
  std::vector<std::uint32_t> source_vertex;  ///< of coded -> of the chart that was encoded
  std::vector<std::uint32_t> source_corner;  ///< face of coded -> corner of the chart that was encoded
};

/// Codes inner vertices and faces of a chart. Nothing when its faces are not a manifold surface that ends at its loops.
/// REQUIRES: indices in range, inner vertices within context.box.
[[nodiscard]] std::optional<FastStream> encode_fast(const Chart& chart, const FastContext& context);

/// Throws corrupt when `stream` is not one that encode_fast wrote with the same context. Takes memory for all that
/// context.counts declare, once they are plausible for a stream of such a length.
[[nodiscard]] FastChart decode_fast(Bytes stream, const FastContext& context);

}  // namespace ramcdb::codec
