#include "api/commit.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "api/locks.h"
#include "api/page_rewriter.h"
#include "api/store_format.h"
#include "api/version_figures.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

double distance(const VertexMove& move) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (move.target[a] - move.position[a]) * (move.target[a] - move.position[a]);
  return std::sqrt(sum);
}

const Snapshot::Impl& newest(std::span<const RegionPart> parts) {
  return *std::max_element(parts.begin(), parts.end(), [](const RegionPart& a, const RegionPart& b) {
            return a.at->version() < b.at->version();
          })->at;
}

const db::MeshRoot* root_of(const std::vector<db::MeshRoot>& roots, MeshId mesh) {
  const auto it = std::find_if(roots.begin(), roots.end(), [&](const db::MeshRoot& r) { return r.mesh == mesh; });
  return it == roots.end() ? nullptr : &*it;
}

/// Whether only `mine` wrote what a chart now has other than before.
bool is_work_of(VersionId mine, const ChartState& was, const ChartState& is) {
  if (was.size() != is.size()) return false;
  for (std::size_t i = 0; i < is.size(); ++i)
    if (is[i] != was[i] && is[i] != mine) return false;
  return true;
}

/// The charts that `version` holds in a state other than the region's, or than the one that `mine` wrote.
std::vector<ChartId> charts_other_than(std::span<const RegionPart> parts, VersionId version, VersionId mine) {
  const Snapshot::Impl& base = newest(parts);
  const auto roots = base.store().roots(version);
  const db::MeshRoot* root = root_of(roots, base.root().mesh);
  if (!root)
    throw Error(Errc::conflict, fmt::format("version {} does not hold mesh {}", version.value, base.root().name));
  const PageIndex there(base.store_handle(), *root);
  std::vector<ChartId> others;
  for (const RegionPart& part : parts) {
    if (*root == part.at->root()) continue;
    for (const ChartId id : part.charts) {
      const auto before = part.at->pages().leaf_of(id), now = there.leaf_of(id);
      const ChartState was = state_of(*find_chart(*before->leaf, id));
      const ChartState is = now ? state_of(*find_chart(*now->leaf, id)) : ChartState{};
      if (is != was && !(mine && is_work_of(mine, was, is))) others.push_back(id);
    }
  }
  std::sort(others.begin(), others.end());
  return others;
}

std::size_t position_of(const std::vector<ChartId>& charts, ChartId id) {
  return static_cast<std::size_t>(std::lower_bound(charts.begin(), charts.end(), id) - charts.begin());
}

CommitReport report_for(const ChangeReport& change, const EncodedEdit& edit) {
  CommitReport report;
  report.charts_touched = change.charts_touched.size();
  report.values_changed = change.values_changed;
  report.wires_reencoded = static_cast<std::uint64_t>(std::count_if(
      edit.wires.begin(), edit.wires.end(), [](const auto& w) { return w.second.base.inner_points > 0; }));
  for (const auto& [id, chart] : edit.charts) {
    report.charts_reencoded += !chart.blob.empty();
    report.layers_reencoded += chart.layers.size();
    report.ranges_expanded += chart.expanded_range;
  }
  report.vertices_moved = change.vertices_moved;
  report.max_displacement = change.max_displacement;
  return report;
}

/// Puts the blobs of an edit and lets the record's totals follow.
void put_edit(const EncodedEdit& edit, MeshId mesh, db::Writer& writer, MeshRecord& record) {
  for (const auto& [id, chart] : edit.charts) {
    for (const RecodedLayer& layer : chart.layers) {
      record.bytes_of_layer(layer.layer) += layer.blob.size() + kBlobOverhead - layer.bytes_before;
      writer.put({db::Kind::attribute, mesh, id.value, {}, layer.layer}, layer.blob);
    }
    if (chart.blob.empty()) continue;
    writer.put({db::Kind::chart, mesh, id.value, {}, 0}, chart.blob);
    record.chart_cost.header += chart.cost.header - chart.cost_before.header;
    record.chart_cost.connectivity += chart.cost.connectivity - chart.cost_before.connectivity;
    record.chart_cost.geometry += chart.cost.geometry - chart.cost_before.geometry;
  }
  for (const auto& [id, wire] : edit.wires) record.wire_bytes -= wire.bytes_before;
  for (const auto& [first, group] : edit.wire_groups) {
    record.wire_bytes += group.size() + kBlobOverhead;
    writer.put({db::Kind::wire, mesh, first.value, {}, 0}, group);
  }
}

