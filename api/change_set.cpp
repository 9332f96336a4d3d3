#include "api/change_set.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/same_values.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// An edge of two vertices of the region, and the chart of a face at it; kNew: of a new face.
struct EdgeUse {
  std::uint32_t a, b, chart;

  EdgeUse(std::uint32_t u, std::uint32_t v, std::uint32_t c) : a(std::min(u, v)), b(std::max(u, v)), chart(c) {}
  friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
  [[nodiscard]] bool same_edge(const EdgeUse& other) const { return a == other.a && b == other.b; }
};

/// The edges that faces which come or go have with the region's vertices, ascending.
class EdgeCounts {
 public:
  /// Adds the edges of a face.
  void add(const Triangle& t, std::uint32_t chart) {
    for (int i = 0; i < 3; ++i)
      if (t[i] != kNew && t[(i + 1) % 3] != kNew) uses_.emplace_back(t[i], t[(i + 1) % 3], chart);
  }
  void sort() { std::sort(uses_.begin(), uses_.end()); }
  [[nodiscard]] const std::vector<EdgeUse>& uses() const { return uses_; }
  [[nodiscard]] std::size_t count(const EdgeUse& edge) const {
    const auto first = std::lower_bound(uses_.begin(), uses_.end(), EdgeUse(edge.a, edge.b, 0));
    auto last = first;
    while (last != uses_.end() && last->same_edge(edge)) ++last;
    return static_cast<std::size_t>(last - first);
  }

 private:
  std::vector<EdgeUse> uses_;
};

[[noreturn]] void refuse_torn(const Snapshot::Impl& at, const RegionMesh& region, const std::vector<EdgeUse>& torn) {
  constexpr std::size_t kMost = 5;
  std::string places;
  for (std::size_t i = 0; i < std::min(kMost, torn.size()); ++i) {
    const Point p = at.record().lattice.position(region.points[torn[i].a]);
    places += fmt::format("{}{:.9g},{:.9g},{:.9g}", i ? "; " : "near ", p.x, p.y, p.z);
  }
  if (torn.size() > kMost) places += "; ...";
  throw Error(Errc::invalid_argument,
              fmt::format("faces come or go at {} edges of the region's own border, which charts outside it share",
                          torn.size()),
              places, "check a larger region out (--grow 1) and make the edit there; on the border vertices may move");
}

class Comparison {
 public:
  Comparison(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited)
      : at_(at), region_(region), edited_(edited) {}

  void find_differences() {
    find_vertices();
    find_faces();
    set_.layers = changed_values(region_, at_.layers(), attributes_in_region(edited_, region_));
  }

  void find_charts() {
    if (set_.connectivity()) find_recut();
    find_touched();
  }

  [[nodiscard]] ChangeSet take() { return std::move(set_); }

 private:
  void find_vertices() {
    stays_.assign(region_.points.size(), false);
    for (std::uint32_t v = 0; v < edited_.vertex_source.size(); ++v) {
      const std::uint32_t source = edited_.vertex_source[v];
      if (source == kNew) {
        set_.vertices_new.push_back(v);
        continue;
      }
      stays_[source] = true;
      const RegionMesh& mesh = edited_.mesh;
      const Point p = position_in(mesh, at_.record().lattice, v);
      if (auto move = move_to(at_, region_, source, p)) set_.moves.push_back(*move);
    }
    std::ranges::sort(set_.moves, {}, &VertexMove::vertex);
    for (std::uint32_t v = 0; v < stays_.size(); ++v)
      if (!stays_[v]) set_.vertices_gone.push_back(v);
  }

  void find_faces() {
    std::vector<bool> stays(region_.faces.size(), false);
    for (std::uint32_t f = 0; f < edited_.face_source.size(); ++f)
      if (edited_.face_source[f] == kNew)
        set_.faces_new.push_back(f);
      else
        stays[edited_.face_source[f]] = true;
    for (std::uint32_t f = 0; f < stays.size(); ++f)
      if (!stays[f]) set_.faces_gone.push_back(f);
  }

  [[nodiscard]] Triangle sources(std::uint32_t face) const {
    const Triangle& t = edited_.mesh.faces[face];
    return {edited_.vertex_source[t[0]], edited_.vertex_source[t[1]], edited_.vertex_source[t[2]]};
  }

  void find_recut() {
    EdgeCounts gone, come;
    for (const std::uint32_t f : set_.faces_gone) {
      set_.recut.insert(region_.charts[region_.chart_of_face[f]]);
      gone.add(region_.faces[f], region_.chart_of_face[f]);
    }
    for (const std::uint32_t f : set_.faces_new) come.add(sources(f), kNew);
    gone.sort();
    come.sort();
    std::vector<EdgeUse> changed;
    for (const EdgeCounts* side : {&gone, &come})
      for (std::size_t i = 0; i < side->uses().size(); ++i) {
        const EdgeUse& edge = side->uses()[i];
        if (i && edge.same_edge(side->uses()[i - 1])) continue;
        if (gone.count(edge) != come.count(edge)) changed.emplace_back(edge.a, edge.b, 0);
      }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    refuse_outer(changed);
    add_charts_at(changed);
    add_isolated();
    add_charts_of_new_faces();
    if (set_.recut.empty()) set_.recut.insert(edited_.home ? edited_.home : region_.charts.front());
  }

