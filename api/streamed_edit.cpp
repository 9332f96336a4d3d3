#include "api/streamed_edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/locks.h"
#include "api/page_rewriter.h"
#include "api/store_format.h"
#include "api/version_figures.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// What an edit makes of the index pages of a tip. Throws conflict where others cut a wire meanwhile that it moves.
PageDelta pages_of(const PageIndex& tip, const SpooledEdit& edit) {
  PageDelta pages;
  pages.corners.insert(edit.corners.begin(), edit.corners.end());
  for (const auto& [id, spooled] : edit.charts) {
    const auto ref = tip.leaf_of(id);
    PageChart& chart = pages.charts[id] = *find_chart(*ref->leaf, id);
    for (const SpooledLayer& layer : spooled.layers)
      std::ranges::find(chart.layers, layer.layer, &LayerRef::layer)->version = VersionId();
    for (const WireLoop& loop : chart.loops)
      for (const DirectedWire step : loop)
        if (const auto wire = edit.wires.find(step.wire); wire != edit.wires.end()) {
          PageWire& put = pages.wires[step.wire] = *find_wire(*ref->leaf, step.wire);
          put.version = VersionId();
          put.group = wire->second.group;
          pages.neighbours.insert(put.charts.begin(), put.charts.end());
        }
    if (!spooled.blob) continue;
    chart.version = VersionId();
    chart.table = spooled.table;
    chart.box = spooled.box;
  }
  if (pages.wires.size() != edit.wires.size())
    throw Error(Errc::conflict, "others cut the borders of these charts anew meanwhile", {}, "repeat the edit");
  return pages;
}

/// Puts the blobs of an edit and lets the record's totals follow.
class BlobStreamer {
 public:
  BlobStreamer(const SpooledEdit& edit, MeshId mesh, std::uint64_t memory, db::Writer& writer, MeshRecord& record)
      : edit_(edit), mesh_(mesh), memory_(memory), writer_(writer), record_(record) {}

  void run(const std::function<void(double)>& progress) {
    std::size_t done = 0;
    for (const auto& [id, chart] : edit_.charts) {
      progress(static_cast<double>(done++) / static_cast<double>(edit_.charts.size()));
      put_chart(id, chart);
    }
    for (const auto& [id, wire] : edit_.wires) record_.wire_bytes -= wire.bytes_before;
    for (const auto& [first, blob] : edit_.wire_groups) {
      record_.wire_bytes += blob.size + kBlobOverhead;
      put({db::Kind::wire, mesh_, first.value, {}, 0}, blob);
    }
  }

 private:
  void put_chart(ChartId id, const SpooledChart& chart) {
    for (const SpooledLayer& layer : chart.layers) {
      record_.bytes_of_layer(layer.layer) += layer.blob.size + kBlobOverhead - layer.bytes_before;
      put({db::Kind::attribute, mesh_, id.value, {}, layer.layer}, layer.blob);
    }
    if (!chart.blob) return;
    put({db::Kind::chart, mesh_, id.value, {}, 0}, *chart.blob);
    record_.chart_cost.header += chart.cost.header - chart.cost_before.header;
    record_.chart_cost.connectivity += chart.cost.connectivity - chart.cost_before.connectivity;
    record_.chart_cost.geometry += chart.cost.geometry - chart.cost_before.geometry;
  }

  void put(const db::BlobKey& key, const SpooledBlob& blob) {
    writer_.put(key, edit_.file.read(blob.begin, blob.size));
    if ((held_ += blob.size) < memory_) return;
    writer_.flush();
    held_ = 0;
  }

  const SpooledEdit& edit_;
  MeshId mesh_;
  std::uint64_t memory_, held_ = 0;
  db::Writer& writer_;
  MeshRecord& record_;
};

std::vector<ChartId> conflicts_with(const PageIndex& tip, const SpooledEdit& edit) {
  std::vector<ChartId> conflicts;
  for (const auto& [id, chart] : edit.charts) {
    const auto ref = tip.leaf_of(id);
    if (!ref || state_of(*find_chart(*ref->leaf, id)) != chart.base) conflicts.push_back(id);
  }
  return conflicts;
}

