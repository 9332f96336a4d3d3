#include "api/spooled_edit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_set>

#include "api/chart_loader.h"
#include "api/chart_recoder.h"
#include "api/region_query.h"
#include "chartify/parallel.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {
namespace {

/// What a face takes while its chart is decoded, moved, coded and compared.
constexpr std::uint64_t kCodingBytesPerFace = 400;
/// The same with all its layers.
constexpr std::uint64_t kCodingBytesPerFaceWithLayers = 800;
/// Wires whose points are in memory at a time. Groups end there, so it is no matter of memory.
constexpr std::size_t kWiresAtATime = 1024;

double displacement(const VertexMove& move) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (move.target[a] - move.position[a]) * (move.target[a] - move.position[a]);
  return std::sqrt(sum);
}

/// A chart as an edit left it.
struct ChartWork {
  PageChart base;
  RecodedChart recoded;
  std::vector<VertexMove> shared;  ///< moves of vertices that are not the chart's own
  std::uint64_t own_moves = 0;
  double max_displacement = 0;
};

class Spooler {
 public:
  Spooler(const Snapshot::Impl& at, const StreamedMoves& moves, unsigned threads)
      : at_(at),
        moves_(moves),
        turns_normals_(moves.turner && std::ranges::any_of(at.layers().layers, holds_turnable_normals)),
        threads_(threads),
        edit_(moves.scratch_folder) {}

  SpooledEdit run(const std::function<void(double)>& progress) {
    const std::vector<ChartId> charts = charts_to_code();
    std::size_t done = 0;
    const std::uint64_t per_face = turns_normals_ ? kCodingBytesPerFaceWithLayers : kCodingBytesPerFace;
    for (const auto batch : in_batches(at_, charts, moves_.memory, per_face, threads_)) {
      progress(static_cast<double>(done) / static_cast<double>(charts.size()));
      code(batch);
      done += batch.size();
    }
    code_wires();
    return std::move(edit_);
  }

 private:
  [[nodiscard]] std::vector<ChartId> charts_to_code() const {
    if (!moves_.border_moves) return moves_.region;
    return find_charts(at_, {{OfCharts{moves_.region}}, 1}, nullptr);
  }

  void code(std::span<const ChartId> batch) {
    ChartLoader loader(at_);
    std::vector<LoadedChart> loaded = loader.load(batch, threads_, nullptr, turns_normals_);
    std::vector<ChartWork> works(loaded.size());
    parallel_for(loaded.size(), threads_, [&](std::size_t i) { works[i] = recode(std::move(loaded[i])); });
    for (ChartWork& work : works) {
      note_shared(work, loader);
      note_chart(work);
    }
  }

  [[nodiscard]] ChartWork recode(LoadedChart loaded) const {
    const Lattice& lattice = at_.record().lattice;
    std::vector<VertexMove> moves;
    for (std::size_t v = 0; v < loaded.keys.size(); ++v) {
      const LatticePoint from = loaded.chart.positions[v];
      if (auto move =
              moves_.mover(loaded.keys[v], from, loaded.exact.empty() ? lattice.position(from) : loaded.exact[v]))
        moves.push_back(*move);
    }
    ChartWork work;
    work.base = loaded.entry;
    std::vector<LayerEdit> normals;
    if (turns_normals_) normals = turned_normals(at_, loaded, moves_.turner);
    if (moves.empty() && normals.empty()) return work;
    MoveTable table;
    for (const VertexMove& move : moves) {
      table.emplace(move.key.packed(), &move);
      work.max_displacement = std::max(work.max_displacement, displacement(move));
      if (move.key.where == VertexKey::Where::chart)
        ++work.own_moves;
      else
        work.shared.push_back(move);
    }
    work.recoded =
        ChartRecoder(at_, coder_of(at_), table, normals).run(std::move(loaded), !moves.empty(), !normals.empty());
    return work;
  }

  /// The wires and corners of a chart, unless an earlier chart was on them.
  void note_shared(const ChartWork& work, const ChartLoader& loader) {
    MoveTable table;
    for (const VertexMove& move : work.shared) {
      if (!table.emplace(move.key.packed(), &move).second) continue;
      if (move.key.where == VertexKey::Where::wire && !seen_wires_.contains(WireId(move.key.id)))
        ++edit_.vertices_moved;
      if (move.key.where == VertexKey::Where::corner && seen_corners_.insert(CornerId(move.key.id)).second) {
        ++edit_.vertices_moved;
        if (move.from != move.to) edit_.corners.emplace(CornerId(move.key.id), move.to);
      }
    }
    for (const WireLoop& loop : work.base.loops)
      for (const DirectedWire step : loop)
        if (seen_wires_.insert(step.wire).second) note_wire(loader.wires().at(step.wire), table);
  }

