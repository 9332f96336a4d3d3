#pragma once

#include <cstdint>
#include <vector>

#include "codec/dense_surface.h"
#include "codec/varint.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

struct RawChart {
  Buffer bytes;
  std::vector<LatticePoint> positions;  ///< border first, inner ones by position
  std::vector<Triangle> faces;          ///< smallest corner first, ascending
  std::vector<std::uint32_t> source_vertex;
  std::vector<std::uint32_t> source_corner;  ///< per face the corner of the chart that became its first one
};

/// Codes inner vertices and faces of any chart, compactly only in so far as neighbours in order are near:
///
///   raw    = vertex* face*
///   vertex = 3 x signed varint     difference to the vertex before; the first to the low corner of the chart's box
///   face   = 3 x signed varint     a - (a of the face before, or 0), b - a, c - a
///
/// Vertices and faces are sorted first, so that the bytes do not depend on how the chart numbers them.
/// REQUIRES: indices in range.
[[nodiscard]] RawChart encode_raw(const Chart& chart, LatticePoint box_low);

struct RawContent {
  std::vector<LatticePoint> positions;
  std::vector<Triangle> faces;
};

/// Throws corrupt for bytes that encode_raw did not write or that leave `box`.
[[nodiscard]] RawContent decode_raw(ByteReader& reader, std::span<const LatticePoint> border, ChartCounts counts,
                                    const LatticeBox& box);

}  // namespace ramcdb::codec
