#include <algorithm>
#include <deque>

#include "api/change_figures.h"
#include "api/commit.h"

namespace ramcdb::detail {
namespace {

/// The charts that an edit's faces count in: new faces in that of the faces which they replace, or else in that of the
/// faces beside them.
class ChartsOfEdit {
 public:
  explicit ChartsOfEdit(const PendingEdit& edit)
      : edit_(edit),
        region_(edit.region),
        mesh_(edit.edited.mesh),
        chart_at_(mesh_.points.size(), kNew),
        chart_of_(mesh_.faces.size(), kNew) {}

  FaceCharts run() {
    take_old_faces();
    take_vertices();
    spread();
    FaceCharts charts;
    for (const std::uint32_t chart : region_.chart_of_face) charts.before.push_back(region_.charts[chart]);
    for (const std::uint32_t chart : chart_of_)
      charts.after.push_back(chart == kNew ? leftover() : region_.charts[chart]);
    return charts;
  }

 private:
  void take_old_faces() {
    const std::vector<std::uint32_t>& source = edit_.edited.face_source;
    for (std::uint32_t f = 0; f < source.size(); ++f)
      if (source[f] != kNew) chart_of_[f] = region_.chart_of_face[source[f]];
  }

  void take_vertices() {
    std::vector<std::uint32_t> of_region(region_.points.size(), kNew);
    const auto take = [&](std::uint32_t f) {
      for (const std::uint32_t v : region_.faces[f])
        if (of_region[v] == kNew) of_region[v] = region_.chart_of_face[f];
    };
    for (const std::uint32_t f : edit_.changes.faces_gone) take(f);
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      if (edit_.changes.recut.contains(region_.charts[region_.chart_of_face[f]])) take(f);
    for (std::uint32_t v = 0; v < chart_at_.size(); ++v)
      if (const std::uint32_t source = edit_.edited.vertex_source[v]; source != kNew) chart_at_[v] = of_region[source];
  }

  /// From vertices whose chart is known over the new faces.
  void spread() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> faces_at;
    for (const std::uint32_t f : edit_.changes.faces_new)
      for (const std::uint32_t v : mesh_.faces[f]) faces_at.emplace_back(v, f);
    std::ranges::sort(faces_at);
    std::deque<std::uint32_t> known;
    for (const auto& [v, f] : faces_at)
      if (chart_at_[v] != kNew && (known.empty() || known.back() != v)) known.push_back(v);
    for (; !known.empty(); known.pop_front()) {
      const std::uint32_t chart = chart_at_[known.front()];
      auto at = std::ranges::lower_bound(faces_at, std::pair(known.front(), 0U));
      for (; at != faces_at.end() && at->first == known.front(); ++at) {
        if (chart_of_[at->second] != kNew) continue;
        chart_of_[at->second] = chart;
        for (const std::uint32_t v : mesh_.faces[at->second])
          if (chart_at_[v] == kNew) {
            chart_at_[v] = chart;
            known.push_back(v);
          }
      }
    }
  }

  /// Of a new component.
  [[nodiscard]] ChartId leftover() const {
    return edit_.changes.recut.empty() ? region_.charts.front() : *edit_.changes.recut.begin();
  }

  const PendingEdit& edit_;
  const RegionMesh& region_;
  const RegionMesh& mesh_;
  std::vector<std::uint32_t> chart_at_, chart_of_;  ///< positions in the region's charts
};

}  // namespace

ChangeReport describe_edit(const PendingEdit& edit) {
  ChangeReport report;
  report.notes = edit.notes;
  if (edit.parts.empty() || edit.region.charts.empty()) return report;
  MeasuredChange measured =
      measure_change(edit.base(), edit.region, edit.edited, edit.changes, ChartsOfEdit(edit).run());
  static_cast<ChangeFigures&>(report) = measured.total;
  for (const VertexMove& move : edit.changes.moves)
    report.border_vertices_moved += edit.region.outer_border[move.vertex];
  for (ChartChange& change : measured.per_chart)
    if (!change.clean() || edit.changes.touched.contains(change.chart)) report.per_chart.push_back(change);
  for (const ChartChange& change : report.per_chart) report.charts_touched.push_back(change.chart);
  return report;
}

}  // namespace ramcdb::detail
