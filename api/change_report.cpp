#include <algorithm>
#include <cmath>

#include "api/commit.h"

namespace ramcdb::detail {
namespace {

double distance(const VertexMove& move) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (move.target[a] - move.position[a]) * (move.target[a] - move.position[a]);
  return std::sqrt(sum);
}

/// Which charts of a region a vertex stands in is known by its faces, and of isolated ones by their keys.
class ChartChanges {
 public:
  explicit ChartChanges(const PendingEdit& edit) : edit_(edit), region_(edit.region) {}

  std::vector<ChangeReport::ChartChange> run() {
    for (const ChartId id : region_.charts) changes_.push_back({id});
    count_moves();
    count_values();
    for (ChangeReport::ChartChange& change : changes_) change.remeshed = edit_.changes.recut.contains(change.chart);
    std::erase_if(changes_, [](const ChangeReport::ChartChange& c) {
      return c.vertices_moved == 0 && c.values_changed == 0 && !c.remeshed;
    });
    return std::move(changes_);
  }

 private:
  [[nodiscard]] ChangeReport::ChartChange& chart(ChartId id) {
    return changes_[static_cast<std::size_t>(std::ranges::lower_bound(region_.charts, id) - region_.charts.begin())];
  }

  /// Calls `visit` for each chart and vertex in it that is marked, once.
  template <class Visit>
  void for_charts_of(const std::vector<bool>& marked, Visit&& visit) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (std::size_t f = 0; f < region_.faces.size(); ++f)
      for (const std::uint32_t v : region_.faces[f])
        if (marked[v] && seen.insert({region_.chart_of_face[f], v}).second)
          visit(changes_[region_.chart_of_face[f]], v);
    for (std::uint32_t v = 0; v < region_.keys.size(); ++v) {
      if (!marked[v] || region_.keys[v].where != VertexKey::Where::chart) continue;
      ChangeReport::ChartChange& of = chart(ChartId(region_.keys[v].id));
      const auto position = static_cast<std::uint32_t>(&of - changes_.data());
      if (seen.insert({position, v}).second) visit(of, v);
    }
  }

  void count_moves() {
    std::vector<bool> moved(region_.points.size(), false);
    std::vector<double> by(region_.points.size(), 0);
    for (const VertexMove& move : edit_.changes.moves) {
      moved[move.vertex] = true;
      by[move.vertex] = distance(move);
    }
    if (edit_.changes.moves.empty()) return;
    for_charts_of(moved, [&](ChangeReport::ChartChange& of, std::uint32_t v) {
      ++of.vertices_moved;
      of.max_displacement = std::max(of.max_displacement, by[v]);
    });
  }

  /// Those of shared vertices count in every chart of the region.
  void count_values() {
    for (const LayerEdit& layer : edit_.changes.layers) {
      for (const auto& [id, values] : layer.in_charts) chart(id).values_changed += values.size();
      if (layer.at_vertices.empty()) continue;
      std::vector<bool> changed(region_.points.size(), false);
      for (std::uint32_t v = 0; v < changed.size(); ++v)
        changed[v] = layer.at_vertices.contains(region_.keys[v].packed());
      for_charts_of(changed, [](ChangeReport::ChartChange& of, std::uint32_t) { ++of.values_changed; });
    }
  }

  const PendingEdit& edit_;
  const RegionMesh& region_;
  std::vector<ChangeReport::ChartChange> changes_;
};

}  // namespace

ChangeReport describe_edit(const PendingEdit& edit) {
  const ChangeSet& changes = edit.changes;
  ChangeReport report;
  report.notes = edit.notes;
  double squares = 0;
  for (const VertexMove& move : changes.moves) {
    const double d = distance(move);
    report.max_displacement = std::max(report.max_displacement, d);
    squares += d * d;
    report.border_vertices_moved += edit.region.outer_border[move.vertex];
  }
  report.vertices_moved = changes.moves.size();
  if (!changes.moves.empty()) report.rms_displacement = std::sqrt(squares / static_cast<double>(changes.moves.size()));
  report.vertices_added = changes.vertices_new.size();
  report.vertices_removed = changes.vertices_gone.size();
  report.faces_added = changes.faces_new.size();
  report.faces_removed = changes.faces_gone.size();
  for (const LayerEdit& layer : changes.layers) report.values_changed += layer.count();
  report.per_chart = ChartChanges(edit).run();
  for (const ChangeReport::ChartChange& change : report.per_chart) report.charts_touched.push_back(change.chart);
  return report;
}

}  // namespace ramcdb::detail
