#include "ramcdb/patch.h"

#include <algorithm>
#include <vector>

#include "api/disjoint_sets.h"

namespace ramcdb {
namespace {

/// Groups the corners of faces that stay together at a vertex: two faces that pass one edge in opposite directions
/// share their vertices there, unless more faces meet.
class CornerGroups {
 public:
  explicit CornerGroups(const RegionMesh& region) : region_(region), sets_(3 * region.faces.size()) {
    join_over_edges();
  }

  std::uint32_t group(std::uint32_t corner) { return sets_.root(corner); }

 private:
  struct Pass {
    std::uint32_t low, high, corner;
  };

  std::uint32_t vertex(std::uint32_t corner) const { return region_.faces[corner / 3][corner % 3]; }
  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  void join_over_edges() {
    std::vector<Pass> passes;
    passes.reserve(3 * region_.faces.size());
    for (std::uint32_t c = 0; c < 3 * region_.faces.size(); ++c)
      passes.push_back({std::min(vertex(c), vertex(next(c))), std::max(vertex(c), vertex(next(c))), c});
    std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) {
      return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    for (std::size_t i = 0, end; i < passes.size(); i = end) {
      for (end = i; end < passes.size() && passes[end].low == passes[i].low && passes[end].high == passes[i].high;)
        ++end;
      if (end - i != 2) continue;
      const std::uint32_t a = passes[i].corner, b = passes[i + 1].corner;
      if (a / 3 == b / 3 || vertex(a) == vertex(b)) continue;
      sets_.join(a, next(b));
      sets_.join(next(a), b);
    }
  }

  const RegionMesh& region_;
  detail::DisjointSets sets_;
};

}  // namespace

Patch::Patch(const Snapshot& snapshot, RegionMesh region)
    : base_(snapshot), region_(std::move(region)), attributes_(region_.attributes) {
  mesh_.add_property(key_, "ramcdb:key");
  mesh_.add_property(chart_, "ramcdb:chart");
  mesh_.add_property(region_vertex_, "ramcdb:region_vertex");
  mesh_.add_property(region_face_, "ramcdb:region_face");
  copied_.resize(region_.points.size(), false);
  const auto add_vertex = [&](std::uint32_t v) {
    const Point p = base_.position(region_, v);
    const auto handle = mesh_.add_vertex({p.x, p.y, p.z});
    mesh_.property(key_, handle) = region_.keys[v].packed();
    mesh_.property(region_vertex_, handle) = v;
    return handle;
  };

  CornerGroups groups(region_);
  std::vector<Mesh::VertexHandle> vertex_of_group(3 * region_.faces.size());
  std::vector<bool> present(region_.points.size(), false);
  const auto copy_of = [&](std::uint32_t v) {
    copies_ += present[v];
    copied_[v] = copied_[v] || present[v];
    present[v] = true;
    return add_vertex(v);
  };
  for (std::uint32_t f = 0; f < region_.faces.size(); ++f) {
    std::vector<Mesh::VertexHandle> corners;
    for (std::uint32_t i = 0; i < 3; ++i) {
      Mesh::VertexHandle& handle = vertex_of_group[groups.group(3 * f + i)];
      if (!handle.is_valid()) handle = copy_of(region_.faces[f][i]);
      corners.push_back(handle);
    }
    auto face = mesh_.add_face(corners);
    if (!face.is_valid()) {
      // OpenMesh sees a complex edge or vertex where groups meet again: this face stands alone then.
      for (std::uint32_t i = 0; i < 3; ++i) corners[i] = copy_of(region_.faces[f][i]);
      face = mesh_.add_face(corners);
    }
    mesh_.property(chart_, face) = region_.charts[region_.chart_of_face[f]].value;
    mesh_.property(region_face_, face) = f + 1;
  }
  for (std::uint32_t v = 0; v < region_.points.size(); ++v)
    if (!present[v]) add_vertex(v);
}

Attribute* Patch::attribute(std::string_view name) {
  const auto it = std::find_if(attributes_.begin(), attributes_.end(),
                               [&](const Attribute& attribute) { return attribute.info.name == name; });
  return it == attributes_.end() ? nullptr : &*it;
}

bool Patch::on_outer_border(Mesh::VertexHandle v) const {
  return mesh_.property(key_, v) != 0 && region_.outer_border[mesh_.property(region_vertex_, v)];
}

}  // namespace ramcdb
