#include "api/edit_encoder.h"

#include <algorithm>
#include <set>

#include "api/parallel.h"
#include "api/region_query.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {
namespace {

using MoveTable = std::unordered_map<std::uint64_t, LatticePoint>;

/// Everything that the moves touch. The snapshot of a chart or wire is that of the region's part which knows it, and
/// the newest part's for all outside the region.
class Touched {
 public:
  Touched(std::span<const RegionPart> parts, std::span<const VertexMove> moves) : parts_(parts) {
    std::set<std::uint32_t> wires, corners, charts;
    for (const VertexMove& move : moves) {
      if (move.key.where == VertexKey::Where::chart) charts.insert(move.key.id);
      if (move.key.where == VertexKey::Where::wire) wires.insert(move.key.id);
      if (move.key.where == VertexKey::Where::corner) corners.insert(move.key.id);
    }
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

  const Snapshot::Impl& part_of(ChartId chart) const {
    const RegionPart* newest = &parts_.front();
    for (const RegionPart& part : parts_) {
      if (std::find(part.charts.begin(), part.charts.end(), chart) != part.charts.end()) return *part.at;
      if (part.at->version() > newest->at->version()) newest = &part;
    }
    return *newest->at;
  }

  std::span<const RegionPart> parts_;
  std::map<ChartId, const Snapshot::Impl*> charts_;
  std::set<WireId> wires_;
  std::set<CornerId> corners_;
};

void move_points(std::span<LatticePoint> points, std::span<const VertexKey> keys, const MoveTable& moves) {
  for (std::size_t v = 0; v < points.size(); ++v)
    if (const auto move = moves.find(keys[v].packed()); move != moves.end()) points[v] = move->second;
}

RecodedWire recode_wire(const LoadedWire& loaded, const MoveTable& moves) {
  RecodedWire recoded{loaded.entry, {}, loaded.blob_bytes};
  Wire wire = loaded.wire;
  std::vector<VertexKey> keys{{VertexKey::Where::corner, loaded.entry.begin.value, 0}};
  for (std::uint32_t i = 0; i < loaded.entry.inner_points; ++i)
    keys.push_back({VertexKey::Where::wire, loaded.entry.id.value, i});
  keys.push_back({VertexKey::Where::corner, loaded.entry.end.value, 0});
  move_points(wire.points, keys, moves);
  if (loaded.entry.inner_points) recoded.blob = codec::encode_wire(wire);
  return recoded;
}

RecodedChart recode_chart(const Snapshot::Impl& at, LoadedChart loaded, const MoveTable& moves) {
  move_points(loaded.chart.positions, loaded.keys, moves);
  const MeshRecord& record = at.record();
  auto encoded = codec::encode_chart(loaded.chart, record.profile, at.tables(record.table), record.range);
  RecodedChart recoded{loaded.entry, loaded.entry, std::move(encoded.blob),
                       loaded.cost,  encoded.cost, encoded.expanded_range};
  recoded.entry.table = record.table;
  recoded.entry.box = {};
  for (const LatticePoint p : loaded.chart.positions) recoded.entry.box.add(p);
  return recoded;
}

}  // namespace

EncodedEdit encode_moves(std::span<const RegionPart> parts, std::span<const VertexMove> moves, unsigned threads) {
  const Touched touched(parts, moves);
  MoveTable table;
  EncodedEdit edit;
  for (const VertexMove& move : moves) {
    table.emplace(move.key.packed(), move.to);
    if (move.key.where == VertexKey::Where::corner) edit.corners.emplace(CornerId(move.key.id), move.to);
  }
  std::map<const Snapshot::Impl*, std::vector<ChartId>> by_snapshot;
  for (const auto& [id, at] : touched.charts()) by_snapshot[at].push_back(id);
  for (auto& [at, ids] : by_snapshot) {
    ChartLoader loader(*at);
    std::vector<LoadedChart> loaded = loader.load(ids, threads);
    std::vector<RecodedChart> recoded(loaded.size());
    parallel_for(loaded.size(), threads,
                 [&](std::size_t i) { recoded[i] = recode_chart(*at, std::move(loaded[i]), table); });
    for (RecodedChart& chart : recoded) edit.charts.emplace(chart.base.id, std::move(chart));
    for (const auto& [id, wire] : loader.wires())
      if (touched.wires().contains(id) && !edit.wires.contains(id)) edit.wires.emplace(id, recode_wire(wire, table));
  }
  return edit;
}

}  // namespace ramcdb::detail
