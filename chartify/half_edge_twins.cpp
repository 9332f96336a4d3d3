#include "chartify/half_edge_twins.h"

#include <algorithm>
#include <array>
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

/// A half-edge among those at its lower end, in one number: the higher end, then the half-edge.
using Spoke = std::uint64_t;
std::uint32_t high_of(Spoke spoke) { return static_cast<std::uint32_t>(spoke >> 32); }
HalfEdge half_edge_of(Spoke spoke) { return static_cast<HalfEdge>(spoke); }

template <class Visit>
void for_each_spoke(const IndexedMesh& mesh, Visit&& visit) {
  HalfEdge h = 0;
  for (const Triangle& t : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i, ++h) {
      const std::uint32_t a = t[i], b = t[i == 2 ? 0 : i + 1];
      visit(std::min(a, b), Spoke{std::max(a, b)} << 32 | h);
    }
}

/// Half-edges by their lower ends. \param ends per vertex gets where its spokes end
std::vector<Spoke> spokes_by_vertex(const IndexedMesh& mesh, std::vector<std::uint32_t>& ends) {
  ends.assign(mesh.positions.size() + 1, 0);
  for_each_spoke(mesh, [&](std::uint32_t low, Spoke) { ++ends[low + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Spoke> spokes(3 * mesh.faces.size());
  for_each_spoke(mesh, [&](std::uint32_t low, Spoke spoke) { spokes[ends[low]++] = spoke; });
  return spokes;
}

/// Most vertices have so few spokes that counting the smaller ones, which needs no branches, is the quickest way.
void sort_spokes(std::span<Spoke> spokes) {
  constexpr std::size_t kFew = 16;
  if (spokes.size() > kFew) return std::sort(spokes.begin(), spokes.end());
  std::array<Spoke, kFew> sorted;
  for (const Spoke spoke : spokes) {
    std::size_t smaller = 0;
    for (const Spoke other : spokes) smaller += other < spoke;
    sorted[smaller] = spoke;
  }
  std::copy_n(sorted.begin(), spokes.size(), spokes.begin());
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
  std::vector<std::uint32_t> ends;
  std::vector<Spoke> spokes = spokes_by_vertex(mesh, ends);
  EdgeGroups groups;
  groups.half_edges.resize(spokes.size());
  groups.edge_of.resize(spokes.size());
  groups.first.reserve(spokes.size() / 2 + mesh.positions.size() / 16);
  std::uint32_t i = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    sort_spokes(std::span(spokes).subspan(i, ends[v] - i));
    for (std::uint32_t before = kNone; i < ends[v]; ++i) {
      if (high_of(spokes[i]) != before) groups.first.push_back(i);
      before = high_of(spokes[i]);
      groups.half_edges[i] = half_edge_of(spokes[i]);
      groups.edge_of[half_edge_of(spokes[i])] = static_cast<std::uint32_t>(groups.first.size() - 1);
    }
  }
  groups.first.push_back(i);
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
