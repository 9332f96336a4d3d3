#pragma once

#include "codec/chart_codec.h"
#include "codec/dense_surface.h"
#include "codec/varint.h"

namespace ramcdb::codec {

/// A chart blob begins with
///
///   header  = format:1 coding:1 flags:1 inner_vertices:varint faces:varint [box] [edge_exponent:1] check:4
///   box     = 3 x (low: signed varint, high - low: varint)     if flags has 1
///   edge_exponent                                              when coding is dense
///
/// and goes on with what the coder wrote. Format and coding are never 0. check: the lower half of XXH3-64 over the rest
/// of the header and everything that decoding the blob takes and gives (chart_check()), so that a wrong border, table
/// or range, a damaged blob and a miscompiled decoder are all noticed.
struct ChartHeader {
  ChartCoding coding = ChartCoding::dense;
  ChartCounts counts;
  bool own_box = false;
  LatticeBox box;  ///< of all inner vertices: the mesh's range, or with own_box the chart's own
  int edge_exponent = 0;
  bool aligned = false;  ///< dense: coordinates are first looked for among those of neighbours
  std::uint32_t check = 0;
};

/// Formats that were ever written: 1.
inline constexpr std::uint8_t kChartFormat = 1;

/// What a chart may have: a hundred times more than pays, and little enough that the worst blob takes a decoder less
/// than 256 MB and some seconds. Encoders refuse more, decoders do not believe it.
inline constexpr std::uint32_t kMaxChartVertices = 1u << 19;
inline constexpr std::uint32_t kMaxChartFaces = 1u << 20;

void put_chart_header(Buffer& out, const ChartHeader& header);

/// \param range what the box is unless the chart has its own
[[nodiscard]] ChartHeader take_chart_header(ByteReader& reader, const LatticeBox& range);

/// The check of a chart that was coded as `payload` with `header`, `range` and `tables`: over the bytes of the header
/// before the check and of the payload; the number of loops, loop sizes, positions, faces, the range, and the weights
/// of fan and plane classes, each of these numbers as four bytes, lowest first.
[[nodiscard]] std::uint32_t chart_check(const ChartHeader& header, Bytes payload, const Chart& chart,
                                        const LatticeBox& range, const CoderTables& tables);

}  // namespace ramcdb::codec
