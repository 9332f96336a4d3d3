#include "api/edit_encoder.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <set>

#include "api/parallel.h"
#include "api/region_query.h"
#include "api/store_format.h"
#include "codec/exact_codec.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {
namespace {

using MoveTable = std::unordered_map<std::uint64_t, const VertexMove*>;

/// Everything that vertices touch. The snapshot of a chart or wire is that of the region's part which knows it, and
/// the newest part's for all outside the region.
class Touched {
 public:
  Touched(std::span<const RegionPart> parts, std::span<const VertexKey> keys) : parts_(parts) {
    std::set<std::uint32_t> wires, corners, charts;
    for (const VertexKey& key : keys) {
      if (key.where == VertexKey::Where::chart) charts.insert(key.id);
      if (key.where == VertexKey::Where::wire) wires.insert(key.id);
      if (key.where == VertexKey::Where::corner) corners.insert(key.id);
    }
    if (keys.empty()) return;
    for (const RegionPart& part : parts) {
      for (const ChartId id : part.charts) {
        const auto ref = part.at->pages().leaf_of(id);
        const PageChart& chart = *find_chart(*ref->leaf, id);
        if (charts.contains(id.value)) charts_.emplace(id, part.at);
        for (const WireLoop& loop : chart.loops)
          for (const DirectedWire step : loop) look_at_wire(*part.at, *ref->leaf, step.wire, wires, corners);
      }
    }
  }

  [[nodiscard]] const std::map<ChartId, const Snapshot::Impl*>& charts() const { return charts_; }
  [[nodiscard]] const std::set<WireId>& wires() const { return wires_; }

 private:
  void look_at_wire(const Snapshot::Impl& at, const LeafPage& leaf, WireId id, const std::set<std::uint32_t>& wires,
                    const std::set<std::uint32_t>& corners) {
    const PageWire& wire = *find_wire(leaf, id);
    if (wires.contains(id.value)) add_wire(wire);
    for (const CornerId corner : {wire.begin, wire.end}) {
      if (!corners.contains(corner.value) || !corners_.insert(corner).second) continue;
      for (const ChartId chart : charts_at_corner(at, corner, find_corner(leaf, corner)->position))
        add_around_corner(chart, corner);
    }
  }

  /// The part of the region that knows a chart, or its newest one.
 public:
  [[nodiscard]] const Snapshot::Impl& part_of(ChartId chart) const {
    const RegionPart* newest = &parts_.front();
    for (const RegionPart& part : parts_) {
      if (std::find(part.charts.begin(), part.charts.end(), chart) != part.charts.end()) return *part.at;
      if (part.at->version() > newest->at->version()) newest = &part;
    }
    return *newest->at;
  }

 private:
  void add_around_corner(ChartId id, CornerId corner) {
    const Snapshot::Impl& at = part_of(id);
    charts_.emplace(id, &at);
    const auto ref = at.pages().leaf_of(id);
    for (const WireLoop& loop : find_chart(*ref->leaf, id)->loops)
      for (const DirectedWire step : loop) {
        const PageWire& wire = *find_wire(*ref->leaf, step.wire);
        if (wire.begin == corner || wire.end == corner) add_wire(wire);
      }
  }

  void add_wire(const PageWire& wire) {
    wires_.insert(wire.id);
    for (const ChartId chart : wire.charts) charts_.emplace(chart, &part_of(chart));
  }

