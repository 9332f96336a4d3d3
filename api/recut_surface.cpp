#include "api/recut_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "api/border_links.h"
#include "api/region_query.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

class SurfaceBuilder {
 public:
  SurfaceBuilder(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                 const ChangeSet& changes)
      : at_(at), region_(region), edited_(edited), local_of_(edited.mesh.points.size(), kNew) {
    out_.charts.assign(changes.recut.begin(), changes.recut.end());
  }

  RecutSurface run(unsigned threads) {
    ChartLoader loader(at_);
    out_.loaded = loader.load(out_.charts, threads, nullptr, true);
    out_.wires = loader.wires();
    add_faces();
    add_isolated_vertices();
    name_vertices();
    add_before();
    find_changed_border();
    fix_wires();
    fix_corners();
    add_surroundings(threads);
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t position_of(ChartId id) const {
    const auto it = std::ranges::lower_bound(out_.charts, id);
    return it != out_.charts.end() && *it == id ? static_cast<std::uint32_t>(it - out_.charts.begin()) : kNew;
  }

  std::uint32_t local(std::uint32_t vertex) {
    std::uint32_t& at = local_of_[vertex];
    if (at == kNew) {
      at = static_cast<std::uint32_t>(out_.vertex.size());
      out_.vertex.push_back(vertex);
      out_.mesh.positions.push_back(edited_.mesh.points[vertex]);
    }
    return at;
  }

  void add_faces() {
    const RegionMesh& mesh = edited_.mesh;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const std::uint32_t source = edited_.face_source[f];
      const std::uint32_t chart = source == kNew ? kNew : position_of(region_.charts[region_.chart_of_face[source]]);
      if (source != kNew && chart == kNew) continue;
      out_.mesh.faces.push_back({local(mesh.faces[f][0]), local(mesh.faces[f][1]), local(mesh.faces[f][2])});
      out_.face.push_back(f);
      out_.chart_of_face.push_back(chart);
      if (!mesh.polygon_of_face.empty()) out_.mesh.polygon_of_face.push_back(mesh.polygon_of_face[f]);
    }
  }