/// Puts the tables of another way of coding, and has the record name them.
void put_coding(const NewCoding& coding, MeshId mesh, db::Writer& writer, MeshRecord& record) {
  record.profile = coding.profile;
  record.table = coding.table;
  record.table_version = coding.table ? writer.version() : VersionId();
  record.table_bytes -= coding.table_bytes_before;
  if (!coding.table) return;
  record.next_table = TableId(coding.table.value + 1);
  record.table_bytes += coding.tables.size() + kBlobOverhead;
  writer.put({db::Kind::table, mesh, coding.table.value, {}, 0}, coding.tables);
}

db::ChangedCharts changed_charts(MeshId mesh, const EncodedEdit& edit) {
  db::ChangedCharts changed{mesh, {}};
  for (const auto& [id, chart] : edit.charts) changed.charts.push_back(id);
  return changed;
}

std::string figures_of(const CommitReport& report, std::string_view operation, std::size_t charts) {
  VersionFigures figures;
  figures.operation = operation;
  figures.charts_touched = charts;
  figures.vertices_moved = report.vertices_moved;
  figures.max_displacement = report.max_displacement;
  figures.bytes_written = report.bytes_written;
  return encode_figures(figures);
}

/// How many values changed in each chart; those of shared vertices count in every chart of the region.
std::map<ChartId, std::uint64_t> values_by_chart(const RegionMesh& region, std::span<const LayerEdit> layers) {
  std::map<ChartId, std::uint64_t> counts;
  std::set<std::uint64_t> vertices;
  for (const LayerEdit& layer : layers) {
    for (const auto& [chart, values] : layer.in_charts) counts[chart] += values.size();
    for (const auto& [key, value] : layer.at_vertices) {
      const VertexKey vertex = VertexKey::unpack(key);
      if (vertex.where == VertexKey::Where::chart)
        ++counts[ChartId(vertex.id)];
      else
        vertices.insert(key);
    }
  }
  if (vertices.empty()) return counts;
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::size_t f = 0; f < region.faces.size(); ++f)
    for (const std::uint32_t v : region.faces[f])
      if (vertices.contains(region.keys[v].packed()) && seen.insert({region.chart_of_face[f], v}).second)
        ++counts[region.charts[region.chart_of_face[f]]];
  return counts;
}

}  // namespace

ChangeReport describe_edit(const RegionMesh& region, const Edit& edit) {
  const std::vector<VertexMove>& moves = edit.moves;
  ChangeReport report;
  std::map<std::uint64_t, const VertexMove*> by_key;
  double squares = 0;
  for (const VertexMove& move : moves) {
    by_key.emplace(move.key.packed(), &move);
    const double d = distance(move);
    report.max_displacement = std::max(report.max_displacement, d);
    squares += d * d;
  }
  report.vertices_moved = moves.size();
  if (!moves.empty()) report.rms_displacement = std::sqrt(squares / static_cast<double>(moves.size()));

  std::vector<const VertexMove*> move_of(region.keys.size(), nullptr);
  if (!moves.empty())
    for (std::size_t v = 0; v < region.keys.size(); ++v)
      if (const auto it = by_key.find(region.keys[v].packed()); it != by_key.end()) {
        move_of[v] = it->second;
        report.border_vertices_moved += region.outer_border[v];
      }
  std::vector<std::set<std::uint32_t>> moved_in(region.charts.size());
  for (std::size_t f = 0; f < region.faces.size(); ++f)
    for (const std::uint32_t v : region.faces[f])
      if (move_of[v]) moved_in[region.chart_of_face[f]].insert(v);
  for (std::uint32_t v = 0; v < region.keys.size(); ++v)  // isolated vertices are in no face
    if (move_of[v] && region.keys[v].where == VertexKey::Where::chart)
      moved_in[position_of(region.charts, ChartId(region.keys[v].id))].insert(v);
  const std::map<ChartId, std::uint64_t> values = values_by_chart(region, edit.layers);
  for (const LayerEdit& layer : edit.layers) report.values_changed += layer.count();
  for (std::size_t c = 0; c < region.charts.size(); ++c) {
    const auto changed = values.find(region.charts[c]);
    if (moved_in[c].empty() && changed == values.end()) continue;
    ChangeReport::ChartChange change{region.charts[c], moved_in[c].size(), 0,
                                     changed == values.end() ? 0 : changed->second};
    for (const std::uint32_t v : moved_in[c])
      change.max_displacement = std::max(change.max_displacement, distance(*move_of[v]));
    report.per_chart.push_back(change);
    report.charts_touched.push_back(region.charts[c]);
  }
  return report;
}

