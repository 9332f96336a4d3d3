#include "codec/raw_chart.h"

#include <algorithm>
#include <numeric>

namespace ramcdb::codec {

namespace {

/// Border as it is, then inner vertices by position, equal ones by number.
std::vector<std::uint32_t> canonical_vertices(const Chart& chart) {
  std::vector<std::uint32_t> order(chart.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin() + chart.border_count(), order.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return chart.positions[x] < chart.positions[y]; });
  return order;
}

/// A face in canonical form; equal ones stay in their order.
struct SourcedFace {
  Triangle face;
  std::uint32_t corner = 0;  ///< of the chart: its first one
  friend auto operator<=>(const SourcedFace&, const SourcedFace&) = default;
};

std::vector<SourcedFace> canonical_faces(const Chart& chart, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> number(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) number[order[v]] = v;
  std::vector<SourcedFace> faces;
  faces.reserve(chart.faces.size());
  for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
    const Triangle& face = chart.faces[f];
    Triangle renumbered{number[face[0]], number[face[1]], number[face[2]]};
    const auto smallest = std::min_element(renumbered.begin(), renumbered.end());
    const auto turn = static_cast<std::uint32_t>(smallest - renumbered.begin());
    std::rotate(renumbered.begin(), smallest, renumbered.end());
    faces.push_back({renumbered, 3 * f + turn});
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::int64_t step(std::uint32_t from, std::uint32_t to) { return std::int64_t{to} - from; }

/// `from` + a coded step, when that is below `limit`.
std::uint32_t take_step(ByteReader& reader, std::uint32_t from, std::size_t limit) {
  const std::uint64_t to = from + static_cast<std::uint64_t>(reader.signed_varint());
  if (to >= limit) reader.fail("names a vertex that it does not have");
  return static_cast<std::uint32_t>(to);
}

}  // namespace

RawChart encode_raw(const Chart& chart, LatticePoint box_low) {
  RawChart raw;
  raw.source_vertex = canonical_vertices(chart);
  for (const SourcedFace& face : canonical_faces(chart, raw.source_vertex)) {
    raw.faces.push_back(face.face);
    raw.source_corner.push_back(face.corner);
  }
  for (const std::uint32_t v : raw.source_vertex) raw.positions.push_back(chart.positions[v]);

  LatticePoint before = box_low;
  for (std::size_t v = chart.border_count(); v < raw.positions.size(); ++v) {
    for (int a = 0; a < 3; ++a) put_signed_varint(raw.bytes, std::int64_t{raw.positions[v][a]} - before[a]);
    before = raw.positions[v];
  }
  std::uint32_t first = 0;
  for (const Triangle& face : raw.faces) {
    put_signed_varint(raw.bytes, step(first, face[0]));
    put_signed_varint(raw.bytes, step(face[0], face[1]));
    put_signed_varint(raw.bytes, step(face[0], face[2]));
    first = face[0];
  }
  return raw;
}

RawContent decode_raw(ByteReader& reader, std::span<const LatticePoint> border, ChartCounts counts,
                      const LatticeBox& box) {
  if (3 * (std::uint64_t{counts.inner_vertices} + counts.faces) > reader.rest().size())
    reader.fail("declares more than it holds");
  RawContent content;
  content.positions.assign(border.begin(), border.end());
  LatticePoint point = box.lo;
  for (std::uint32_t i = 0; i < counts.inner_vertices; ++i) {
    for (int a = 0; a < 3; ++a) {
      const std::uint64_t above_low = static_cast<std::uint64_t>(reader.signed_varint()) +
                                      static_cast<std::uint64_t>(std::int64_t{point[a]} - box.lo[a]);
      if (above_low > static_cast<std::uint64_t>(std::int64_t{box.hi[a]} - box.lo[a]))
        reader.fail("has a vertex outside of its range");
      point[a] = static_cast<std::int32_t>(box.lo[a] + static_cast<std::int64_t>(above_low));
    }
    content.positions.push_back(point);
  }
  std::uint32_t first = 0;
  for (std::uint32_t i = 0; i < counts.faces; ++i) {
    first = take_step(reader, first, content.positions.size());
    const std::uint32_t second = take_step(reader, first, content.positions.size());
    const std::uint32_t third = take_step(reader, first, content.positions.size());
    content.faces.push_back({first, second, third});
  }
  reader.expect_end();
  return content;
}

}  // namespace ramcdb::codec