  void note_wire(const LoadedWire& loaded, const MoveTable& table) {
    const PageWire& entry = loaded.entry;
    std::vector<VertexKey> keys{{VertexKey::Where::corner, entry.begin.value, 0}};
    for (std::uint32_t i = 0; i < entry.inner_points; ++i) keys.push_back({VertexKey::Where::wire, entry.id.value, i});
    keys.push_back({VertexKey::Where::corner, entry.end.value, 0});
    std::vector<LatticePoint> points = loaded.wire.points;
    move_points(points, keys, table);
    if (points == loaded.wire.points) return;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(points.data());
    const std::uint64_t begin = edit_.file.append({bytes, points.size() * sizeof(LatticePoint)});
    edit_.wires.emplace(entry.id, SpooledWire{entry.id, entry.inner_points, loaded.blob_bytes, begin});
  }

  void note_chart(ChartWork& work) {
    RecodedChart& recoded = work.recoded;
    const bool moved = work.own_moves > 0 || !work.shared.empty();
    edit_.vertices_moved += work.own_moves;
    edit_.max_displacement = std::max(edit_.max_displacement, work.max_displacement);
    edit_.charts_touched += moved && std::ranges::binary_search(moves_.region, work.base.id);
    if (recoded.blob.empty() && recoded.layers.empty()) return;
    SpooledChart chart;
    chart.base = state_of(work.base);
    if (!recoded.blob.empty()) chart.blob = spool(recoded.blob);
    chart.table = recoded.entry.table;
    chart.box = recoded.entry.box;
    chart.cost_before = recoded.cost_before;
    chart.cost = recoded.cost;
    edit_.ranges_expanded += recoded.expanded_range;
    for (const RecodedLayer& layer : recoded.layers)
      chart.layers.push_back({layer.layer, spool(layer.blob), layer.bytes_before});
    edit_.charts.emplace(work.base.id, std::move(chart));
  }

  SpooledBlob spool(const Buffer& blob) { return {edit_.file.append(blob), blob.size()}; }

  void code_wires() {
    auto next = edit_.wires.begin();
    while (next != edit_.wires.end()) {
      std::vector<WireId> ids;
      std::vector<Wire> wires;
      for (; next != edit_.wires.end() && ids.size() < kWiresAtATime; ++next) {
        if (next->second.inner_points == 0) continue;
        ids.push_back(next->first);
        wires.push_back({std::vector<LatticePoint>(next->second.inner_points + 2)});
        auto* bytes = reinterpret_cast<std::uint8_t*>(wires.back().points.data());
        edit_.file.read(next->second.points, {bytes, wires.back().points.size() * sizeof(LatticePoint)});
      }
      std::vector<codec::WireOfGroup> members;
      for (std::size_t i = 0; i < ids.size(); ++i) members.push_back({ids[i], &wires[i]});
      for (const codec::CodedWireGroup& group : codec::encode_in_groups(members)) {
        for (std::size_t i = 0; i < group.count; ++i) edit_.wires.at(ids[group.first + i]).group = ids[group.first];
        edit_.wire_groups.emplace(ids[group.first], spool(group.blob));
      }
    }
  }

  const Snapshot::Impl& at_;
  const StreamedMoves& moves_;
  bool turns_normals_;
  unsigned threads_;
  SpooledEdit edit_;
  std::unordered_set<WireId> seen_wires_;
  std::unordered_set<CornerId> seen_corners_;
};

}  // namespace

std::vector<std::span<const ChartId>> in_batches(const Snapshot::Impl& at, std::span<const ChartId> charts,
                                                 std::uint64_t memory, std::uint64_t per_face, unsigned threads) {
  const std::size_t most_charts = 4 * static_cast<std::size_t>(std::max(threads, 1U));
  std::vector<std::span<const ChartId>> batches;
  std::size_t begin = 0;
  std::uint64_t bytes = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const auto leaf = at.pages().leaf_of(charts[c]);
    const std::uint64_t more = leaf ? per_face * find_chart(*leaf->leaf, charts[c])->faces : 0;
    if (c > begin && (bytes + more > memory || c - begin == most_charts)) {
      batches.push_back(charts.subspan(begin, c - begin));
      begin = c;
      bytes = 0;
    }
    bytes += more;
  }
  if (begin < charts.size()) batches.push_back(charts.subspan(begin));
  return batches;
}

SpooledEdit encode_streamed(const Snapshot::Impl& at, const StreamedMoves& moves, unsigned threads,
                            const std::function<void(double)>& progress) {
  return Spooler(at, moves, threads).run(progress);
}

}  // namespace ramcdb::detail
