#include "api/limited_edit.h"

#include <algorithm>

#include "api/disjoint_sets.h"
#include "api/edited_region_builder.h"
#include "api/region_mesh.h"
#include "api/region_query.h"

namespace ramcdb::detail {
namespace {

bool cuts_charts(const RegionShape& shape) {
  return std::holds_alternative<InBox>(shape) || std::holds_alternative<InSphere>(shape) ||
         std::holds_alternative<InFrustum>(shape);
}

/// What of a mesh lies within limits.
class Inside {
 public:
  Inside(const EditLimits& limits, const RegionMesh& mesh, std::vector<Point> places)
      : limits_(limits), mesh_(mesh), places_(std::move(places)), at_chart_(places_.size(), false) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      if (of_chart(f))
        for (const std::uint32_t v : mesh.faces[f]) at_chart_[v] = true;
    for (std::uint32_t v = 0; v < mesh.keys.size(); ++v)
      if (mesh.keys[v].where == VertexKey::Where::chart && limits.charts.contains(ChartId(mesh.keys[v].id)))
        at_chart_[v] = true;
  }

  [[nodiscard]] const Point& place(std::uint32_t v) const { return places_[v]; }
  [[nodiscard]] bool vertex(std::uint32_t v) const { return at_chart_[v] || meets(places_[v], places_[v]); }
  [[nodiscard]] bool face(std::uint32_t f) const {
    if (of_chart(f)) return true;
    Point lo = places_[mesh_.faces[f][0]], hi = lo;
    for (const std::uint32_t v : mesh_.faces[f])
      for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], places_[v][axis]);
        hi[axis] = std::max(hi[axis], places_[v][axis]);
      }
    return meets(lo, hi);
  }

 private:
  [[nodiscard]] bool of_chart(std::uint32_t face) const {
    return limits_.charts.contains(mesh_.charts[mesh_.chart_of_face[face]]);
  }
  [[nodiscard]] bool meets(const Point& lo, const Point& hi) const {
    return std::ranges::any_of(limits_.shapes, [&](const RegionShape& shape) { return meets_shape(lo, hi, shape); });
  }

  const EditLimits& limits_;
  const RegionMesh& mesh_;
  std::vector<Point> places_;
  std::vector<bool> at_chart_;
};

class Limiter {
 public:
  Limiter(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited, const RegionMesh& mesh,
          const EditLimits& limits)
      : region_(region),
        edited_(edited),
        before_(limits, region, positions_in(region, at.record().lattice)),
        after_(limits, mesh, positions_in(mesh, at.record().lattice)),
        edited_vertex_(region.points.size(), kNew),
        edited_face_(region.faces.size(), kNew),
        islands_(region.points.size() + edited.vertex_source.size()),
        values_(region.attributes),
        builder_(at, region) {
    for (std::uint32_t v = 0; v < edited.vertex_source.size(); ++v)
      if (edited.vertex_source[v] != kNew) edited_vertex_[edited.vertex_source[v]] = v;
    for (std::uint32_t f = 0; f < edited.face_source.size(); ++f)
      if (edited.face_source[f] != kNew) edited_face_[edited.face_source[f]] = f;
  }

  EditedRegion run() {
    join_islands();
    choose_islands();
    add_vertices();
    add_faces();
    builder_.take_new(edited_.mesh, std::move(new_vertices_), std::move(new_faces_));
    return builder_.finish(values_);
  }

 private:
  /// A vertex of the region, or a new one of the edit, among all that there are before and after.
  [[nodiscard]] std::uint32_t node(std::uint32_t edited_vertex) const {
    const std::uint32_t source = edited_.vertex_source[edited_vertex];
    return source != kNew ? source : static_cast<std::uint32_t>(region_.points.size()) + edited_vertex;
  }
  [[nodiscard]] bool is_gone(std::uint32_t region_face) const { return edited_face_[region_face] == kNew; }
  [[nodiscard]] bool is_new(std::uint32_t edited_face) const { return edited_.face_source[edited_face] == kNew; }

  void join_islands() {
    std::vector<std::uint32_t> of_polygon(region_.polygon_sizes.size(), kNew);
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      if (is_gone(f)) join(region_.faces[f], region_.polygon_of_face, f, of_polygon);
    of_polygon.assign(edited_.mesh.polygon_sizes.size(), kNew);
    for (std::uint32_t f = 0; f < edited_.face_source.size(); ++f)
      if (is_new(f)) join(nodes_of(f), edited_.mesh.polygon_of_face, f, of_polygon);
  }

  [[nodiscard]] Triangle nodes_of(std::uint32_t edited_face) const {
    const Triangle& t = edited_.mesh.faces[edited_face];
    return {node(t[0]), node(t[1]), node(t[2])};
  }

  void join(const Triangle& nodes, const std::vector<std::uint32_t>& polygon_of_face, std::uint32_t face,
            std::vector<std::uint32_t>& of_polygon) {
    (void)islands_.join(nodes[0], nodes[1]);
    (void)islands_.join(nodes[0], nodes[2]);
    if (polygon_of_face.empty()) return;
    std::uint32_t& first = of_polygon[polygon_of_face[face]];
    if (first == kNew) first = nodes[0];
    (void)islands_.join(first, nodes[0]);
  }