void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch) {
  const Snapshot::Impl& base = newest(parts);
  report.base = base.version();
  report.tip = base.store().resolve(branch);
  report.changed_by_others = charts_other_than(parts, report.tip, {});
  std::set_intersection(report.changed_by_others.begin(), report.changed_by_others.end(), report.charts_touched.begin(),
                        report.charts_touched.end(), std::back_inserter(report.conflicts));
}

std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version) {
  return charts_other_than(parts, version, version);
}

std::string attempt_name(std::string_view nonce, std::string_view branch, const Edit& edit) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  XXH3_128bits_update(&state, nonce.data(), nonce.size());
  XXH3_128bits_update(&state, branch.data(), branch.size());
  const auto add = [&](std::uint64_t number) { XXH3_128bits_update(&state, &number, sizeof number); };
  const auto add_value = [&](const CodedValue& value) {
    add(value.absent);
    for (const std::uint64_t number : value.numbers) add(number);
  };
  for (const VertexMove& move : edit.moves) {
    add(move.key.packed());
    for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(move.target[axis]));
  }
  for (const LayerEdit& layer : edit.layers) {
    add(layer.layer.id);
    for (const auto& [key, value] : layer.at_vertices) add(key), add_value(value);
    for (const auto& [chart, values] : layer.in_charts)
      for (const auto& [index, value] : values) add(chart.value), add(index), add_value(value);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

void publish_edit(const Snapshot::Impl& base, const EncodedEdit& edit, const CommitOptions& options,
                  std::string_view operation, const std::string& attempt, CommitReport& report) {
  const auto writer = base.store().writer();
  const VersionId tip = writer->tip(options.branch);
  db::CommitInfo info;
  info.roots = base.store().roots(tip);
  const db::MeshRoot* found = root_of(info.roots, base.root().mesh);
  if (!found)
    throw Error(Errc::conflict, fmt::format("mesh {} is not on branch {}", base.root().name, options.branch),
                fmt::format("version {}", tip.value), "commit to the branch that you checked out from");
  const Snapshot::Impl at_tip(base.store_handle(), tip, *found);
  report.conflicts = find_conflicts(at_tip.pages(), edit);
  if (!report.conflicts.empty()) return;
  const db::ChangedCharts changed = changed_charts(base.root().mesh, edit);
  if (!options.ignore_locks) refuse_locked(base.store(), changed.mesh, changed.charts, options.author);

  MeshRecord record = at_tip.record();
  put_edit(edit, base.root().mesh, *writer, record);
  if (edit.coding) put_coding(*edit.coding, base.root().mesh, *writer, record);
  const db::MeshRoot moved = rewrite_pages(at_tip.pages(), edit, *writer, record);
  writer->put({db::Kind::mesh_record, base.root().mesh, 1, {}, 0}, encode_record(record));
  for (db::MeshRoot& root : info.roots)
    if (root.mesh == moved.mesh) root = moved;
  info.branch = options.branch;
  info.expected_tip = tip;
  info.parents = {tip};
  info.author = options.author;
  info.message = options.message;
  info.attempt = attempt;
  info.changed = {changed};
  report.parent = tip;
  report.bytes_written = writer->bytes_put();
  info.figures = figures_of(report, operation, edit.charts.size());
  report.revision = writer->publish(info);
}

CommitReport commit_edit(std::span<const RegionPart> parts, const ChangeReport& change, const Edit& edit,
                         const CommitOptions& options, const std::string& attempt) {
  const auto start = std::chrono::steady_clock::now();
  const Snapshot::Impl& base = newest(parts);
  CommitReport report;
  if (edit.empty()) {
    report.nothing_changed = true;
    report.revision = report.parent = base.version();
  } else if (const auto published = base.store().published_by(attempt)) {
    report.revision = *published;
    report.vertices_moved = change.vertices_moved;
    report.values_changed = change.values_changed;
    report.max_displacement = change.max_displacement;
    report.charts_touched = change.charts_touched.size();
    const auto parents = base.store().version(*published).parents;
    if (!parents.empty()) report.parent = parents.front();
  } else {
    const EncodedEdit encoded = encode_edit(parts, edit, options.threads);
    report = report_for(change, encoded);
    publish_edit(base, encoded, options, "commit", attempt, report);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