  void add_isolated_vertices() {
    std::vector<bool> used(edited_.mesh.points.size(), false);
    for (const Triangle& t : edited_.mesh.faces)
      for (const std::uint32_t v : t) used[v] = true;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (used[v]) continue;
      const std::uint32_t source = edited_.vertex_source[v];
      const bool of_chart = source != kNew && region_.keys[source].where == VertexKey::Where::chart;
      const std::uint32_t chart = of_chart ? position_of(ChartId(region_.keys[source].id)) : kNew;
      if (of_chart && chart == kNew) continue;
      if (source != kNew && stays_in_others(source)) continue;
      (void)local(v);
      out_.chart_of_isolated_vertex.push_back(chart);
    }
  }

  /// Whether charts that are not cut anew have a vertex, a corner, in their faces.
  [[nodiscard]] bool stays_in_others(std::uint32_t source) const {
    const VertexKey key = region_.keys[source];
    if (key.where != VertexKey::Where::corner) return false;
    const auto around = charts_at_corners(at_, {{CornerId(key.id), region_.points[source]}}).begin()->second;
    return !std::ranges::all_of(around, [&](ChartId c) { return position_of(c) != kNew; });
  }

  void name_vertices() {
    for (std::uint32_t v = 0; v < out_.vertex.size(); ++v) {
      const std::uint32_t source = edited_.vertex_source[out_.vertex[v]];
      if (source == kNew || region_.keys[source].where == VertexKey::Where::chart) continue;
      out_.vertex_of_key.emplace(region_.keys[source].packed(), v);
      if (region_.keys[source].where == VertexKey::Where::corner)
        out_.corner_at.emplace(v, CornerId(region_.keys[source].id));
    }
  }

  void add_before() {
    std::vector<std::uint32_t> local_of(region_.points.size(), kNew);
    const auto add = [&](std::uint32_t v) {
      if (local_of[v] == kNew) {
        local_of[v] = static_cast<std::uint32_t>(out_.before.positions.size());
        out_.before.positions.push_back(region_.points[v]);
      }
      return local_of[v];
    };
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f) {
      if (position_of(region_.charts[region_.chart_of_face[f]]) == kNew) continue;
      const Triangle& t = region_.faces[f];
      out_.before.faces.push_back({add(t[0]), add(t[1]), add(t[2])});
      if (!region_.polygon_of_face.empty()) out_.before.polygon_of_face.push_back(region_.polygon_of_face[f]);
    }
    for (std::uint32_t v = 0; v < region_.keys.size(); ++v)
      if (region_.keys[v].where == VertexKey::Where::chart && position_of(ChartId(region_.keys[v].id)) != kNew)
        (void)add(v);
    for (std::uint32_t v = 0; v < region_.keys.size(); ++v)
      if (local_of[v] != kNew) before_of_key_.emplace(region_.keys[v].packed(), local_of[v]);
  }

  /// Where other charts have to be looked at to count what is not manifold.
  void find_changed_border() {
    std::unordered_map<std::uint64_t, std::uint32_t> number;
    std::vector<std::uint32_t> before(out_.before.positions.size(), kNew), after(out_.mesh.positions.size(), kNew);
    const auto add = [&](const auto& of_key, std::vector<std::uint32_t>& shared) {
      for (const auto& [key, v] : of_key)
        if (VertexKey::unpack(key).where != VertexKey::Where::chart)
          shared[v] = number.emplace(key, static_cast<std::uint32_t>(number.size())).first->second;
    };
    add(before_of_key_, before);
    add(out_.vertex_of_key, after);
    const bool has_polygons = !out_.before.polygon_of_face.empty() || !out_.mesh.polygon_of_face.empty();
    const std::vector<bool> changed = has_polygons
                                          ? std::vector<bool>(number.size(), true)
                                          : changed_links({out_.before.faces, before}, {out_.mesh.faces, after},
                                                          static_cast<std::uint32_t>(number.size()));
    for (const auto& [key, i] : number)
      if (changed[i]) changed_border_.insert(key);
  }

  [[nodiscard]] bool changed_inside(const PageWire& wire) const {
    for (std::uint32_t i = 0; i < wire.inner_points; ++i)
      if (changed_border_.contains(VertexKey{VertexKey::Where::wire, wire.id.value, i}.packed())) return true;
    return false;
  }

  void fix_wires() {
    std::vector<WireId> ids;
    for (const auto& [id, wire] : out_.wires)
      if (!out_.is_inner(wire.entry)) ids.push_back(id);
    std::ranges::sort(ids);
    for (const WireId id : ids) {
      chartify::FixedWire fixed{out_.path_of(out_.wires.at(id).entry)};
      if (fixed.vertices.empty())
        throw Error(Errc::conflict, fmt::format("vertices of wire {} are gone, which other charts pass", id.value));
      const PageWire& entry = out_.wires.at(id).entry;
      if (changed_inside(entry)) outside_.insert(entry.charts.begin(), entry.charts.end());
      out_.fixed_ids.push_back(id);
      out_.fixed.push_back(std::move(fixed));
    }
  }

  void fix_corners() {
    CornerPlaces corners;
    for (const auto& [id, wire] : out_.wires) {
      corners.emplace(wire.entry.begin, wire.wire.points.front());
      corners.emplace(wire.entry.end, wire.wire.points.back());
    }
    for (const auto& [corner, around] : charts_at_corners(at_, corners)) {
      if (std::ranges::all_of(around, [&](ChartId c) { return out_.holds(c); })) continue;
      out_.shared_corners.insert(corner);
      const std::uint64_t key = VertexKey{VertexKey::Where::corner, corner.value, 0}.packed();
      if (changed_border_.contains(key)) outside_.insert(around.begin(), around.end());
      const auto at = out_.vertex_of_key.find(key);
      if (at != out_.vertex_of_key.end()) out_.corners.push_back(at->second);
    }
    std::ranges::sort(out_.corners);
  }

  /// Whether vertices of both sides are manifold is seen from both sides only.
  void add_surroundings(unsigned threads) {
    out_.around_before = out_.before;
    out_.around = out_.mesh;
    std::erase_if(outside_, [&](ChartId c) { return out_.holds(c); });
    const std::vector<ChartId> ids(outside_.begin(), outside_.end());
    std::unordered_map<std::uint64_t, std::uint32_t> before = before_of_key_, after = out_.vertex_of_key;
    const auto vertex = [](auto& of_key, chartify::IndexedMesh& mesh, const LoadedChart& chart, std::uint32_t v) {
      const auto [it, is_new] =
          of_key.emplace(chart.keys[v].packed(), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(chart.chart.positions[v]);
      return it->second;
    };
    const std::vector<LoadedChart> charts = ChartLoader(at_).load(ids, threads);
    for (const LoadedChart& chart : charts)
      for (const Triangle& t : chart.chart.faces) {
        if (std::ranges::none_of(t, [&](auto v) { return before_of_key_.contains(chart.keys[v].packed()); })) continue;
        Triangle was{}, is{};
        for (std::size_t i = 0; i < 3; ++i) {
          was[i] = vertex(before, out_.around_before, chart, t[i]);
          is[i] = vertex(after, out_.around, chart, t[i]);
        }
        out_.around_before.faces.push_back(was);
        out_.around.faces.push_back(is);
      }
    give_polygons(out_.around_before);
    give_polygons(out_.around);
  }

  /// Where a mesh has polygons, the faces behind those that have one are polygons of their own.
  static void give_polygons(chartify::IndexedMesh& mesh) {
    if (mesh.polygon_of_face.empty()) return;
    std::uint32_t next = std::ranges::max(mesh.polygon_of_face);
    while (mesh.polygon_of_face.size() < mesh.faces.size()) mesh.polygon_of_face.push_back(++next);
  }

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  const EditedRegion& edited_;
  std::vector<std::uint32_t> local_of_;
  std::unordered_map<std::uint64_t, std::uint32_t> before_of_key_;
  std::unordered_set<std::uint64_t> changed_border_;  ///< keys
  std::set<ChartId> outside_;                         ///< to look at
  RecutSurface out_;
};

}  // namespace

std::vector<std::uint32_t> RecutSurface::path_of(const PageWire& wire) const {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < wire.inner_points + 2; ++i) {
    const VertexKey key = i == 0                  ? VertexKey{VertexKey::Where::corner, wire.begin.value, 0}
                          : i > wire.inner_points ? VertexKey{VertexKey::Where::corner, wire.end.value, 0}
                                                  : VertexKey{VertexKey::Where::wire, wire.id.value, i - 1};
    const auto found = vertex_of_key.find(key.packed());
    if (found == vertex_of_key.end()) return {};
    path.push_back(found->second);
  }
  return path;
}

RecutSurface recut_surface(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                           const ChangeSet& changes, unsigned threads) {
  return SurfaceBuilder(at, region, edited, changes).run(threads);
}

}  // namespace ramcdb::detail