  std::span<const RegionPart> parts_;
  std::map<ChartId, const Snapshot::Impl*> charts_;
  std::set<WireId> wires_;
  std::set<CornerId> corners_;
};

void move_points(std::span<LatticePoint> points, std::span<const VertexKey> keys, const MoveTable& moves) {
  for (std::size_t v = 0; v < points.size(); ++v)
    if (const auto move = moves.find(keys[v].packed()); move != moves.end()) points[v] = move->second->to;
}

void move_positions(std::span<Point> positions, std::span<const VertexKey> keys, const MoveTable& moves) {
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (const auto move = moves.find(keys[v].packed()); move != moves.end()) positions[v] = move->second->target;
}

/// Empty when all its points stay.
std::optional<RecodedWire> recode_wire(const LoadedWire& loaded, const MoveTable& moves) {
  RecodedWire recoded{loaded.entry, loaded.entry.id, loaded.wire, loaded.blob_bytes};
  std::vector<VertexKey> keys{{VertexKey::Where::corner, loaded.entry.begin.value, 0}};
  for (std::uint32_t i = 0; i < loaded.entry.inner_points; ++i)
    keys.push_back({VertexKey::Where::wire, loaded.entry.id.value, i});
  keys.push_back({VertexKey::Where::corner, loaded.entry.end.value, 0});
  move_points(recoded.wire.points, keys, moves);
  if (recoded.wire.points == loaded.wire.points) return std::nullopt;
  return recoded;
}

/// Codes the wires of an edit that have inner points, some to a blob.
void encode_wires(EncodedEdit& edit) {
  std::vector<codec::WireOfGroup> wires;
  for (const auto& [id, recoded] : edit.wires)
    if (recoded.base.inner_points) wires.push_back({id, &recoded.wire});
  for (codec::CodedWireGroup& group : codec::encode_in_groups(wires)) {
    const WireId first = wires[group.first].id;
    for (std::size_t i = 0; i < group.count; ++i) edit.wires.at(wires[group.first + i].id).group = first;
    edit.wire_groups.emplace(first, std::move(group.blob));
  }
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

/// How charts are coded anew.
struct ChartCoder {
  codec::Profile profile;
  const codec::CoderTables& tables;
  TableId table;
  bool unmoved_too = false;  ///< code charts anew whose vertices stay where they are
};

ChartCoder coder_of(const Snapshot::Impl& at) {
  return {at.record().profile, at.tables(at.record().table), at.record().table};
}

class ChartRecoder {
 public:
  ChartRecoder(const Snapshot::Impl& at, const ChartCoder& coder, const MoveTable& moves,
               std::span<const LayerEdit> layers)
      : at_(at), coder_(coder), moves_(moves), layers_(layers) {}

  RecodedChart run(LoadedChart loaded, bool moved, bool values_changed) const {
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

 private:
  /// Empty when all vertices keep their lattice points, unless such charts are coded, too.
  std::optional<codec::EncodedChart> recode_geometry(const LoadedChart& loaded, RecodedChart& recoded) const {
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

  void recode_exact(const LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded,
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
  void put_layer(const PageChart& entry, std::uint16_t layer, Buffer blob, RecodedChart& recoded) const {
    const auto ref = std::ranges::find(entry.layers, layer, &LayerRef::layer);
    const Buffer before =
        at_.store().reader()->get({db::Kind::attribute, at_.root().mesh, entry.id.value, ref->version, layer});
    if (before != blob) recoded.layers.push_back({layer, std::move(blob), before.size() + kBlobOverhead});
  }

  [[nodiscard]] LoadedChart with_layers(ChartId id) const {
    return std::move(ChartLoader(at_).load(std::span(&id, 1), 1, nullptr, true).front());
  }

  /// \param all whether every layer is to be coded, in the numbering of `encoded`
  void recode_layers(LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded, bool all,
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

  bool apply_edits(const LoadedChart& loaded, const Layer& layer, codec::LayerValues& values) const {
    bool any = false;
    for (const LayerEdit& edit : layers_) {
      if (edit.layer.id != layer.id) continue;
      if (const auto at = edit.in_charts.find(loaded.entry.id); at != edit.in_charts.end())
        for (const auto& [index, value] : at->second) any |= put(values, layer, index, value);
      if (edit.at_vertices.empty()) continue;
      for (std::size_t v = 0; v < loaded.keys.size(); ++v)
        if (const auto at = edit.at_vertices.find(loaded.keys[v].packed()); at != edit.at_vertices.end())
          any |= put(values, layer, v, at->second);
    }
    return any;
  }

  static bool put(codec::LayerValues& values, const Layer& layer, std::size_t at, const CodedValue& value) {
    const std::size_t numbers = layer.shape().components;
    if (value.absent && values.absent.empty()) values.absent.resize(values.numbers.size() / numbers);
    if (!values.absent.empty()) values.absent[at] = value.absent;
    std::copy(value.numbers.begin(), value.numbers.end(),
              values.numbers.begin() + static_cast<std::ptrdiff_t>(at * numbers));
    return true;
  }

  const Snapshot::Impl& at_;
  ChartCoder coder_;
  const MoveTable& moves_;
  std::span<const LayerEdit> layers_;
};

std::vector<VertexKey> keys_of(std::span<const VertexMove> moves) {
  std::vector<VertexKey> keys;
  for (const VertexMove& move : moves) keys.push_back(move.key);
  return keys;
}

std::vector<VertexKey> keys_of(std::span<const LayerEdit> layers) {
  std::vector<VertexKey> keys;
  for (const LayerEdit& edit : layers)
    for (const auto& [key, value] : edit.at_vertices) keys.push_back(VertexKey::unpack(key));
  return keys;
}

}  // namespace

std::optional<VertexMove> move_to(const Snapshot::Impl& at, const RegionMesh& region, std::size_t vertex,
                                  const Point& p) {
  const Lattice& lattice = at.record().lattice;
  VertexMove move{region.keys[vertex], region.points[vertex], {}, {}, at.record().rounded(p)};
  move.to = lattice.snap(move.target);
  if (!at.record().exact) {
    if (move.to == move.from) return std::nullopt;
    move.position = lattice.position(move.from);
    move.target = lattice.position(move.to);
    return move;
  }
  move.position = region.exact[vertex];
  const auto same_bits = [&](int axis) {
    return std::bit_cast<std::uint64_t>(move.position[axis]) == std::bit_cast<std::uint64_t>(move.target[axis]);
  };
  if (same_bits(0) && same_bits(1) && same_bits(2)) return std::nullopt;
  return move;
}

EncodedEdit encode_edit(std::span<const RegionPart> parts, const Edit& edit, unsigned threads) {
  const std::vector<VertexKey> moved_keys = keys_of(edit.moves), value_keys = keys_of(edit.layers);
  const Touched moved(parts, moved_keys), valued(parts, value_keys);
  MoveTable table;
  EncodedEdit encoded;
  for (const VertexMove& move : edit.moves) {
    table.emplace(move.key.packed(), &move);
    if (move.from != move.to && move.key.where == VertexKey::Where::corner)
      encoded.corners.emplace(CornerId(move.key.id), move.to);
  }
  std::map<ChartId, const Snapshot::Impl*> charts = moved.charts(), with_values = valued.charts();
  for (const LayerEdit& layer : edit.layers)
    for (const auto& [id, values] : layer.in_charts) with_values.emplace(id, &moved.part_of(id));
  charts.insert(with_values.begin(), with_values.end());

  std::map<std::pair<const Snapshot::Impl*, bool>, std::vector<ChartId>> jobs;
  for (const auto& [id, at] : charts) jobs[{at, with_values.contains(id)}].push_back(id);
  for (const auto& [job, ids] : jobs) {
    const auto& [at, values_changed] = job;
    ChartLoader loader(*at);
    std::vector<LoadedChart> loaded = loader.load(ids, threads, nullptr, values_changed);
    std::vector<RecodedChart> recoded(loaded.size());
    const ChartRecoder recoder(*at, coder_of(*at), table, edit.layers);
    parallel_for(loaded.size(), threads, [&](std::size_t i) {
      recoded[i] = recoder.run(std::move(loaded[i]), moved.charts().contains(ids[i]), values_changed);
    });
    for (RecodedChart& chart : recoded)
      if (!chart.blob.empty() || !chart.layers.empty()) encoded.charts.emplace(chart.base.id, std::move(chart));
    for (const auto& [id, wire] : loader.wires())
      if (moved.wires().contains(id) && !encoded.wires.contains(id))
        if (auto moved_wire = recode_wire(wire, table)) encoded.wires.emplace(id, *std::move(moved_wire));
  }
  encode_wires(encoded);
  return encoded;
}

EncodedEdit encode_again(const Snapshot::Impl& at, codec::Profile profile, const codec::CoderTables& tables,
                         unsigned threads, const std::function<void(double)>& progress) {
  constexpr std::size_t kBatch = 256;  // charts in memory at a time
  EncodedEdit encoded;
  NewCoding& coding = encoded.coding.emplace();
  coding.profile = profile;
  if (!(tables == codec::CoderTables{})) {
    coding.table = at.record().next_table;
    coding.tables = codec::encode_tables(tables);
  }
  coding.table_bytes_before = at.table_bytes();

  const std::vector<ChartId> ids = at.pages().all_charts();
  const MoveTable no_moves;
  const ChartRecoder recoder(at, {profile, tables, coding.table, true}, no_moves, {});
  for (std::size_t first = 0; first < ids.size(); first += kBatch) {
    progress(static_cast<double>(first) / static_cast<double>(ids.size()));
    const auto batch = std::span(ids).subspan(first, std::min(kBatch, ids.size() - first));
    std::vector<LoadedChart> loaded = ChartLoader(at).load(batch, threads, nullptr, true);
    std::vector<RecodedChart> recoded(loaded.size());
    parallel_for(loaded.size(), threads,
                 [&](std::size_t i) { recoded[i] = recoder.run(std::move(loaded[i]), true, false); });
    for (RecodedChart& chart : recoded) encoded.charts.emplace(chart.base.id, std::move(chart));
  }
  return encoded;
}

}  // namespace ramcdb::detail
