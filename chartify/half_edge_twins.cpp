#include "chartify/half_edge_twins.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace ramcdb::chartify {
namespace {

/// Half-edges at one edge that are looked through for those of one polygon.
constexpr std::size_t kMostAtEdge = 64;

struct Ends {
  std::uint32_t low, high;
  friend auto operator<=>(const Ends&, const Ends&) = default;
};

Ends ends_of(const IndexedMesh& mesh, HalfEdge h) {
  const std::uint32_t a = mesh.faces[face_of(h)][h % 3], b = mesh.faces[face_of(h)][next_in_face(h) % 3];
  return {std::min(a, b), std::max(a, b)};
}

/// Stable counting sort of `order` by a key below `keys`.
template <class Key>
std::vector<HalfEdge> sort_by(const std::vector<HalfEdge>& order, std::size_t keys, Key&& key) {
  std::vector<std::uint32_t> at(keys + 1, 0);
  for (const HalfEdge h : order) ++at[key(h) + 1];
  std::partial_sum(at.begin(), at.end(), at.begin());
  std::vector<HalfEdge> sorted(order.size());
  for (const HalfEdge h : order) sorted[at[key(h)]++] = h;
  return sorted;
}

bool names_a_vertex_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Of several half-edges on an edge, those of one polygon are twins. A degenerate face would leave loops of one edge.
void join_polygons(const IndexedMesh& mesh, std::span<const HalfEdge> at_edge, std::vector<HalfEdge>& twins) {
  for (std::size_t i = 0; i < at_edge.size(); ++i)
    for (std::size_t j = i + 1; j < at_edge.size() && twins[at_edge[i]] == kNoTwin; ++j) {
      const HalfEdge a = at_edge[i], b = at_edge[j];
      const Triangle &one = mesh.faces[face_of(a)], &other = mesh.faces[face_of(b)];
      if (mesh.polygon_of_face[face_of(a)] != mesh.polygon_of_face[face_of(b)] || twins[b] != kNoTwin) continue;
      if (one[a % 3] == other[b % 3] || names_a_vertex_twice(one) || names_a_vertex_twice(other)) continue;
      twins[a] = b;
      twins[b] = a;
    }
}

}  // namespace

EdgeGroups group_half_edges(const IndexedMesh& mesh) {
  EdgeGroups groups;
  const std::size_t count = 3 * mesh.faces.size(), vertices = mesh.positions.size();
  std::vector<HalfEdge> order(count);
  std::iota(order.begin(), order.end(), 0U);
  order = sort_by(order, vertices, [&](HalfEdge h) { return ends_of(mesh, h).high; });
  groups.half_edges = sort_by(order, vertices, [&](HalfEdge h) { return ends_of(mesh, h).low; });
  groups.edge_of.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const HalfEdge h = groups.half_edges[i];
    if (i == 0 || !(ends_of(mesh, h) == ends_of(mesh, groups.half_edges[i - 1])))
      groups.first.push_back(static_cast<std::uint32_t>(i));
    groups.edge_of[h] = static_cast<std::uint32_t>(groups.first.size() - 1);
  }
  groups.first.push_back(static_cast<std::uint32_t>(count));
  return groups;
}

std::uint32_t find_edge(const IndexedMesh& mesh, const EdgeGroups& edges, std::uint32_t u, std::uint32_t v) {
  const Ends wanted{std::min(u, v), std::max(u, v)};
  const auto ends = [&](std::uint32_t first) { return ends_of(mesh, edges.half_edges[first]); };
  const auto last = edges.first.end() - 1;
  const auto found = std::lower_bound(edges.first.begin(), last, wanted,
                                      [&](std::uint32_t first, const Ends& e) { return ends(first) < e; });
  return found == last || ends(*found) != wanted ? kNone : static_cast<std::uint32_t>(found - edges.first.begin());
}

std::vector<HalfEdge> find_twins(const IndexedMesh& mesh, const EdgeGroups& edges) {
  std::vector<HalfEdge> twins(edges.edge_of.size(), kNoTwin);
  for (std::size_t e = 0; e < edges.edge_count(); ++e) {
    const auto at_edge = std::span(edges.half_edges).subspan(edges.first[e], edges.first[e + 1] - edges.first[e]);
    if (at_edge.size() > 2 && at_edge.size() <= kMostAtEdge && !mesh.polygon_of_face.empty())
      join_polygons(mesh, at_edge, twins);
    if (at_edge.size() != 2) continue;
    const HalfEdge a = at_edge[0], b = at_edge[1];
    if (face_of(a) == face_of(b) || mesh.faces[face_of(a)][a % 3] == mesh.faces[face_of(b)][b % 3]) continue;
    twins[a] = b;
    twins[b] = a;
  }
  return twins;
}

}  // namespace ramcdb::chartify
