#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "api/page_index.h"
#include "api/snapshot_impl.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/model.h"
#include "tests/api/sketch.h"
#include "tests/api/temp_repository.h"

namespace ramcdb::test {

/// A sketch of a region of a version, as the vertices of that version's model.
struct Placed {
  const Sketch* sketch;
  std::vector<Model::Color> colors;  ///< per vertex of the sketch; empty where not known
  std::vector<std::uint64_t> ids;    ///< per vertex of the sketch
};

/// Tells which vertices of a version a sketch has. New ones get new ids, unless they lie where one that goes lay: what
/// a program makes anew at the same place cannot be told from what was there. \param whole the version that `model` is
/// of, in the same order
[[nodiscard]] inline Placed placed(const Sketch& sketch, std::vector<Model::Color> colors, const RegionMesh& whole,
                                   const Model& model, std::uint64_t& next_id) {
  std::map<VertexKey, std::uint32_t> vertex_of;
  for (std::uint32_t v = 0; v < whole.keys.size(); ++v) vertex_of.emplace(whole.keys[v], v);
  const RegionMesh& region = sketch.region();
  const auto id_of = [&](std::uint32_t v) { return model.ids[vertex_of.at(region.keys[v])]; };
  std::vector<bool> stays(region.points.size(), false), outside(whole.points.size(), false);
  for (const std::uint32_t was : sketch.vertex_was)
    if (was != Sketch::kNew) stays[was] = true;
  for (std::uint32_t f = 0; f < whole.faces.size(); ++f)
    if (!std::ranges::binary_search(region.charts, whole.charts[whole.chart_of_face[f]]))
      for (const std::uint32_t v : whole.faces[f]) outside[v] = true;
  std::multimap<LatticePoint, std::uint64_t> gone;
  for (std::uint32_t v = 0; v < stays.size(); ++v)
    if (!stays[v] && !outside[vertex_of.at(region.keys[v])]) gone.emplace(region.points[v], id_of(v));
  Placed out{&sketch, std::move(colors), {}};
  for (std::uint32_t v = 0; v < sketch.points.size(); ++v) {
    const auto same = gone.find(sketch.points[v]);
    if (sketch.vertex_was[v] != Sketch::kNew) {
      out.ids.push_back(id_of(sketch.vertex_was[v]));
    } else if (same != gone.end()) {
      out.ids.push_back(same->second);
      gone.erase(same);
    } else {
      out.ids.push_back(next_id++);
    }
  }
  return out;
}

/// What a version becomes by a sketch of some of its charts.
[[nodiscard]] inline Model with_sketch(const RegionMesh& whole, const Model& model, const Placed& placed) {
  const Sketch& sketch = *placed.sketch;
  const RegionMesh& region = sketch.region();
  const std::set<ChartId> edited(region.charts.begin(), region.charts.end());
  const auto in_model = model.vertex_of_id();
  std::map<std::uint64_t, std::uint32_t> in_sketch;
  for (std::uint32_t v = 0; v < placed.ids.size(); ++v) in_sketch.emplace(placed.ids[v], v);
  std::vector<bool> used(whole.points.size(), false), used_outside(whole.points.size(), false);
  std::vector<std::array<std::uint64_t, 3>> faces;
  for (std::uint32_t f = 0; f < whole.faces.size(); ++f) {
    const bool outside = !edited.contains(whole.charts[whole.chart_of_face[f]]);
    for (const std::uint32_t v : whole.faces[f]) used[v] = true, used_outside[v] = used_outside[v] || outside;
    const Triangle& t = whole.faces[f];
    if (outside) faces.push_back({model.ids[t[0]], model.ids[t[1]], model.ids[t[2]]});
  }
  for (const Triangle& t : sketch.faces) faces.push_back({placed.ids[t[0]], placed.ids[t[1]], placed.ids[t[2]]});

  Model out;
  for (std::uint32_t v = 0; v < model.ids.size(); ++v) {
    const auto mine = in_sketch.find(model.ids[v]);
    const bool isolated_outside = !used[v] && !edited.contains(ChartId(whole.keys[v].id));
    if (mine == in_sketch.end() && !used_outside[v] && !isolated_outside) continue;
    LatticePoint p = model.points[v];
    Model::Color color = model.color[v];
    if (mine != in_sketch.end()) {
      p = sketch.points[mine->second];
      color = placed.colors[mine->second];
    }
    out.add_vertex(model.ids[v], p, std::move(color));
  }
  for (std::uint32_t v = 0; v < placed.ids.size(); ++v)
    if (!in_model.contains(placed.ids[v])) out.add_vertex(placed.ids[v], sketch.points[v], placed.colors[v]);
  const auto at = out.vertex_of_id();
  for (const auto& face : faces) out.faces.push_back({at.at(face[0]), at.at(face[1]), at.at(face[2])});
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
