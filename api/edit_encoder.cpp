#include "api/edit_encoder.h"

#include <algorithm>
#include <map>
#include <set>

#include "api/edit_builder.h"
#include "api/recut_encoder.h"
#include "api/region_query.h"
#include "api/store_format.h"
#include "chartify/parallel.h"

namespace ramcdb::detail {
namespace {

/// The charts and wires that vertices of a region touch, in the region and outside.
class Touched {
 public:
  Touched(const Snapshot::Impl& at, const RegionMesh& region, std::span<const VertexKey> keys) : at_(at) {
    if (keys.empty()) return;
    std::set<std::uint32_t> wires, corners;
    for (const VertexKey& key : keys) {
      if (key.where == VertexKey::Where::chart) charts_.insert(ChartId(key.id));
      if (key.where == VertexKey::Where::wire) wires.insert(key.id);
      if (key.where == VertexKey::Where::corner) corners.insert(key.id);
    }
    for (const ChartId id : region.charts) {
      const auto ref = at.pages().leaf_of(id);
      for (const WireLoop& loop : find_chart(*ref->leaf, id)->loops)
        for (const DirectedWire step : loop) look_at_wire(*ref->leaf, step.wire, wires, corners);
    }
    for (const auto& [corner, around] : charts_at_corners(at_, corners_))
      for (const ChartId chart : around) add_around_corner(chart, corner);
  }

  [[nodiscard]] const std::set<ChartId>& charts() const { return charts_; }
  [[nodiscard]] const std::set<WireId>& wires() const { return wires_; }

 private:
  void look_at_wire(const LeafPage& leaf, WireId id, const std::set<std::uint32_t>& wires,
                    const std::set<std::uint32_t>& corners) {
    const PageWire& wire = *find_wire(leaf, id);
    if (wires.contains(id.value)) add_wire(wire);
    for (const CornerId corner : {wire.begin, wire.end})
      if (corners.contains(corner.value)) corners_.emplace(corner, find_corner(leaf, corner)->position);
  }

  void add_around_corner(ChartId id, CornerId corner) {
    charts_.insert(id);
    const auto ref = at_.pages().leaf_of(id);
    for (const WireLoop& loop : find_chart(*ref->leaf, id)->loops)
      for (const DirectedWire step : loop) {
        const PageWire& wire = *find_wire(*ref->leaf, step.wire);
        if (wire.begin == corner || wire.end == corner) add_wire(wire);
      }
  }

  void add_wire(const PageWire& wire) {
    wires_.insert(wire.id);
    charts_.insert(wire.charts.begin(), wire.charts.end());
  }

  const Snapshot::Impl& at_;
  std::set<ChartId> charts_;
  std::set<WireId> wires_;
  CornerPlaces corners_;
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

/// Adds a wire if any of its points moves.
void recode_wire(const LoadedWire& loaded, const MoveTable& moves, EditBuilder& builder) {
  std::vector<VertexKey> keys{{VertexKey::Where::corner, loaded.entry.begin.value, 0}};
  for (std::uint32_t i = 0; i < loaded.entry.inner_points; ++i)
    keys.push_back({VertexKey::Where::wire, loaded.entry.id.value, i});
  keys.push_back({VertexKey::Where::corner, loaded.entry.end.value, 0});
  Wire moved = loaded.wire;
  move_points(moved.points, keys, moves);
  if (moved.points != loaded.wire.points) builder.add_wire(loaded.entry, std::move(moved), loaded.blob_bytes);
}

/// Codes what keeps its connectivity.
class InPlaceEncoder {
 public:
  InPlaceEncoder(const Snapshot::Impl& at, const RegionMesh& region, const ChangeSet& changes, unsigned threads)
      : at_(at),
        changes_(changes),
        threads_(threads),
        moved_(at, region, keys_of(changes.moves)),
        valued_(at, region, keys_of(changes.layers)) {}

  void run(EditBuilder& builder) const {
    MoveTable moves;
    for (const VertexMove& move : changes_.moves) {
      moves.emplace(move.key.packed(), &move);
      if (move.from != move.to && move.key.where == VertexKey::Where::corner)
        builder.edit().pages.corners.emplace(CornerId(move.key.id), move.to);
    }
    std::set<ChartId> with_values = valued_.charts(), only_moved = moved_.charts();
    for (const LayerEdit& layer : changes_.layers)
      for (const auto& [id, values] : layer.in_charts) with_values.insert(id);
    for (const ChartId id : with_values) only_moved.erase(id);
    recode({only_moved.begin(), only_moved.end()}, false, moves, builder);
    recode({with_values.begin(), with_values.end()}, true, moves, builder);
  }

 private:
  void recode(std::vector<ChartId> ids, bool values_changed, const MoveTable& moves, EditBuilder& builder) const {
    std::erase_if(ids, [&](ChartId id) { return changes_.recut.contains(id); });
    ChartLoader loader(at_);
    std::vector<LoadedChart> loaded = loader.load(ids, threads_, nullptr, values_changed);
    std::vector<RecodedChart> recoded(loaded.size());
    const ChartRecoder recoder(at_, coder_of(at_), moves, changes_.layers);
    parallel_for(loaded.size(), threads_, [&](std::size_t i) {
      recoded[i] = recoder.run(std::move(loaded[i]), moved_.charts().contains(ids[i]), values_changed);
    });
    for (RecodedChart& chart : recoded) builder.add_chart(std::move(chart));
    for (const auto& [id, wire] : loader.wires()) {
      const bool of_recut =
          std::ranges::any_of(wire.entry.charts, [&](ChartId c) { return changes_.recut.contains(c); });
      if (!of_recut && moved_.wires().contains(id) && !builder.edit().pages.wires.contains(id))
        recode_wire(wire, moves, builder);
    }
  }

  const Snapshot::Impl& at_;
  const ChangeSet& changes_;
  unsigned threads_;
  Touched moved_, valued_;
};

}  // namespace

EncodedEdit encode_edit(const Snapshot::Impl& at, RegionMesh region, EditedRegion edited,
                        const std::function<bool(ChartId)>& may_recut, unsigned threads) {
  std::set<ChartId> neighbours;
  for (;;) {  // ends: each round takes one more chart in
    ChangeSet changes = changes_of(at, region, edited);
    changes.recut.insert(neighbours.begin(), neighbours.end());
    EditBuilder builder(at);
    InPlaceEncoder(at, region, changes, threads).run(builder);
    if (changes.recut.empty()) return builder.finish();
    const auto more = encode_recut(at, region, edited, changes, may_recut, threads, builder);
    if (!more) return builder.finish();
    neighbours.insert(*more);
    if (std::ranges::binary_search(region.charts, *more)) continue;
    RegionPart larger{&at, region.charts};
    larger.charts.insert(std::ranges::upper_bound(larger.charts, *more), *more);
    const RegionMesh grown = load_region(std::span(&larger, 1), threads, nullptr, true);
    edited = transferred(edited, region, grown);
    region = grown;
  }
}

EncodedEdit encode_again(const Snapshot::Impl& at, codec::Profile profile, const codec::CoderTables& tables,
                         unsigned threads, const std::function<void(double)>& progress) {
  constexpr std::size_t kBatch = 256;  // charts in memory at a time
  EditBuilder builder(at);
  MeshRecord& record = builder.record();
  record.profile = profile;
  record.table = TableId();
  record.table_version = VersionId();
  record.table_bytes -= at.table_bytes();
  if (!(tables == codec::CoderTables{})) {
    record.table = record.next_table;
    record.next_table = TableId(record.table.value + 1);
    Buffer blob = codec::encode_tables(tables);
    record.table_bytes += blob.size() + kBlobOverhead;
    builder.add_blob(db::Kind::table, record.table.value, std::move(blob));
  }
  const std::vector<ChartId> ids = at.pages().all_charts();
  const MoveTable no_moves;
  const ChartRecoder recoder(at, {profile, tables, record.table, true}, no_moves, {});
  for (std::size_t first = 0; first < ids.size(); first += kBatch) {
    progress(static_cast<double>(first) / static_cast<double>(ids.size()));
    const auto batch = std::span(ids).subspan(first, std::min(kBatch, ids.size() - first));
    std::vector<LoadedChart> loaded = ChartLoader(at).load(batch, threads, nullptr, true);
    std::vector<RecodedChart> recoded(loaded.size());
    parallel_for(loaded.size(), threads,
                 [&](std::size_t i) { recoded[i] = recoder.run(std::move(loaded[i]), true, false); });
    for (RecodedChart& chart : recoded) builder.add_chart(std::move(chart));
  }
  return builder.finish();
}

}  // namespace ramcdb::detail
