#include "api/edit_encoder.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <set>

#include "api/chart_recoder.h"
#include "api/parallel.h"
#include "api/region_query.h"
#include "api/store_format.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {
namespace {

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
