#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "api/commit.h"
#include "api/decimation.h"
#include "api/edited_region_builder.h"
#include "api/repository_impl.h"
#include "api/snapshot_impl.h"
#include "api/value_interpolation.h"
#include "chartify/parallel.h"
#include "ramcdb/built_in_edits.h"
#include "ramcdb/error.h"

namespace ramcdb {
namespace {

using detail::EditedRegion;
using detail::kNew;

/// The faces of a region with fewer of them in each chart: what charts share stays.
class RegionDecimation {
 public:
  RegionDecimation(const Snapshot& base, const RegionMesh& region, double ratio)
      : base_(base), region_(region), ratio_(ratio), first_(region.charts.size() + 1, 0) {
    for (const std::uint32_t chart : region.chart_of_face) ++first_[chart + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  }

  EditedRegion run(unsigned threads, const Progress& progress) {
    const detail::QuietOpenMesh quiet;
    charts_.resize(region_.charts.size());
    parallel_for(
        charts_.size(), threads, [&](std::size_t c) { charts_[c] = decimated(c); },
        [&](double done) {
          if (progress) progress("decimate", done);
        });
    detail::EditedRegionBuilder builder(base_.impl(), region_);
    const std::vector<std::uint32_t> vertex = add_vertices(builder);
    for (std::size_t c = 0; c < charts_.size(); ++c) add_faces(c, vertex, builder);
    EditedRegion edited = builder.finish(region_.attributes);
    keep_values(edited);
    return edited;
  }

 private:
  struct ChartFaces {
    std::vector<Triangle> faces;         ///< by vertices of the region
    std::vector<std::uint32_t> source;   ///< faces of the region
    std::vector<std::uint32_t> removed;  ///< vertices of the region
  };

  [[nodiscard]] ChartFaces decimated(std::size_t chart) const {
    const auto faces = std::span(region_.faces).subspan(first_[chart], first_[chart + 1] - first_[chart]);
    std::vector<std::uint32_t> vertices;
    for (const Triangle& t : faces) vertices.insert(vertices.end(), t.begin(), t.end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Triangle> local(faces.begin(), faces.end());
    for (Triangle& t : local)
      for (std::uint32_t& v : t)
        v = static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
    std::vector<Point> positions;
    std::vector<bool> locked;
    for (const std::uint32_t v : vertices) {
      positions.push_back(base_.position(region_, v));
      locked.push_back(region_.keys[v].where != VertexKey::Where::chart);
    }
    const auto target = static_cast<std::size_t>(std::llround(ratio_ * static_cast<double>(faces.size())));
    const detail::DecimatedFaces fewer = detail::decimate_faces(positions, local, locked, target);
    ChartFaces out;
    for (const Triangle& t : fewer.faces) out.faces.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
    for (const std::uint32_t f : fewer.source_face) out.source.push_back(first_[chart] + f);
    for (std::uint32_t v = 0, k = 0; v < vertices.size(); ++v)
      if (k < fewer.kept.size() && fewer.kept[k] == v)
        ++k;
      else
        out.removed.push_back(vertices[v]);
    return out;
  }

  [[nodiscard]] std::vector<std::uint32_t> add_vertices(detail::EditedRegionBuilder& builder) const {
    std::vector<bool> removed(region_.points.size(), false);
    for (const ChartFaces& chart : charts_)
      for (const std::uint32_t v : chart.removed) removed[v] = true;
    std::vector<std::uint32_t> vertex(region_.points.size(), kNew);
    for (std::uint32_t v = 0; v < vertex.size(); ++v)
      if (!removed[v]) vertex[v] = builder.add_vertex(v, base_.position(region_, v));
    return vertex;
  }

  void add_faces(std::size_t chart, const std::vector<std::uint32_t>& vertex, detail::EditedRegionBuilder& builder) {
    for (std::size_t i = 0; i < charts_[chart].faces.size(); ++i) {
      const Triangle& t = charts_[chart].faces[i];
      const std::uint32_t source = charts_[chart].source[i];
      builder.add_face({vertex[t[0]], vertex[t[1]], vertex[t[2]]}, t == region_.faces[source] ? source : kNew);
      was_.push_back(source);
    }
  }

  /// A face that changed keeps its own values, and those of the corners that stay.
  void keep_values(EditedRegion& edited) const {
    for (std::size_t a = 0; a < region_.attributes.size(); ++a) {
      const Attribute& before = region_.attributes[a];
      if (before.info.of == AttributeOf::vertex) continue;
      const std::size_t per_face = before.info.of == AttributeOf::corner ? 3 : 1;
      for (std::size_t f = 0; f < was_.size(); ++f)
        for (std::size_t i = 0; edited.face_source[f] == kNew && i < per_face; ++i) {
          const std::uint32_t vertex = edited.vertex_source[edited.mesh.faces[f][i]];
          if (per_face == 3 && vertex != region_.faces[was_[f]][i]) continue;
          const std::size_t components = before.info.components;
          std::copy_n(
              before.values.begin() + static_cast<std::ptrdiff_t>((per_face * was_[f] + i) * components), components,
              edited.mesh.attributes[a].values.begin() + static_cast<std::ptrdiff_t>((per_face * f + i) * components));
        }
    }
  }

  const Snapshot& base_;
  const RegionMesh& region_;
  double ratio_;
  std::vector<std::uint32_t> first_;  ///< per chart its first face, and the end of the last
  std::vector<ChartFaces> charts_;
  std::vector<std::uint32_t> was_;  ///< per new face the one of the region that it came from
};

double ratio_of(const DecimateOptions& options, std::size_t faces) {
  const double ratio =
      options.faces ? std::min(1.0, static_cast<double>(*options.faces) / static_cast<double>(faces)) : options.ratio;
  if (!(ratio >= 0 && ratio <= 1))
    throw Error(Errc::invalid_argument, fmt::format("a share of {} of the faces cannot stay", ratio), {},
                "give a ratio from 0 to 1");
  return ratio;
}

}  // namespace

CommitReport Repository::decimate(std::string_view mesh, const Region& region, const DecimateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  (void)ratio_of(options, 1);
  (void)impl_->store_for_writing();
  const Snapshot base = snapshot(mesh, options.commit.branch);
  detail::PendingEdit edit;
  edit.operation = "decimate";
  edit.may_recut_outside = true;
  edit.parts = {{&base.impl(), base.find(region)}};
  edit.region = detail::load_region(edit.parts, options.commit.threads, nullptr, true);
  const double ratio = ratio_of(options, edit.region.faces.size());
  edit.edited = RegionDecimation(base, edit.region, ratio).run(options.commit.threads, options.commit.progress);
  edit.notes.values_interpolated = detail::interpolate_new(edit.region, edit.edited);
  edit.changes = detail::changes_of(base.impl(), edit.region, edit.edited);
  CommitReport report = detail::commit_edit(edit, options.commit,
                                            detail::attempt_name(db::new_attempt_id(), options.commit.branch, edit));
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb
