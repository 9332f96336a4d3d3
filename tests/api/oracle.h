#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "api/page_index.h"
#include "api/snapshot_impl.h"
#include "api/topology.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/sketch.h"
#include "tests/api/temp_repository.h"

namespace ramcdb::test {

/// A plain mesh: what a version ought to hold. Vertices without a face are isolated ones.
struct Model {
  std::vector<LatticePoint> points;
  std::vector<std::vector<double>> color;  ///< per vertex; empty where it is not known
  std::vector<Triangle> faces;

  [[nodiscard]] detail::Topology topology() const {
    chartify::IndexedMesh mesh;
    mesh.positions = points;
    mesh.faces = faces;
    return detail::analyze(mesh);
  }
  [[nodiscard]] std::vector<LatticePoint> sorted_points() const {
    std::vector<LatticePoint> all = points;
    std::sort(all.begin(), all.end());
    return all;
  }
  /// A place and a colour for every vertex that has a known one.
  [[nodiscard]] std::vector<std::pair<LatticePoint, std::vector<double>>> known_colors() const {
    std::vector<std::pair<LatticePoint, std::vector<double>>> known;
    for (std::size_t v = 0; v < points.size(); ++v)
      if (!color[v].empty()) known.emplace_back(points[v], color[v]);
    std::sort(known.begin(), known.end());
    return known;
  }
};

[[nodiscard]] inline std::vector<double> color_at(const RegionMesh& region, std::uint32_t v) {
  if (region.attributes.empty()) return {};
  const auto first = region.attributes.front().values.begin() + 3 * static_cast<std::ptrdiff_t>(v);
  return {first, first + 3};
}

[[nodiscard]] inline Model model_of(const RegionMesh& region) {
  Model model{region.points, {}, region.faces};
  for (std::uint32_t v = 0; v < region.points.size(); ++v) model.color.push_back(color_at(region, v));
  return model;
}

/// What a version becomes by sketches of regions that have no chart in common.
/// \param colors per sketch and vertex of it; empty where not known
[[nodiscard]] inline Model with_sketches(const RegionMesh& whole, const std::vector<const Sketch*>& sketches,
                                         const std::vector<std::vector<std::vector<double>>>& colors) {
  Model all = model_of(whole), out;
  std::map<VertexKey, std::uint32_t> vertex_of;
  for (std::uint32_t v = 0; v < whole.keys.size(); ++v) vertex_of.emplace(whole.keys[v], v);
  std::set<ChartId> edited;
  std::vector<Triangle> faces;
  std::vector<bool> alive(whole.points.size(), false);
  for (std::size_t s = 0; s < sketches.size(); ++s) {
    const Sketch& sketch = *sketches[s];
    const RegionMesh& region = sketch.region();
    edited.insert(region.charts.begin(), region.charts.end());
    std::vector<std::uint32_t> number;
    for (std::uint32_t v = 0; v < sketch.points.size(); ++v) {
      if (sketch.vertex_was[v] == Sketch::kNew) {
        number.push_back(static_cast<std::uint32_t>(all.points.size()));
        all.points.push_back(sketch.points[v]);
        all.color.push_back(colors[s][v]);
        alive.push_back(true);
        continue;
      }
      number.push_back(vertex_of.at(region.keys[sketch.vertex_was[v]]));
      if (sketch.points[v] != region.points[sketch.vertex_was[v]]) all.points[number.back()] = sketch.points[v];
      if (colors[s][v] != color_at(region, sketch.vertex_was[v])) all.color[number.back()] = colors[s][v];
      alive[number.back()] = true;
    }
    for (const Triangle& t : sketch.faces) faces.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  std::vector<bool> used(whole.points.size(), false);
  for (std::uint32_t f = 0; f < whole.faces.size(); ++f) {
    for (const std::uint32_t v : whole.faces[f]) used[v] = true;
    if (edited.contains(whole.charts[whole.chart_of_face[f]])) continue;
    faces.push_back(whole.faces[f]);
    for (const std::uint32_t v : whole.faces[f]) alive[v] = true;
  }
  for (std::uint32_t v = 0; v < whole.points.size(); ++v)
    if (!used[v] && !edited.contains(ChartId(whole.keys[v].id))) alive[v] = true;
  std::vector<std::uint32_t> to(all.points.size(), Sketch::kNew);
  for (std::uint32_t v = 0; v < all.points.size(); ++v) {
    if (!alive[v]) continue;
    to[v] = static_cast<std::uint32_t>(out.points.size());
    out.points.push_back(all.points[v]);
    out.color.push_back(all.color[v]);
  }
  for (const Triangle& t : faces) out.faces.push_back({to[t[0]], to[t[1]], to[t[2]]});
  return out;
}

/// Makes a patch what a sketch is, as far as OpenMesh can hold that, and returns what it then is.
inline Sketch sketch_in_patch(Patch& patch, const Sketch& wanted, Sketch::Random& random) {
  Patch::Mesh& mesh = patch.mesh();
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  const RegionMesh& region = patch.region();
  const auto target = [&](LatticePoint p) {
    const Point q = patch.base().position(p);
    return Patch::Mesh::Point(q.x, q.y, q.z);
  };
  std::vector<bool> stays(region.faces.size(), false);
  for (std::size_t f = 0; f < wanted.faces.size(); ++f)
    if (wanted.face_was[f] != Sketch::kNew) stays[wanted.face_was[f]] = true;
  const bool drop = random() % 4 != 0;  // else vertices that lose their faces stay
  for (const auto f : mesh.all_faces())
    if (!stays[mesh.property(patch.region_face_property(), f) - 1]) mesh.delete_face(f, drop);
  std::vector<Patch::Mesh::VertexHandle> first(region.points.size());
  std::vector<std::uint32_t> in_sketch(region.points.size(), Sketch::kNew);
  for (std::uint32_t v = 0; v < wanted.points.size(); ++v)
    if (wanted.vertex_was[v] != Sketch::kNew) in_sketch[wanted.vertex_was[v]] = v;
  for (const auto v : mesh.all_vertices()) {
    const std::uint32_t was = mesh.property(patch.region_property(), v);
    if (mesh.status(v).deleted()) continue;
    if (!first[was].is_valid()) first[was] = v;
    if (in_sketch[was] != Sketch::kNew) mesh.set_point(v, target(wanted.points[in_sketch[was]]));
  }
  std::vector<Patch::Mesh::VertexHandle> handle(wanted.points.size());
  const auto vertex = [&](std::uint32_t v) {
    if (wanted.vertex_was[v] != Sketch::kNew && first[wanted.vertex_was[v]].is_valid())
      return first[wanted.vertex_was[v]];
    if (!handle[v].is_valid()) handle[v] = mesh.add_vertex(target(wanted.points[v]));
    return handle[v];
  };
  for (std::size_t f = 0; f < wanted.faces.size(); ++f) {
    if (wanted.face_was[f] != Sketch::kNew) continue;
    const Triangle& t = wanted.faces[f];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) (void)mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  if (random() % 2) mesh.garbage_collection();

  Sketch now = Sketch::blank(region);
  std::vector<std::uint32_t> number(mesh.n_vertices(), Sketch::kNew), of(region.points.size(), Sketch::kNew);
  for (const auto v : mesh.all_vertices()) {
    if (mesh.status(v).deleted()) continue;
    const auto p = mesh.point(v);
    std::uint32_t& n = number[static_cast<std::size_t>(v.idx())];
    const bool old = mesh.property(patch.key_property(), v) != 0;
    const std::uint32_t was = old ? mesh.property(patch.region_property(), v) : Sketch::kNew;
    if (old && of[was] != Sketch::kNew) {
      n = of[was];
      continue;
    }
    n = now.add_vertex(patch.base().lattice().snap({p[0], p[1], p[2]}), was, true);
    if (old) of[was] = n;
  }
  for (const auto f : mesh.all_faces()) {
    if (mesh.status(f).deleted()) continue;
    Triangle t{};
    std::size_t i = 0;
    for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v) t[i++] = number[static_cast<std::size_t>(v->idx())];
    now.add_face(t);
  }
  return now;
}

/// What the index pages hold.
struct PageCounts {
  std::map<ChartId, PageChart> charts;
  std::map<WireId, PageWire> wires;
  std::set<CornerId> corners;

  explicit PageCounts(const Snapshot& snapshot) {
    snapshot.impl().pages().visit([](const LatticeBox&) { return true; },
                                  [&](const detail::LeafRef& ref) {
                                    for (const PageChart& chart : ref.leaf->charts) charts.emplace(chart.id, chart);
                                    for (const PageWire& wire : ref.leaf->wires) wires.emplace(wire.id, wire);
                                    for (const PageCorner& corner : ref.leaf->corners) corners.insert(corner.id);
                                  });
  }
};

}  // namespace ramcdb::test