CommitReport report_for(const SpooledEdit& edit) {
  CommitReport report;
  report.charts_touched = edit.charts_touched;
  report.vertices_moved = edit.vertices_moved;
  report.max_displacement = edit.max_displacement;
  report.ranges_expanded = edit.ranges_expanded;
  for (const auto& [id, chart] : edit.charts) {
    report.charts_reencoded += chart.blob.has_value();
    report.layers_reencoded += chart.layers.size();
  }
  report.wires_reencoded = static_cast<std::uint64_t>(
      std::ranges::count_if(edit.wires, [](const auto& wire) { return wire.second.inner_points > 0; }));
  return report;
}

db::ChangedCharts changed_charts_of(MeshId mesh, const SpooledEdit& edit) {
  db::ChangedCharts changed{mesh, {}};
  for (const auto& [id, chart] : edit.charts) changed.charts.push_back(id);
  return changed;
}

/// The attributes with normals that an edit leaves as they were, and that then do not fit the surface.
std::vector<std::string> normals_left(const LayerTable& table, const StreamedMoves& moves) {
  std::vector<std::string> names;
  if (moves.normals_still_fit) return names;
  for (const Layer& layer : table.layers)
    if (layer.info.meaning == Meaning::normal && !(moves.turner && holds_turnable_normals(layer)))
      names.push_back(layer.info.name);
  return names;
}

/// Puts the mesh at the tip with the edit on it; returns its new root.
db::MeshRoot put_on_tip(const Snapshot::Impl& tip, const SpooledEdit& edit, std::uint64_t memory, db::Writer& writer,
                        const std::function<void(double)>& progress) {
  MeshRecord record = tip.record();
  db::MeshRoot root = tip.root();
  BlobStreamer(edit, root.mesh, memory, writer, record).run(progress);
  root = rewrite_pages(tip.pages(), pages_of(tip.pages(), edit), writer, record);
  writer.put({db::Kind::mesh_record, root.mesh, 1, {}, 0}, encode_record(record));
  return root;
}

void publish_streamed(const Snapshot::Impl& base, const SpooledEdit& edit, std::uint64_t memory,
                      const CommitOptions& options, std::string_view operation,
                      const std::function<void(double)>& progress, CommitReport& report) {
  const auto writer = base.store().writer();
  const VersionId tip = writer->tip(options.branch);
  db::CommitInfo info;
  info.roots = base.store().roots(tip);
  const auto found = std::ranges::find(info.roots, base.root().mesh, &db::MeshRoot::mesh);
  if (found == info.roots.end())
    throw Error(Errc::conflict, fmt::format("mesh {} is not on branch {} any more", base.root().name, options.branch),
                fmt::format("version {}", tip.value), "repeat the edit on a branch that holds it");
  const Snapshot::Impl at_tip(base.store_handle(), tip, *found);
  report.conflicts = conflicts_with(at_tip.pages(), edit);
  if (!report.conflicts.empty()) return;
  const db::ChangedCharts changed = changed_charts_of(base.root().mesh, edit);
  if (!options.ignore_locks) refuse_locked(base.store(), changed.mesh, changed.charts, options.author);
  *found = put_on_tip(at_tip, edit, memory, *writer, progress);
  info.branch = options.branch;
  info.expected_tip = tip;
  info.parents = {tip};
  info.author = options.author;
  info.message = options.message;
  info.attempt = db::new_attempt_id();
  info.changed = {changed};
  report.parent = tip;
  report.bytes_written = writer->bytes_put();
  info.figures = encode_figures({std::string(operation), edit.charts.size(), report.vertices_moved, 0, 0,
                                 report.max_displacement, report.bytes_written});
  report.revision = writer->publish(info);
}

}  // namespace

CommitReport commit_streamed(const Snapshot::Impl& at, const StreamedMoves& moves, const CommitOptions& options,
                             std::string_view operation) {
  const auto stage = [&](const char* name) {
    return [&options, name](double done) {
      if (options.progress) options.progress(name, done);
    };
  };
  const SpooledEdit edit = encode_streamed(at, moves, options.threads, stage("encode"));
  CommitReport report = report_for(edit);
  report.revision = report.parent = at.version();
  report.nothing_changed = edit.charts.empty();
  if (!report.nothing_changed) report.normals_left = normals_left(at.layers(), moves);
  if (!report.nothing_changed) publish_streamed(at, edit, moves.memory, options, operation, stage("write"), report);
  return report;
}

}  // namespace ramcdb::detail
