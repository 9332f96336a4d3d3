#include "api/diff.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/change_figures.h"
#include "api/chart_difference.h"
#include "api/heatmap.h"
#include "api/region_query.h"
#include "api/version_edit.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::vector<ChartId> united(std::vector<ChartId> a, const std::vector<ChartId>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::ranges::sort(a);
  return a;
}

/// What differs between two versions: these charts of the first one, of the second one, and these as an edit of those.
class VersionComparison {
 public:
  VersionComparison(const Snapshot::Impl& from, const Snapshot::Impl& to, const ChartDifference& charts,
                    unsigned threads, ReadCost& cost)
      : from_(from), to_(to) {
    std::vector<ChartId> before = united(charts.changed, charts.removed), after = united(charts.changed, charts.added);
    std::vector<ChartId> equal;
    if (before.empty()) {  // there is no region of no chart: one that both have stands in
      equal = {from.pages().all_charts().front()};
      before = equal;
      after = united(after, before);
    }
    before_ = load(from, before, threads, cost);
    after_ = load(to, after, threads, cost);
    edited_ = mesh_as_edit(from, before_, after_, equal);
    changes_ = differences_of(from, before_, edited_);
    drop_shared_with_outside();
  }

  [[nodiscard]] MeasuredChange measure() const {
    return measure_change(from_, before_, edited_, changes_, face_charts());
  }

  [[nodiscard]] Heat heat() && {
    Heat heat{std::move(after_), displacements_of(edited_, changes_), {}};
    heat.is_new.assign(heat.mesh.faces.size(), false);
    for (const std::uint32_t f : changes_.faces_new) heat.is_new[f] = true;
    return heat;
  }

 private:
  static RegionMesh load(const Snapshot::Impl& at, const std::vector<ChartId>& charts, unsigned threads,
                         ReadCost& cost) {
    const RegionPart part{&at, charts};
    return load_region(std::span(&part, 1), threads, &cost, true);
  }

  /// A vertex that charts have which do not differ was there and is there.
  void drop_shared_with_outside() {
    drop_shared(from_, before_, changes_.vertices_gone);
    drop_shared(to_, after_, changes_.vertices_new);
  }

  static void drop_shared(const Snapshot::Impl& at, const RegionMesh& region, std::vector<std::uint32_t>& vertices) {
    CornerPlaces corners;
    for (const std::uint32_t v : vertices)
      if (region.keys[v].where == VertexKey::Where::corner) corners.emplace(region.keys[v].id, region.points[v]);
    const auto around = charts_at_corners(at, corners);
    std::erase_if(vertices, [&](std::uint32_t v) {
      if (region.outer_border[v] || region.keys[v].where != VertexKey::Where::corner)
        return bool{region.outer_border[v]};
      return !std::ranges::all_of(around.at(CornerId(region.keys[v].id)),
                                  [&](ChartId id) { return std::ranges::binary_search(region.charts, id); });
    });
  }

  [[nodiscard]] FaceCharts face_charts() const {
    FaceCharts charts;
    for (const std::uint32_t chart : before_.chart_of_face) charts.before.push_back(before_.charts[chart]);
    for (std::uint32_t f = 0; f < after_.faces.size(); ++f) {
      charts.after.push_back(after_.charts[after_.chart_of_face[f]]);
      if (edited_.face_source[f] != kNew) charts.before[edited_.face_source[f]] = charts.after.back();
    }
    return charts;
  }

  const Snapshot::Impl& from_;
  const Snapshot::Impl& to_;
  RegionMesh before_, after_;
  EditedRegion edited_;
  ChangeSet changes_;
};

/// The same over all charts of the newer version.
Heat over_all(const Snapshot::Impl& at, const Heat& changed, unsigned threads) {
  const RegionPart part{&at, at.pages().all_charts()};
  Heat heat{load_region(std::span(&part, 1), threads), {}, {}};
  std::unordered_map<std::uint64_t, double> by;
  for (std::size_t v = 0; v < changed.displacement.size(); ++v)
    if (changed.displacement[v] > 0) by.emplace(changed.mesh.keys[v].packed(), changed.displacement[v]);
  for (const VertexKey& key : heat.mesh.keys) {
    const auto it = by.find(key.packed());
    heat.displacement.push_back(it == by.end() ? 0 : it->second);
  }
  heat.is_new.assign(heat.mesh.faces.size(), false);
  for (std::size_t f = 0, g = 0; f < changed.mesh.faces.size(); ++f, ++g) {
    const ChartId chart = changed.mesh.charts[changed.mesh.chart_of_face[f]];
    while (heat.mesh.charts[heat.mesh.chart_of_face[g]] != chart) ++g;
    heat.is_new[g] = changed.is_new[f];
  }
  return heat;
}

void require_same_mesh(const Snapshot::Impl& from, const Snapshot::Impl& to) {
  if (from.root().mesh != to.root().mesh || !(from.record().lattice == to.record().lattice))
    throw Error(Errc::invalid_argument, "these versions do not hold the same mesh",
                fmt::format("{} and {}", from.root().name, to.root().name), "name one mesh with --mesh");
}

}  // namespace

DiffReport diff_versions(const Snapshot::Impl& from, const Snapshot::Impl& to, const DiffOptions& options) {
  require_same_mesh(from, to);
  if (!options.heatmap.empty()) require_heatmap_file(options.heatmap);
  DiffReport report;
  report.from = from.version();
  report.to = to.version();
  ReadCost cost;
  ChartDifference charts = chart_difference(from.pages(), to.pages(), &cost);
  const bool differ = !charts.changed.empty() || !charts.added.empty() || !charts.removed.empty();
  Heat heat;
  if (differ) {
    VersionComparison comparison(from, to, charts, options.threads, cost);
    const MeasuredChange measured = comparison.measure();
    static_cast<ChangeFigures&>(report) = measured.total;
    const std::vector<ChartId> listed = united(united(charts.changed, charts.added), charts.removed);
    std::ranges::copy_if(measured.per_chart, std::back_inserter(report.per_chart),
                         [&](const ChartChange& change) { return std::ranges::binary_search(listed, change.chart); });
    if (!options.heatmap.empty()) heat = std::move(comparison).heat();
  }
  if (!options.heatmap.empty()) {
    if (options.heatmap_of_all) heat = over_all(to, heat, options.threads);
    write_heatmap(to, heat, report.max_displacement, options.heatmap);
  }
  report.changed = std::move(charts.changed);
  report.added = std::move(charts.added);
  report.removed = std::move(charts.removed);
  report.bytes_read = cost.bytes;
  report.blobs_read = cost.blobs;
  report.pages_read = cost.pages;
  return report;
}

}  // namespace ramcdb::detail
