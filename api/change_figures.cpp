#include "api/change_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "api/region_mesh.h"

namespace ramcdb::detail {
namespace {

Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double displacement(const VertexMove& move) {
  const Point by = minus(move.target, move.position);
  return std::sqrt(dot(by, by));
}

/// The border of what changed: edges of the faces after a change less those before. While it is empty, the volume
/// between the two does not depend on the point that it is measured from.
class BorderOfChange {
 public:
  /// \param sign -1: of a face before
  void add(std::uint32_t chart, const Triangle& t, int sign) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t u = t[i], v = t[(i + 1) % 3];
      const std::uint64_t edge = (std::uint64_t{std::min(u, v)} << 32) | std::max(u, v);
      if (u != v) edges_.push_back({chart, edge, u < v ? sign : -sign});
    }
  }

  /// The charts whose part of the change has a border of its own.
  [[nodiscard]] std::vector<std::uint32_t> open_charts() {
    std::ranges::sort(edges_);
    std::vector<std::uint32_t> open;
    std::vector<Edge> left;
    for (std::size_t first = 0, end; first < edges_.size(); first = end) {
      const std::uint32_t chart = edges_[first].chart;
      for (end = first; end < edges_.size() && edges_[end].chart == chart;) ++end;
      if (!cancel(std::span(edges_).subspan(first, end - first), left)) open.push_back(chart);
    }
    edges_ = std::move(left);
    return open;
  }
  /// Whether they have none together.
  [[nodiscard]] bool is_closed() {
    for (Edge& e : edges_) e.chart = 0;
    std::ranges::sort(edges_);
    std::vector<Edge> left;
    return cancel(edges_, left);
  }

 private:
  struct Edge {
    std::uint32_t chart = 0;
    std::uint64_t vertices = 0;
    int sign = 0;
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };

  /// Adds to `left` what is left of the edges of a chart, in order; true when that is nothing.
  static bool cancel(std::span<const Edge> edges, std::vector<Edge>& left) {
    const std::size_t before = left.size();
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      Edge sum{edges[i].chart, edges[i].vertices, 0};
      for (end = i; end < edges.size() && edges[end].vertices == sum.vertices;) sum.sign += edges[end++].sign;
      if (sum.sign != 0) left.push_back(sum);
    }
    return left.size() == before;
  }

  std::vector<Edge> edges_;
};

