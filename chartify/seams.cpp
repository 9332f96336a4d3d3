#include "chartify/seams.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "chartify/cut_surface.h"

namespace ramcdb::chartify {
namespace {

/// From numbers in the whole mesh to vertices of a part, for those that it shares.
class SharedIndex {
 public:
  explicit SharedIndex(const MeshPart& part) {
    for (std::uint32_t v = 0; v < part.number.size(); ++v)
      if (part.shared[v]) entries_.emplace_back(part.number[v], v);
    std::sort(entries_.begin(), entries_.end());
  }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t number) const {
    return std::lower_bound(entries_.begin(), entries_.end(), std::pair(number, std::uint32_t{0}))->second;
  }
  [[nodiscard]] const std::vector<std::pair<std::uint32_t, std::uint32_t>>& entries() const { return entries_; }

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> entries_;
};

template <class Value>
void sort_unique(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Walks seams into wires.
class SeamJoiner {
 public:
  SeamJoiner(const std::vector<Seam>& seams, SharedEnds ends,
             const std::function<LatticePoint(std::uint32_t)>& position)
      : seams_(seams), position_(position), done_(seams.size(), false) {
    for (std::uint32_t s = 0; s < seams.size(); ++s)
      for (const std::uint32_t v : seams[s].edge) at_vertex_.push_back({v, s});
    sort_unique(at_vertex_);
    find_corners(std::move(ends));
  }

  SeamNet run() {
    for (const auto& [v, s] : at_vertex_)
      if (!done_[s] && is_corner(v)) add_wire(v, s);
    for (std::uint32_t s = 0; s < seams_.size(); ++s)
      if (!done_[s]) add_ring(s);
    std::ranges::copy(ring_corners_, std::back_inserter(net_.corners));
    sort_unique(net_.corners);
    return std::move(net_);
  }

 private:
  using Entry = std::array<std::uint32_t, 2>;

  [[nodiscard]] std::span<const Entry> seams_at(std::uint32_t v) const {
    const auto begin = std::lower_bound(at_vertex_.begin(), at_vertex_.end(), Entry{v, 0});
    auto end = begin;
    while (end != at_vertex_.end() && (*end)[0] == v) ++end;
    return {begin, end};
  }

  /// Where other than two cut edges meet, or the two are not seams of the same parts.
  void find_corners(SharedEnds ends) {
    net_.corners = std::move(ends.corners);
    sort_unique(ends.cut_edges);
    for (std::size_t begin = 0, end = 0; begin < ends.cut_edges.size(); begin = end) {
      while (end < ends.cut_edges.size() && ends.cut_edges[end][0] == ends.cut_edges[begin][0]) ++end;
      if (end - begin != 2) net_.corners.push_back(ends.cut_edges[begin][0]);
    }
    for (std::size_t begin = 0, end = 0; begin < at_vertex_.size(); begin = end) {
      while (end < at_vertex_.size() && at_vertex_[end][0] == at_vertex_[begin][0]) ++end;
      const bool goes_on =
          end - begin == 2 && seams_[at_vertex_[begin][1]].parts == seams_[at_vertex_[begin + 1][1]].parts;
      if (!goes_on) net_.corners.push_back(at_vertex_[begin][0]);
    }
    sort_unique(net_.corners);
  }

  [[nodiscard]] bool is_corner(std::uint32_t v) const { return std::ranges::binary_search(net_.corners, v); }

  [[nodiscard]] std::uint32_t other_end(std::uint32_t v, std::uint32_t seam) const {
    const NumberedEdge& edge = seams_[seam].edge;
    return edge[0] == v ? edge[1] : edge[0];
  }

  /// From a corner on, or once around.
  void add_wire(std::uint32_t begin, std::uint32_t first) {
    SeamWire wire{{begin}, seams_[first].parts};
    for (std::uint32_t v = begin, s = first;;) {
      done_[s] = true;
      v = other_end(v, s);
      wire.vertices.push_back(v);
      if (v == begin || is_corner(v)) break;
      const auto here = seams_at(v);
      s = here[0][1] == s ? here[1][1] : here[0][1];
    }
    if (runs_backwards(wire.vertices)) std::reverse(wire.vertices.begin(), wire.vertices.end());
    net_.wires.push_back(std::move(wire));
  }

  /// Wires run so that their direction does not hang on how vertices are numbered.
  [[nodiscard]] bool runs_backwards(const std::vector<std::uint32_t>& vertices) const {
    for (std::size_t i = 0, j = vertices.size() - 1; i < j; ++i, --j) {
      const LatticePoint front = position_(vertices[i]), back = position_(vertices[j]);
      if (front != back) return back < front;
    }
    return false;
  }

  /// A ring without a corner gets one at its smallest position.
  void add_ring(std::uint32_t first) {
    const std::uint32_t begin = seams_[first].edge[0];
    std::pair best(position_(begin), begin);
    std::uint32_t v = begin, s = first;
    do {
      v = other_end(v, s);
      best = std::min(best, std::pair(position_(v), v));
      const auto here = seams_at(v);
      s = here[0][1] == s ? here[1][1] : here[0][1];
    } while (v != begin);
    ring_corners_.push_back(best.second);
    add_wire(best.second, seams_at(best.second)[0][1]);
  }

  const std::vector<Seam>& seams_;
  const std::function<LatticePoint(std::uint32_t)>& position_;
  std::vector<Entry> at_vertex_;  ///< a vertex and a seam there
  std::vector<bool> done_;
  std::vector<std::uint32_t> ring_corners_;
  SeamNet net_;
};

}  // namespace

std::vector<NumberedEdge> edges_between_shared(const MeshPart& part) {
  std::vector<NumberedEdge> edges;
  for (const Triangle& t : part.mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = t[i], v = t[(i + 1) % 3];
      if (!part.shared[u] || !part.shared[v]) continue;
      edges.push_back({std::min(part.number[u], part.number[v]), std::max(part.number[u], part.number[v])});
    }
  sort_unique(edges);
  return edges;
}

SharedEnds find_shared_ends(const MeshPart& part, std::span<const NumberedEdge> seams) {
  const SharedIndex index(part);
  std::vector<FixedWire> fixed;
  std::vector<std::uint8_t> on_seam(part.number.size(), 0);
  for (const NumberedEdge& edge : seams) {
    fixed.push_back({{index.vertex(edge[0]), index.vertex(edge[1])}});
    for (const std::uint32_t v : fixed.back().vertices) on_seam[v] = 1;
  }
  SharedEnds ends;
  std::vector<std::uint32_t> touched;  // others have these in just the vertex
  for (const auto& [number, v] : index.entries()) {
    if (on_seam[v]) continue;
    touched.push_back(v);
    ends.corners.push_back(number);
  }
  const CutSurface surface(part.mesh, Adjacency(part.mesh), part.charts.chart_of_face, fixed, touched);
  for (HalfEdge h = 0; h < 3 * part.mesh.faces.size(); ++h) {
    if (!surface.is_border(h)) continue;
    const std::uint32_t u = surface.start_of(h), v = surface.end_of(h);
    if (part.shared[u]) ends.cut_edges.push_back({part.number[u], part.number[v]});
    if (!part.shared[v]) continue;
    ends.cut_edges.push_back({part.number[v], part.number[u]});
    const bool turns_back = surface.edge_of(surface.next_on_border(h)) == surface.edge_of(h);
    if (u == v || turns_back) ends.corners.push_back(part.number[v]);
  }
  sort_unique(ends.cut_edges);
  return ends;
}

SeamNet join_seams(const std::vector<Seam>& seams, SharedEnds ends,
                   const std::function<LatticePoint(std::uint32_t)>& position) {
  return SeamJoiner(seams, std::move(ends), position).run();
}

PartSeams seams_of(const MeshPart& part, const SeamNet& net, std::span<const std::uint32_t> wires) {
  const SharedIndex index(part);
  PartSeams out;
  out.wire.assign(wires.begin(), wires.end());
  for (const std::uint32_t w : wires) {
    FixedWire& fixed = out.wires.emplace_back();
    for (const std::uint32_t number : net.wires[w].vertices) fixed.vertices.push_back(index.vertex(number));
  }
  for (const auto& [number, v] : index.entries())
    if (std::ranges::binary_search(net.corners, number)) out.corners.push_back(v);
  return out;
}

}  // namespace ramcdb::chartify