  void choose_islands() {
    is_island_.assign(region_.points.size() + edited_.vertex_source.size(), false);
    chosen_ = is_island_;
    const auto note = [&](std::uint32_t of_island, bool inside) {
      const std::uint32_t root = islands_.root(of_island);
      is_island_[root] = true;
      if (inside) chosen_[root] = true;
    };
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f)
      if (is_gone(f)) note(region_.faces[f][0], before_.face(f));
    for (std::uint32_t f = 0; f < edited_.face_source.size(); ++f)
      if (is_new(f)) note(nodes_of(f)[0], after_.face(f));
    for (std::uint32_t v = 0; v < edited_vertex_.size(); ++v)
      if (edited_vertex_[v] == kNew) note(v, before_.vertex(v));
    for (std::uint32_t v = 0; v < edited_.vertex_source.size(); ++v)
      if (edited_.vertex_source[v] == kNew) note(node(v), after_.vertex(v));
  }

  [[nodiscard]] bool is_chosen(std::uint32_t of_island) { return chosen_[islands_.root(of_island)]; }

  void add_vertices() {
    vertex_.assign(is_island_.size(), kNew);
    for (std::uint32_t v = 0; v < edited_vertex_.size(); ++v) {
      const std::uint32_t to = edited_vertex_[v];
      if (to == kNew && is_chosen(v)) continue;
      const bool of_island = is_island_[islands_.root(v)];
      const bool taken = to != kNew && (of_island ? is_chosen(v) : before_.vertex(v) || after_.vertex(to));
      vertex_[v] = builder_.add_vertex(v, taken ? after_.place(to) : before_.place(v));
      if (taken) take_values(AttributeOf::vertex, to, v);
    }
    new_vertices_.assign(edited_.vertex_source.size(), kNew);
    for (std::uint32_t v = 0; v < edited_.vertex_source.size(); ++v)
      if (edited_.vertex_source[v] == kNew && is_chosen(node(v)))
        new_vertices_[v] = vertex_[node(v)] = builder_.add_vertex(kNew, after_.place(v));
  }

  [[nodiscard]] Triangle out_vertices(const Triangle& nodes) const {
    return {vertex_[nodes[0]], vertex_[nodes[1]], vertex_[nodes[2]]};
  }

  void add_faces() {
    for (std::uint32_t f = 0; f < region_.faces.size(); ++f) {
      if (is_gone(f) && is_chosen(region_.faces[f][0])) continue;
      (void)builder_.add_face(out_vertices(region_.faces[f]), f);
      if (is_gone(f) || !(before_.face(f) || after_.face(edited_face_[f]))) continue;
      take_values(AttributeOf::face, edited_face_[f], f);
      for (std::uint32_t i = 0; i < 3; ++i) take_values(AttributeOf::corner, 3 * edited_face_[f] + i, 3 * f + i);
    }
    new_faces_.assign(edited_.face_source.size(), kNew);
    for (std::uint32_t f = 0; f < edited_.face_source.size(); ++f)
      if (is_new(f) && is_chosen(nodes_of(f)[0])) new_faces_[f] = builder_.add_face(out_vertices(nodes_of(f)), kNew);
  }

  void take_values(AttributeOf of, std::size_t from, std::size_t to) {
    for (std::size_t a = 0; a < values_.size(); ++a)
      if (values_[a].info.of == of) copy(a, from, to, values_[a].info.components, values_[a].values);
  }

  void copy(std::size_t attribute, std::size_t from, std::size_t to, std::size_t count,
            std::vector<double>& out) const {
    std::copy_n(edited_.mesh.attributes[attribute].values.begin() + static_cast<std::ptrdiff_t>(count * from), count,
                out.begin() + static_cast<std::ptrdiff_t>(count * to));
  }

  const RegionMesh& region_;
  const EditedRegion& edited_;
  Inside before_, after_;
  std::vector<std::uint32_t> edited_vertex_, edited_face_;  ///< of the region's; kNew: it is gone
  DisjointSets islands_;                                    ///< of nodes
  std::vector<bool> is_island_, chosen_;                    ///< per root
  std::vector<Attribute> values_;                           ///< in the numbering of the region
  std::vector<std::uint32_t> vertex_;                       ///< node -> result
  std::vector<std::uint32_t> new_vertices_, new_faces_;     ///< of the edit -> result, if taken
  EditedRegionBuilder builder_;
};

}  // namespace

EditLimits limits_of(const Region& region, const Snapshot::Impl& from, const Snapshot::Impl& to) {
  EditLimits limits;
  Region whole{{}, region.grow};
  for (RegionShape shape : region.shapes) {
    if (region.grow == 0 && cuts_charts(shape)) {
      limits.shapes.push_back(shape);
      continue;
    }
    if (auto* named = std::get_if<OfCharts>(&shape)) {
      std::erase_if(named->charts, [&](ChartId id) {
        if (from.pages().leaf_of(id) || !to.pages().leaf_of(id)) return false;
        limits.charts.insert(id);
        return true;
      });
      if (named->charts.empty()) continue;
    }
    if (std::holds_alternative<WholeMesh>(shape))
      for (const ChartId id : to.pages().all_charts()) limits.charts.insert(id);
    whole.shapes.push_back(std::move(shape));
  }
  if (whole.shapes.empty()) return limits;
  for (const ChartId id : find_charts(from, whole, nullptr)) limits.charts.insert(id);
  return limits;
}

EditedRegion limited(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                     const RegionMesh& mesh, const EditLimits& limits) {
  return Limiter(at, region, edited, mesh, limits).run();
}

}  // namespace ramcdb::detail
