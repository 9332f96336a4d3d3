#include "api/topology.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

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

/// One face's pass of an edge.
struct Pass {
  std::uint64_t edge;    ///< its vertices, the lower one first
  std::uint32_t corner;  ///< 3 * face + position of the pass's first vertex
  bool forward;          ///< from the lower vertex
  [[nodiscard]] std::uint32_t low() const { return static_cast<std::uint32_t>(edge >> 32); }
  [[nodiscard]] std::uint32_t high() const { return static_cast<std::uint32_t>(edge); }
};

/// By edge, then by corner: counted out to the lower vertices, where few are left to be sorted.
std::vector<Pass> sorted_passes(const std::vector<Triangle>& faces, std::size_t vertices) {
  std::vector<std::uint32_t> ends(vertices + 1, 0);
  const auto for_each_pass = [&](auto&& visit) {
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      if (is_degenerate(faces[f])) continue;
      for (std::uint32_t i = 0; i < 3; ++i) visit(faces[f][i], faces[f][(i + 1) % 3], 3 * f + i);
    }
  };
  for_each_pass([&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++ends[std::min(a, b) + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Pass> passes(ends.back());
  for_each_pass([&](std::uint32_t a, std::uint32_t b, std::uint32_t corner) {
    passes[ends[std::min(a, b)]++] = {(std::uint64_t{std::min(a, b)} << 32) | std::max(a, b), corner, a < b};
  });
  for (std::size_t v = 0, first = 0; v < vertices; first = ends[v++])
    std::sort(passes.begin() + static_cast<std::ptrdiff_t>(first), passes.begin() + ends[v],
              [](const Pass& a, const Pass& b) { return a.edge != b.edge ? a.edge < b.edge : a.corner < b.corner; });
  return passes;
}

/// Calls `edge` with all passes of one edge, edge after edge.
template <class Visit>
void for_each_edge(const std::vector<Pass>& passes, Visit&& edge) {
  for (std::size_t begin = 0, end; begin < passes.size(); begin = end) {
    for (end = begin; end < passes.size() && passes[end].edge == passes[begin].edge;) ++end;
    edge(std::span(passes).subspan(begin, end - begin));
  }
}

/// How often faces pass an edge either way. What a polygon passes both ways is inside it.
struct Passes {
  std::size_t forward = 0, backward = 0;

  Passes(const chartify::IndexedMesh& mesh, std::span<const Pass> edge) {
    if (mesh.polygon_of_face.empty()) {
      for (const Pass& pass : edge) ++(pass.forward ? forward : backward);
      return;
    }
    std::map<std::uint32_t, std::ptrdiff_t> net;
    for (const Pass& pass : edge) net[mesh.polygon_of_face[pass.corner / 3]] += pass.forward ? 1 : -1;
    for (const auto& [polygon, count] : net)
      (count > 0 ? forward : backward) += static_cast<std::size_t>(std::abs(count));
  }
  [[nodiscard]] std::size_t all() const { return forward + backward; }
};

/// Vertices whose face corners stay in several groups after corners are joined over every edge at the vertex.
std::uint64_t count_nonmanifold_vertices(const chartify::IndexedMesh& mesh, const std::vector<Pass>& passes,
                                         const Scope& scope) {
  DisjointSets corners(mesh.faces.size() * 3);
  std::vector<bool> on_bad_edge(mesh.positions.size(), false);
  const auto corner_at = [&](std::uint32_t corner, std::uint32_t vertex) {
    const std::uint32_t face = corner / 3, i = corner % 3;
    return mesh.faces[face][i] == vertex ? corner : 3 * face + (i + 1) % 3;
  };
  for_each_edge(passes, [&](std::span<const Pass> edge) {
    const bool is_bad = edge.size() > 2 && Passes(mesh, edge).all() > 2;
    for (const std::uint32_t v : {edge[0].low(), edge[0].high()}) {
      for (const Pass& pass : edge) corners.join(corner_at(edge[0].corner, v), corner_at(pass.corner, v));
      on_bad_edge[v] = on_bad_edge[v] || is_bad;
    }
  });
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> group(mesh.positions.size(), kNone);
  std::vector<bool> split(mesh.positions.size(), false);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (is_degenerate(mesh.faces[f])) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.faces[f][i], root = corners.root(3 * f + i);
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

std::uint64_t count_duplicates(const chartify::IndexedMesh& mesh, const Scope& scope) {
  if (mesh.polygon_of_face.empty()) {
    std::vector<Triangle> sorted;
    std::ranges::copy_if(mesh.faces, std::back_inserter(sorted), [&](const Triangle& t) { return scope.has(t); });
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    return count_equal(sorted);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> vertices_of;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) vertices_of[mesh.polygon_of_face[f]].push_back(v);
  std::vector<std::vector<std::uint32_t>> sorted;
  for (auto& [polygon, vertices] : vertices_of) {
    std::sort(vertices.begin(), vertices.end());
    if (vertices.size() > 3) vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    sorted.push_back(std::move(vertices));
  }
  return count_equal(sorted);
}

Topology analyze_in(const chartify::IndexedMesh& mesh, const Scope& scope) {
  Topology t;
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face) used[v] = true;
    t.degenerate_faces += is_degenerate(face);
  }
  t.isolated_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
  const std::vector<Pass> passes = sorted_passes(mesh.faces, mesh.positions.size());
  for_each_edge(passes, [&](std::span<const Pass> edge) {
    if (!scope.has(std::array{edge[0].low(), edge[0].high()})) return;
    const Passes by_faces(mesh, edge);
    t.nonmanifold_edges += by_faces.all() > 2;
    t.inconsistent_edges += by_faces.all() == 2 && by_faces.forward != 1;
  });
  t.nonmanifold_vertices = count_nonmanifold_vertices(mesh, passes, scope);
  t.duplicate_faces = count_duplicates(mesh, scope);
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

Topology analyze(const chartify::IndexedMesh& mesh) { return analyze_in(mesh, {}); }

Topology analyze_own(const chartify::IndexedMesh& part, std::span<const std::uint8_t> shared) {
  return analyze_in(part, {shared, false});
}

Topology analyze_shared(const chartify::IndexedMesh& surroundings, std::span<const std::uint8_t> shared) {
  Topology t = analyze_in(surroundings, {shared, true});
  t.degenerate_faces = t.isolated_vertices = 0;  // the parts have them
  return t;
}

}  // namespace ramcdb::detail
