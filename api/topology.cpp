#include "api/topology.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

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
std::uint64_t count_nonmanifold_vertices(const chartify::IndexedMesh& mesh, const std::vector<Pass>& passes) {
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
      if (group[v] != root && !on_bad_edge[v]) split[v] = true;
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

std::uint64_t count_duplicates(const chartify::IndexedMesh& mesh) {
  if (mesh.polygon_of_face.empty()) {
    std::vector<Triangle> sorted(mesh.faces);
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

}  // namespace

Topology analyze(const chartify::IndexedMesh& mesh) {
  Topology t;
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face) used[v] = true;
    t.degenerate_faces += is_degenerate(face);
  }
  t.isolated_vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
  const std::vector<Pass> passes = sorted_passes(mesh.faces, mesh.positions.size());
  for_each_edge(passes, [&](std::span<const Pass> edge) {
    const Passes by_faces(mesh, edge);
    t.nonmanifold_edges += by_faces.all() > 2;
    t.inconsistent_edges += by_faces.all() == 2 && by_faces.forward != 1;
  });
  t.nonmanifold_vertices = count_nonmanifold_vertices(mesh, passes);
  t.duplicate_faces = count_duplicates(mesh);
  return t;
}

}  // namespace ramcdb::detail
