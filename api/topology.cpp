#include "api/topology.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <map>
#include <span>
#include <vector>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

using chartify::HalfEdge;

/// What of a mesh is counted.
struct Scope {
  std::span<const std::uint8_t> shared = {};  ///< empty: no vertex is
  bool of_shared = false;                     ///< what is between shared vertices only, or all else

  [[nodiscard]] bool has(std::uint32_t vertex) const { return shared.empty() || (shared[vertex] != 0) == of_shared; }
  [[nodiscard]] bool has(std::span<const std::uint32_t> vertices) const {
    const bool all = std::ranges::all_of(vertices, [&](std::uint32_t v) { return !shared.empty() && shared[v]; });
    return all == of_shared;
  }
};

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// The mesh with what meets at its edges. Half-edges of degenerate faces count in nothing.
class Surface {
 public:
  Surface(const chartify::IndexedMesh& mesh, const chartify::Adjacency& adjacency)
      : mesh_(mesh), adjacency_(adjacency), has_degenerate_(std::ranges::any_of(mesh.faces, is_degenerate)) {}

  [[nodiscard]] const chartify::IndexedMesh& mesh() const { return mesh_; }
  [[nodiscard]] HalfEdge twin(HalfEdge h) const { return adjacency_.twins[h]; }
  [[nodiscard]] std::uint32_t start_of(HalfEdge h) const { return mesh_.faces[h / 3][h % 3]; }
  [[nodiscard]] std::uint32_t end_of(HalfEdge h) const { return start_of(chartify::next_in_face(h)); }
  [[nodiscard]] std::uint32_t across(HalfEdge h) const { return start_of(chartify::previous_in_face(h)); }
  [[nodiscard]] bool is_forward(HalfEdge h) const { return start_of(h) < end_of(h); }

  /// Calls `visit` with all half-edges of one edge, ascending, edge after edge.
  void for_each_edge(auto&& visit) const {
    std::vector<HalfEdge> kept;
    const chartify::EdgeGroups& edges = adjacency_.edges;
    for (std::size_t e = 0; e < edges.edge_count(); ++e) {
      const auto all = std::span(edges.half_edges).subspan(edges.first[e], edges.first[e + 1] - edges.first[e]);
      if (!has_degenerate_) {
        visit(all);
        continue;
      }
      kept.clear();
      std::ranges::copy_if(all, std::back_inserter(kept),
                           [&](HalfEdge h) { return !is_degenerate(mesh_.faces[h / 3]); });
      if (!kept.empty()) visit(std::span<const HalfEdge>(kept));
    }
  }

 private:
  const chartify::IndexedMesh& mesh_;
  const chartify::Adjacency& adjacency_;
  bool has_degenerate_;
};

/// How often faces pass an edge either way. What a polygon passes both ways is inside it.
struct Passes {
  std::size_t forward = 0, backward = 0;

  Passes(const Surface& surface, std::span<const HalfEdge> edge) {
    const std::vector<std::uint32_t>& polygon_of_face = surface.mesh().polygon_of_face;
    if (polygon_of_face.empty()) {
      for (const HalfEdge h : edge) ++(surface.is_forward(h) ? forward : backward);
      return;
    }
    std::map<std::uint32_t, std::ptrdiff_t> net;
    for (const HalfEdge h : edge) net[polygon_of_face[h / 3]] += surface.is_forward(h) ? 1 : -1;
    for (const auto& [polygon, count] : net)
      (count > 0 ? forward : backward) += static_cast<std::size_t>(std::abs(count));
  }
  [[nodiscard]] std::size_t all() const { return forward + backward; }
};

/// Which vertices have face corners that twins alone do not join to one fan.
std::vector<bool> vertices_of_many_fans(const Surface& surface) {
  const chartify::IndexedMesh& mesh = surface.mesh();
  std::vector<std::uint32_t> corners(mesh.positions.size(), 0);
  std::vector<HalfEdge> leaving(mesh.positions.size(), chartify::kNoTwin);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (is_degenerate(mesh.faces[f])) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      ++corners[mesh.faces[f][i]];
      leaving[mesh.faces[f][i]] = 3 * f + i;
    }
  }
  std::vector<bool> many(mesh.positions.size(), false);
  for (std::size_t v = 0; v < many.size(); ++v) {
    if (corners[v] == 0) continue;
    const HalfEdge first = leaving[v];
    std::uint32_t met = 1;
    HalfEdge h = surface.twin(chartify::previous_in_face(first));
    for (; h != chartify::kNoTwin && h != first; h = surface.twin(chartify::previous_in_face(h))) ++met;
    if (h == chartify::kNoTwin)
      for (h = surface.twin(first); h != chartify::kNoTwin; h = surface.twin(chartify::next_in_face(h))) ++met;
    many[v] = met != corners[v];
  }
  return many;
}

