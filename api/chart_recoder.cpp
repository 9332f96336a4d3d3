#include "api/chart_recoder.h"

#include <algorithm>

#include "api/store_format.h"
#include "codec/exact_codec.h"

namespace ramcdb::detail {
namespace {

void move_positions(std::span<Point> positions, std::span<const VertexKey> keys, const MoveTable& moves) {
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (const auto move = moves.find(keys[v].packed()); move != moves.end()) positions[v] = move->second->target;
}

/// The values of a chart in the numbering of its newly coded self.
codec::LayerValues renumbered(const codec::LayerValues& values, const codec::LayerShape& shape,
                              const codec::EncodedChart& chart) {
  codec::LayerValues out;
  const auto take = [&](std::size_t at) {
    const auto first = values.numbers.begin() + static_cast<std::ptrdiff_t>(at * shape.components);
    out.numbers.insert(out.numbers.end(), first, first + shape.components);
    if (!values.absent.empty()) out.absent.push_back(values.absent[at]);
  };
  if (shape.of == AttributeOf::vertex) {
    for (const std::uint32_t v : chart.source_vertex) take(v);
  } else {
    for (const std::uint32_t corner : chart.source_corner) {
      if (shape.of == AttributeOf::face) {
        take(corner / 3);
        continue;
      }
      for (std::uint32_t i = 0; i < 3; ++i) take(3 * (corner / 3) + (corner + i) % 3);
    }
  }
  return out;
}

codec::Polygons renumbered(const codec::Polygons& polygons, const codec::EncodedChart& chart) {
  codec::Polygons out;
  out.sizes = polygons.sizes;
  std::vector<std::uint32_t> now(3 * chart.source_corner.size());
  for (std::uint32_t f = 0; f < chart.source_corner.size(); ++f) {
    const std::uint32_t corner = chart.source_corner[f];
    out.of_face.push_back(polygons.of_face[corner / 3]);
    for (std::uint32_t i = 0; i < 3; ++i) now[3 * (corner / 3) + (corner + i) % 3] = 3 * f + i;
  }
  for (const std::uint32_t corner : polygons.corners) out.corners.push_back(now[corner]);
  return out;
}

/// Whether layers coded for the old chart are good for the new one.
bool keeps_order(const Chart& before, const codec::EncodedChart& after) {
  const codec::LayerOrder old_order(before), new_order(after.decoded);
  for (std::size_t i = 0; i < old_order.vertices().size(); ++i)
    if (after.source_vertex[new_order.vertices()[i]] != old_order.vertices()[i]) return false;
  const auto source_of = [&](std::uint32_t corner) {
    if (corner == codec::LayerOrder::kNone) return corner;
    const std::uint32_t source = after.source_corner[corner / 3];
    return 3 * (source / 3) + (source + corner) % 3;
  };
  for (std::size_t i = 0; i < old_order.entries().size(); ++i)
    if (source_of(new_order.entries()[i]) != old_order.entries()[i]) return false;
  // Where more than two faces meet at an edge, they are paired by number.
  for (std::uint32_t corner = 0; corner < 3 * after.source_corner.size(); ++corner)
    if (source_of(new_order.twin(corner)) != old_order.twin(source_of(corner))) return false;
  return true;
}

bool put_value(codec::LayerValues& values, const Layer& layer, std::size_t at, const CodedValue& value) {
  const std::size_t numbers = layer.shape().components;
  if (value.absent && values.absent.empty()) values.absent.resize(values.numbers.size() / numbers);
  if (!values.absent.empty()) values.absent[at] = value.absent;
  std::copy(value.numbers.begin(), value.numbers.end(),
            values.numbers.begin() + static_cast<std::ptrdiff_t>(at * numbers));
  return true;
}

}  // namespace

void move_points(std::span<LatticePoint> points, std::span<const VertexKey> keys, const MoveTable& moves) {
  for (std::size_t v = 0; v < points.size(); ++v)
    if (const auto move = moves.find(keys[v].packed()); move != moves.end()) points[v] = move->second->to;
}

ChartCoder coder_of(const Snapshot::Impl& at) {
  return {at.record().profile, at.tables(at.record().table), at.record().table};
}

RecodedChart ChartRecoder::run(LoadedChart loaded, bool moved, bool values_changed) const {
  RecodedChart recoded;
  recoded.base = recoded.entry = loaded.entry;
  recoded.cost_before = recoded.cost = loaded.cost;
  std::optional<codec::EncodedChart> encoded;
  if (moved) encoded = recode_geometry(loaded, recoded);
  if (moved && at_.record().exact) recode_exact(loaded, encoded, recoded);
  const bool reordered = encoded && !loaded.entry.layers.empty() && !keeps_order(loaded.chart, *encoded);
  if (reordered && loaded.layers.empty()) loaded = with_layers(loaded.entry.id);
  if (values_changed || reordered) recode_layers(loaded, encoded, reordered, recoded);
  return recoded;
}

/// Empty when all vertices keep their lattice points, unless such charts are coded, too.
std::optional<codec::EncodedChart> ChartRecoder::recode_geometry(const LoadedChart& loaded,
                                                                 RecodedChart& recoded) const {
  Chart moved = loaded.chart;
  move_points(moved.positions, loaded.keys, moves_);
  if (!coder_.unmoved_too && moved.positions == loaded.chart.positions) return std::nullopt;
  std::optional encoded = codec::encode_chart(moved, coder_.profile, coder_.tables, at_.record().range);
  recoded.blob = encoded->blob;
  recoded.cost = encoded->cost;
  recoded.expanded_range = encoded->expanded_range;
  recoded.entry.table = coder_.table;
  recoded.entry.box = {};
  for (const LatticePoint p : moved.positions) recoded.entry.box.add(p);
  return encoded;
}

void ChartRecoder::recode_exact(const LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded,
                                RecodedChart& recoded) const {
  std::vector<Point> exact = loaded.exact;
  move_positions(exact, loaded.keys, moves_);
  if (encoded) {
    std::vector<Point> renumbered;
    for (const std::uint32_t v : encoded->source_vertex) renumbered.push_back(exact[v]);
    exact = std::move(renumbered);
  }
  const auto& points = encoded ? encoded->decoded.positions : loaded.chart.positions;
  const MeshRecord& record = at_.record();
  put_layer(loaded.entry, kExactLayer, codec::encode_exact(exact, points, record.lattice, *record.exact), recoded);
}

/// Notes a layer's blob unless it is as it was.
void ChartRecoder::put_layer(const PageChart& entry, std::uint16_t layer, Buffer blob, RecodedChart& recoded) const {
  const auto ref = std::ranges::find(entry.layers, layer, &LayerRef::layer);
  const Buffer before =
      at_.store().reader()->get({db::Kind::attribute, at_.root().mesh, entry.id.value, ref->version, layer});
  if (before != blob) recoded.layers.push_back({layer, std::move(blob), before.size() + kBlobOverhead});
}

LoadedChart ChartRecoder::with_layers(ChartId id) const {
  return std::move(ChartLoader(at_).load(std::span(&id, 1), 1, nullptr, true).front());
}

/// \param all whether every layer is to be coded, in the numbering of `encoded`
void ChartRecoder::recode_layers(LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded, bool all,
                                 RecodedChart& recoded) const {
  const auto& layers = at_.layers().layers;
  const Chart& chart = encoded ? encoded->decoded : loaded.chart;
  const codec::LayerOrder order(chart);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (std::ranges::find(loaded.entry.layers, layers[i].id, &LayerRef::layer) == loaded.entry.layers.end())
      continue;  // polygons of triangles alone
    Buffer blob;
    if (layers[i].coding == LayerCoding::polygons) {
      if (!all) continue;
      blob = codec::encode_polygons(encoded ? renumbered(loaded.polygons, *encoded) : loaded.polygons, chart, order);
    } else {
      const bool edited = apply_edits(loaded, layers[i], loaded.layers[i]);
      if (!all && !edited) continue;
      const codec::LayerShape shape = layers[i].shape();
      blob = codec::encode_layer(encoded ? renumbered(loaded.layers[i], shape, *encoded) : loaded.layers[i], shape,
                                 chart, order);
    }
    put_layer(loaded.entry, layers[i].id, std::move(blob), recoded);
  }
}

bool ChartRecoder::apply_edits(const LoadedChart& loaded, const Layer& layer, codec::LayerValues& values) const {
  bool any = false;
  for (const LayerEdit& edit : layers_) {
    if (edit.layer.id != layer.id) continue;
    if (const auto at = edit.in_charts.find(loaded.entry.id); at != edit.in_charts.end())
      for (const auto& [index, value] : at->second) any |= put_value(values, layer, index, value);
    if (edit.at_vertices.empty()) continue;
    for (std::size_t v = 0; v < loaded.keys.size(); ++v)
      if (const auto at = edit.at_vertices.find(loaded.keys[v].packed()); at != edit.at_vertices.end())
        any |= put_value(values, layer, v, at->second);
  }
  return any;
}

}  // namespace ramcdb::detail