class Measurement {
 public:
  Measurement(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited, const ChangeSet& changes,
              const FaceCharts& charts)
      : region_(region),
        edited_(edited),
        changes_(changes),
        charts_(charts),
        before_(positions_in(region, at.record().lattice)),
        after_(positions_in(edited.mesh, at.record().lattice)),
        by_(displacements_of(edited, changes)) {
    std::vector<ChartId> ids = charts.before;
    ids.insert(ids.end(), charts.after.begin(), charts.after.end());
    ids.insert(ids.end(), region.charts.begin(), region.charts.end());
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const ChartId id : ids) {
      position_.emplace(id, static_cast<std::uint32_t>(out_.per_chart.size()));
      out_.per_chart.push_back({{}, id});
    }
  }

  MeasuredChange run() {
    count_vertices();
    count_faces();
    count_values();
    measure_surface();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t position(ChartId id) const { return position_.at(id); }
  [[nodiscard]] ChartChange& chart(ChartId id) { return out_.per_chart[position(id)]; }

  /// Calls `visit` for each chart and marked vertex in it, once. Isolated vertices are in the chart that their key
  /// names. \param source of each vertex its key's vertex in the region, or kNew
  template <class Source, class Visit>
  void for_charts_of(const std::vector<Triangle>& faces, const std::vector<ChartId>& charts,
                     const std::vector<bool>& marked, Source&& source, Visit&& visit) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> uses;
    std::vector<bool> in_face(marked.size(), false);
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const std::uint32_t v : faces[f])
        if (marked[v]) {
          uses.emplace_back(position(charts[f]), v);
          in_face[v] = true;
        }
    for (std::uint32_t v = 0; v < marked.size(); ++v) {
      const std::uint32_t known = marked[v] && !in_face[v] ? source(v) : kNew;
      if (known == kNew || region_.keys[known].where != VertexKey::Where::chart) continue;
      uses.emplace_back(position(ChartId(region_.keys[known].id)), v);
    }
    std::ranges::sort(uses);
    uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
    for (const auto& [at, v] : uses) visit(out_.per_chart[at], v);
  }

  void count_vertices() {
    ChangeFigures& total = out_.total;
    total.vertices_moved = changes_.moves.size();
    total.vertices_added = changes_.vertices_new.size();
    total.vertices_removed = changes_.vertices_gone.size();
    double squares = 0;
    for (const VertexMove& move : changes_.moves) {
      const double by = displacement(move);
      total.max_displacement = std::max(total.max_displacement, by);
      squares += by * by;
    }
    if (total.vertices_moved) total.rms_displacement = std::sqrt(squares / static_cast<double>(total.vertices_moved));
    count_vertices_after();
    std::vector<bool> gone(region_.points.size(), false);
    for (const std::uint32_t v : changes_.vertices_gone) gone[v] = true;
    for_charts_of(
        region_.faces, charts_.before, gone, [](std::uint32_t v) { return v; },
        [](ChartChange& of, std::uint32_t) { ++of.vertices_removed; });
  }

  void count_vertices_after() {
    std::vector<bool> moves(region_.points.size(), false), marked(after_.size(), false), is_new(after_.size(), false);
    for (const VertexMove& move : changes_.moves) moves[move.vertex] = true;
    for (const std::uint32_t v : changes_.vertices_new) marked[v] = is_new[v] = true;
    for (std::uint32_t v = 0; v < marked.size(); ++v)
      if (const std::uint32_t source = edited_.vertex_source[v]; source != kNew && moves[source]) marked[v] = true;
    for_charts_of(
        edited_.mesh.faces, charts_.after, marked, [&](std::uint32_t v) { return edited_.vertex_source[v]; },
        [&](ChartChange& of, std::uint32_t v) {
          ++(is_new[v] ? of.vertices_added : of.vertices_moved);
          of.max_displacement = std::max(of.max_displacement, by_[v]);
          of.rms_displacement += by_[v] * by_[v];
        });
    for (ChartChange& of : out_.per_chart)
      if (of.vertices_moved)
        of.rms_displacement = std::sqrt(of.rms_displacement / static_cast<double>(of.vertices_moved));
  }

  void count_faces() {
    out_.total.faces_added = changes_.faces_new.size();
    out_.total.faces_removed = changes_.faces_gone.size();
    for (const std::uint32_t f : changes_.faces_new) ++chart(charts_.after[f]).faces_added;
    for (const std::uint32_t f : changes_.faces_gone) ++chart(charts_.before[f]).faces_removed;
  }

  void count_values() {
    for (const LayerEdit& layer : changes_.layers) {
      out_.total.values_changed += layer.count();
      const std::uint32_t per_face = layer.layer.info.of == AttributeOf::corner ? 3 : 1;
      for (const auto& [id, values] : layer.in_charts) {
        const auto at = std::ranges::lower_bound(region_.charts, id) - region_.charts.begin();
        const auto first = std::ranges::lower_bound(region_.chart_of_face, static_cast<std::uint32_t>(at)) -
                           region_.chart_of_face.begin();
        for (const auto& [where, value] : values)
          ++chart(charts_.before[static_cast<std::size_t>(first) + where / per_face]).values_changed;
      }
      if (layer.at_vertices.empty()) continue;
      std::vector<bool> changed(region_.points.size(), false);
      for (std::uint32_t v = 0; v < changed.size(); ++v)
        changed[v] = layer.at_vertices.contains(region_.keys[v].packed());
      for_charts_of(
          region_.faces, charts_.before, changed, [](std::uint32_t v) { return v; },
          [](ChartChange& of, std::uint32_t) { ++of.values_changed; });
    }
  }

  /// A vertex of the region where it was, or of the edited mesh: equal where it is the same and did not move.
  [[nodiscard]] Triangle named(const Triangle& t) const {
    Triangle names{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t source = edited_.vertex_source[t[i]];
      const bool stays = source != kNew && before_[source] == after_[t[i]];
      names[i] = stays ? source : static_cast<std::uint32_t>(before_.size()) + t[i];
    }
    return names;
  }

  void measure_surface() {
    const Point middle = middle_of(before_.empty() ? after_ : before_);
    BorderOfChange border;
    std::vector<std::uint32_t> stays(region_.faces.size(), kNew);
    for (std::uint32_t f = 0; f < edited_.face_source.size(); ++f)
      if (edited_.face_source[f] != kNew) stays[edited_.face_source[f]] = f;
    const auto add = [&](const std::vector<Point>& at, const Triangle& t, const Triangle& names, bool changes,
                         std::uint32_t chart, int sign) {
      ChartChange& of = out_.per_chart[chart];
      const Point a = minus(at[t[0]], middle), b = minus(at[t[1]], middle), c = minus(at[t[2]], middle);
      const Point normal = cross(minus(b, a), minus(c, a));
      const double area = std::sqrt(dot(normal, normal)) / 2;
      if (sign < 0) of.area_before += area;
      if (!changes) return;
      of.area_after += sign * area;
      *of.volume_change += sign * dot(a, cross(b, c)) / 6;
      border.add(chart, names, sign);
    };
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f) {
      const bool changes = stays[f] == kNew || named(edited_.mesh.faces[stays[f]]) != region_.faces[f];
      add(before_, region_.faces[f], region_.faces[f], changes, position(charts_.before[f]), -1);
    }
    for (std::uint32_t f = 0; f < edited_.mesh.faces.size(); ++f) {
      const Triangle names = named(edited_.mesh.faces[f]);
      const std::uint32_t source = edited_.face_source[f];
      add(after_, edited_.mesh.faces[f], names, source == kNew || names != region_.faces[source],
          position(charts_.after[f]), 1);
    }
    sum_up(border);
  }

  void sum_up(BorderOfChange& border) {
    ChangeFigures& total = out_.total;
    for (ChartChange& of : out_.per_chart) {
      of.area_after += of.area_before;  // so far the difference: what stays does not blur it
      total.area_before += of.area_before;
      total.area_after += of.area_after;
      *total.volume_change += *of.volume_change;
    }
    for (const std::uint32_t open : border.open_charts()) out_.per_chart[open].volume_change.reset();
    if (!border.is_closed()) total.volume_change.reset();
  }

  const RegionMesh& region_;
  const EditedRegion& edited_;
  const ChangeSet& changes_;
  const FaceCharts& charts_;
  std::vector<Point> before_, after_;
  std::vector<double> by_;
  std::map<ChartId, std::uint32_t> position_;
  MeasuredChange out_;
};

}  // namespace

MeasuredChange measure_change(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                              const ChangeSet& changes, const FaceCharts& charts) {
  return Measurement(at, region, edited, changes, charts).run();
}

std::vector<double> displacements_of(const EditedRegion& edited, const ChangeSet& changes) {
  std::map<std::uint32_t, double> moved;
  for (const VertexMove& move : changes.moves) moved.emplace(move.vertex, displacement(move));
  std::vector<double> by(edited.vertex_source.size(), 0);
  for (std::size_t v = 0; v < by.size(); ++v)
    if (const auto it = moved.find(edited.vertex_source[v]); it != moved.end()) by[v] = it->second;
  return by;
}

}  // namespace ramcdb::detail