  void refuse_outer(const std::vector<EdgeUse>& changed) const {
    std::vector<EdgeUse> torn;
    std::ranges::copy_if(changed, std::back_inserter(torn), [&](const EdgeUse& edge) {
      return std::ranges::binary_search(region_.outer_edges, std::array{edge.a, edge.b});
    });
    if (!torn.empty()) refuse_torn(at_, region_, torn);
  }

  void add_charts_at(const std::vector<EdgeUse>& changed) {
    if (changed.empty()) return;
    std::vector<bool> at_changed(region_.points.size(), false);
    for (const EdgeUse& edge : changed) at_changed[edge.a] = at_changed[edge.b] = true;
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      for (int i = 0; i < 3; ++i) {
        const EdgeUse edge(region_.faces[f][i], region_.faces[f][(i + 1) % 3], 0);
        if (!at_changed[edge.a] || !at_changed[edge.b]) continue;
        if (std::ranges::binary_search(changed, edge)) set_.recut.insert(region_.charts[region_.chart_of_face[f]]);
      }
  }

  /// Isolated vertices belong to the charts that count them; those that lost their faces to one of these charts.
  void add_isolated() {
    for (const std::uint32_t v : set_.vertices_gone)
      if (region_.keys[v].where == VertexKey::Where::chart) set_.recut.insert(ChartId(region_.keys[v].id));
  }

  /// Some chart that is cut anew has to know every vertex that a new face takes up.
  void add_charts_of_new_faces() {
    std::vector<bool> wanted(region_.points.size(), false);
    for (const std::uint32_t f : set_.faces_new)
      for (const std::uint32_t v : sources(f))
        if (v != kNew) wanted[v] = true;
    const auto is_recut = [&](std::uint32_t chart) { return set_.recut.contains(region_.charts[chart]); };
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      if (is_recut(region_.chart_of_face[f]))
        for (const std::uint32_t v : region_.faces[f]) wanted[v] = false;
    for (std::uint32_t v = 0; v < wanted.size(); ++v)
      if (wanted[v] && region_.keys[v].where == VertexKey::Where::chart) {
        set_.recut.insert(ChartId(region_.keys[v].id));
        wanted[v] = false;
      }
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      for (const std::uint32_t v : region_.faces[f])
        if (wanted[v]) {
          set_.recut.insert(region_.charts[region_.chart_of_face[f]]);
          wanted[v] = false;
        }
  }

  void find_touched() {
    set_.touched = set_.recut;
    std::vector<bool> changed(region_.points.size(), false);
    for (const VertexMove& move : set_.moves) {
      changed[move.vertex] = true;
      if (move.key.where == VertexKey::Where::chart) set_.touched.insert(ChartId(move.key.id));
    }
    std::set<std::uint64_t> valued;
    for (const LayerEdit& layer : set_.layers) {
      for (const auto& [chart, values] : layer.in_charts) set_.touched.insert(chart);
      for (const auto& [key, value] : layer.at_vertices) valued.insert(key);
    }
    for (std::uint32_t v = 0; !valued.empty() && v < changed.size(); ++v)
      if (valued.contains(region_.keys[v].packed())) {
        changed[v] = true;
        if (region_.keys[v].where == VertexKey::Where::chart) set_.touched.insert(ChartId(region_.keys[v].id));
      }
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      for (const std::uint32_t v : region_.faces[f])
        if (changed[v]) set_.touched.insert(region_.charts[region_.chart_of_face[f]]);
  }

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  const EditedRegion& edited_;
  std::vector<bool> stays_;
  ChangeSet set_;
};

}  // namespace

std::optional<VertexMove> move_to(const Snapshot::Impl& at, const RegionMesh& region, std::size_t vertex,
                                  const Point& p) {
  const Lattice& lattice = at.record().lattice;
  VertexMove move{
      region.keys[vertex], region.points[vertex], {}, {}, at.record().rounded(p), static_cast<std::uint32_t>(vertex)};
  move.to = lattice.snap(move.target);
  if (!at.record().exact) {
    if (move.to == move.from) return std::nullopt;
    move.position = lattice.position(move.from);
    move.target = lattice.position(move.to);
    return move;
  }
  move.position = region.exact[vertex];
  if (same_bits(move.position, move.target)) return std::nullopt;
  return move;
}

ChangeSet differences_of(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited) {
  Comparison comparison(at, region, edited);
  comparison.find_differences();
  return comparison.take();
}

ChangeSet changes_of(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited) {
  Comparison comparison(at, region, edited);
  comparison.find_differences();
  comparison.find_charts();
  return comparison.take();
}

}  // namespace ramcdb::detail
