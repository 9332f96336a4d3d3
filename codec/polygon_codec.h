#pragma once

#include <cstdint>
#include <vector>

#include "codec/layer_order.h"
#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// Which faces of a chart together are one polygon. A corner is 3 * face + 0..2.
struct Polygons {
  std::vector<std::uint32_t> of_face;  ///< per face its polygon
  std::vector<std::uint32_t> sizes;    ///< corners per polygon: its faces + 2
  std::vector<std::uint32_t> corners;  ///< polygon after polygon, each around; a corner of one of its faces each

  friend bool operator==(const Polygons&, const Polygons&) = default;
};

/// Codes how triangles join to polygons: a bit per inner edge, predicted by what is known of both faces (a mesh of
/// quads takes less than half a bit per triangle edge). Polygons whose triangles do not join like a tree over shared
/// edges are listed. Depends on connectivity only, as layers do. Throws invalid_argument when `polygons` are not the
/// chart's. What comes back has the same polygons, each perhaps begun at another corner, in the order of their first
/// faces.
[[nodiscard]] Buffer encode_polygons(const Polygons& polygons, const Chart& chart, const LayerOrder& order);

/// Bytes may be hostile. Throws corrupt, also when the chart is not the encoder's (with high probability).
[[nodiscard]] Polygons decode_polygons(Bytes blob, const Chart& chart, const LayerOrder& order);

}  // namespace ramcdb::codec