/// Vertices whose face corners stay in several groups after corners are joined over every edge at the vertex.
std::uint64_t count_nonmanifold_vertices(const Surface& surface, const Scope& scope) {
  const chartify::IndexedMesh& mesh = surface.mesh();
  const std::vector<bool> many = vertices_of_many_fans(surface);
  if (std::ranges::find(many, true) == many.end()) return 0;
  DisjointSets corners(mesh.faces.size() * 3);
  std::vector<bool> on_bad_edge(mesh.positions.size(), false);
  const auto corner_at = [&](HalfEdge h, std::uint32_t vertex) {
    return surface.start_of(h) == vertex ? h : chartify::next_in_face(h);
  };
  surface.for_each_edge([&](std::span<const HalfEdge> edge) {
    const std::array ends{surface.start_of(edge[0]), surface.end_of(edge[0])};
    if (!many[ends[0]] && !many[ends[1]]) return;
    const bool is_bad = edge.size() > 2 && Passes(surface, edge).all() > 2;
    for (const std::uint32_t v : ends) {
      for (const HalfEdge h : edge) corners.join(corner_at(edge[0], v), corner_at(h, v));
      on_bad_edge[v] = on_bad_edge[v] || is_bad;
    }
  });
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> group(mesh.positions.size(), kNone);
  std::vector<bool> split(mesh.positions.size(), false);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (is_degenerate(mesh.faces[f])) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.faces[f][i];
      if (!many[v]) continue;
      const std::uint32_t root = corners.root(3 * f + i);
      if (group[v] == kNone) group[v] = root;
      if (group[v] != root && !on_bad_edge[v] && scope.has(v)) split[v] = true;
    }
  }
  return static_cast<std::uint64_t>(std::count(split.begin(), split.end(), true));
}

std::uint64_t count_equal(auto& sets) {
  std::sort(sets.begin(), sets.end());
  std::uint64_t equal = 0;
  for (std::size_t i = 1; i < sets.size(); ++i) equal += sets[i] == sets[i - 1];
  return equal;
}

/// Equal triangles meet at the edge between their two lowest vertices.
std::uint64_t count_equal_triangles(const Surface& surface, const Scope& scope) {
  std::uint64_t equal = 0;
  std::vector<std::uint32_t> tops;
  surface.for_each_edge([&](std::span<const HalfEdge> edge) {
    if (edge.size() < 2) return;
    tops.clear();
    for (const HalfEdge h : edge)
      if (surface.across(h) > std::max(surface.start_of(h), surface.end_of(h)) &&
          scope.has(surface.mesh().faces[h / 3]))
        tops.push_back(surface.across(h));
    equal += count_equal(tops);
  });
  std::vector<Triangle> degenerate;
  std::ranges::copy_if(surface.mesh().faces, std::back_inserter(degenerate),
                       [&](const Triangle& t) { return is_degenerate(t) && scope.has(t); });
  for (Triangle& t : degenerate) std::sort(t.begin(), t.end());
  return equal + count_equal(degenerate);
}

std::uint64_t count_duplicates(const Surface& surface, const Scope& scope) {
  const chartify::IndexedMesh& mesh = surface.mesh();
  if (mesh.polygon_of_face.empty()) return count_equal_triangles(surface, scope);
  std::map<std::uint32_t, std::vector<std::uint32_t>> vertices_of;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) vertices_of[mesh.polygon_of_face[f]].push_back(v);
  std::vector<std::vector<std::uint32_t>> sorted;
  for (auto& [polygon, vertices] : vertices_of) {
    std::sort(vertices.begin(), vertices.end());
    if (vertices.size() > 3) vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (scope.has(vertices)) sorted.push_back(std::move(vertices));
  }
  return count_equal(sorted);
}

Topology analyze_in(const chartify::IndexedMesh& mesh, const chartify::Adjacency& adjacency, const Scope& scope) {
  Topology t;
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face) used[v] = true;
    t.degenerate_faces += is_degenerate(face);
  }
  t.isolated_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
  const Surface surface(mesh, adjacency);
  surface.for_each_edge([&](std::span<const HalfEdge> edge) {
    if (!scope.has(std::array{surface.start_of(edge[0]), surface.end_of(edge[0])})) return;
    const Passes by_faces(surface, edge);
    t.nonmanifold_edges += by_faces.all() > 2;
    t.inconsistent_edges += by_faces.all() == 2 && by_faces.forward != 1;
  });
  t.nonmanifold_vertices = count_nonmanifold_vertices(surface, scope);
  t.duplicate_faces = count_duplicates(surface, scope);
  return t;
}

}  // namespace

Topology& Topology::operator+=(const Topology& other) {
  nonmanifold_edges += other.nonmanifold_edges;
  nonmanifold_vertices += other.nonmanifold_vertices;
  inconsistent_edges += other.inconsistent_edges;
  degenerate_faces += other.degenerate_faces;
  duplicate_faces += other.duplicate_faces;
  isolated_vertices += other.isolated_vertices;
  return *this;
}

Topology analyze(const chartify::IndexedMesh& mesh, const chartify::Adjacency& adjacency) {
  return analyze_in(mesh, adjacency, {});
}

Topology analyze(const chartify::IndexedMesh& mesh) { return analyze(mesh, chartify::Adjacency(mesh)); }

Topology analyze_own(const chartify::IndexedMesh& part, std::span<const std::uint8_t> shared) {
  return analyze_in(part, chartify::Adjacency(part), {shared, false});
}

Topology analyze_shared(const chartify::IndexedMesh& surroundings, std::span<const std::uint8_t> shared) {
  Topology t = analyze_in(surroundings, chartify::Adjacency(surroundings), {shared, true});
  t.degenerate_faces = t.isolated_vertices = 0;  // the parts have them
  return t;
}

}  // namespace ramcdb::detail
