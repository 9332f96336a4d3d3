#include "chartify/wire_net_builder.h"

#include <algorithm>
#include <utility>

#include "chartify/cut_surface.h"
#include "chartify/parallel.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {
namespace {

/// Which vertices end wires.
class CornerFinder {
 public:
  CornerFinder(const IndexedMesh& mesh, const CutSurface& surface, std::span<const FixedWire> fixed,
               std::span<const std::uint32_t> corners)
      : surface_(surface), mesh_(mesh), edges_at_(mesh.positions.size()), corner_(mesh.positions.size(), 0) {
    for (const std::uint32_t v : corners) corner_[v] = 1;
    for (const FixedWire& wire : fixed) corner_[wire.vertices.front()] = corner_[wire.vertices.back()] = 1;
  }

  std::vector<std::uint8_t> run() {
    for (const HalfEdge h : surface_.borders()) add_edge(h);
    for (const HalfEdge h : surface_.borders()) check_pass(h);
    for (std::size_t v = 0; v < corner_.size(); ++v)
      if (edges_at_[v].first != kNone && !goes_on(edges_at_[v])) corner_[v] = 1;
    close_rings();
    return std::move(corner_);
  }

 private:
  struct TwoEdges {
    std::uint32_t first = kNone, second = kNone;
  };

  /// Whether a wire may run over both edges: those of a fixed wire in turn, or two that are on none.
  [[nodiscard]] bool goes_on(const TwoEdges& two) const {
    if (two.second == kNone) return false;
    const WireOrigin a = surface_.origin_of(two.first), b = surface_.origin_of(two.second);
    return a.fixed == b.fixed && (a.fixed == kNone || a.first + 1 == b.first || b.first + 1 == a.first);
  }

  void add_edge(HalfEdge h) {
    const std::uint32_t edge = surface_.edge_of(h), u = surface_.start_of(h), v = surface_.end_of(h);
    if (u == v) corner_[u] = 1;
    for (const std::uint32_t end : {u, v}) {
      TwoEdges& two = edges_at_[end];
      if (two.first == kNone)
        two.first = edge;
      else if (two.first != edge && two.second == kNone)
        two.second = edge;
      else if (two.first != edge && two.second != edge)
        corner_[end] = 1;
    }
  }

  /// A loop that turns back on the edge on which it came ends a wire there.
  void check_pass(HalfEdge h) {
    const HalfEdge next = surface_.next_on_border(h);
    if (surface_.edge_of(next) == surface_.edge_of(h)) corner_[surface_.end_of(h)] = 1;
  }

  /// A ring of cut edges without a corner gets one at its smallest position.
  void close_rings() {
    std::vector<bool> seen(3 * mesh_.faces.size(), false);
    for (const HalfEdge h : surface_.borders()) {
      if (seen[h]) continue;
      bool has_corner = false;
      std::uint32_t smallest = surface_.start_of(h);
      for (HalfEdge g = h; !seen[g]; g = surface_.next_on_border(g)) {
        seen[g] = true;
        const std::uint32_t v = surface_.start_of(g);
        has_corner = has_corner || corner_[v];
        if (std::pair(mesh_.positions[v], v) < std::pair(mesh_.positions[smallest], smallest)) smallest = v;
      }
      if (!has_corner) corner_[smallest] = 1;
    }
  }

  const CutSurface& surface_;
  const IndexedMesh& mesh_;
  std::vector<TwoEdges> edges_at_;
  std::vector<std::uint8_t> corner_;
};

class Builder {
 public:
  Builder(const IndexedMesh& mesh, Adjacency adjacency, const Charts& charts, std::span<const FixedWire> fixed,
          std::span<const std::uint32_t> corners, unsigned threads)
      : mesh_(mesh),
        charts_(charts),
        fixed_(fixed),
        threads_(threads),
        surface_(mesh, std::move(adjacency), charts.chart_of_face, fixed, corners),
        is_corner_(CornerFinder(mesh, surface_, fixed, corners).run()),
        wire_of_edge_(surface_.edge_count(), kNone),
        corner_of_(mesh.positions.size(), kNone),
        local_of_fan_(surface_.fan_count(), kNone),
        on_loop_(3 * mesh.faces.size(), false) {}

  WireNet run() {
    net_.charts.resize(charts_.chart_count);
    std::vector<std::vector<HalfEdge>> borders(charts_.chart_count);
    for (const HalfEdge h : surface_.borders()) borders[charts_.chart_of_face[face_of(h)]].push_back(h);
    for (std::uint32_t c = 0; c < charts_.chart_count; ++c)
      for (const HalfEdge h : borders[c])
        if (!on_loop_[h]) add_loop(net_.charts[c], c, canonical_start(h));
    std::vector<std::vector<std::uint32_t>> faces(charts_.chart_count);
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) faces[charts_.chart_of_face[f]].push_back(f);
    parallel_for(charts_.chart_count, threads_, [&](std::size_t c) { fill(net_.charts[c], faces[c]); });
    add_isolated_vertices();
    return std::move(net_);
  }

 private:
  /// Its faces and the vertices inside it. What is on loops is there already; nothing here is another chart's.
  void fill(NetChart& chart, const std::vector<std::uint32_t>& faces) {
    chart.chart.faces.reserve(faces.size());
    for (const std::uint32_t f : faces) {
      Triangle t{};
      for (std::uint32_t i = 0; i < 3; ++i) t[i] = local_vertex(chart, 3 * f + i);
      chart.chart.faces.push_back(t);
    }
    chart.mesh_face = faces;
  }

  /// The smallest half-edge of a loop that starts at a corner.
  [[nodiscard]] HalfEdge canonical_start(HalfEdge on_loop) const {
    HalfEdge best = kNoTwin, h = on_loop;
    do {
      if (is_corner_[surface_.start_of(h)]) best = std::min(best, h);
      h = surface_.next_on_border(h);
    } while (h != on_loop);
    return best;
  }

  void add_loop(NetChart& chart, std::uint32_t index, HalfEdge start) {
    std::vector<NetLoopStep>& loop = chart.loops.emplace_back();
    std::uint32_t size = 0;
    HalfEdge h = start;
    do {
      pass_.clear();
      do {
        on_loop_[h] = true;
        pass_.push_back(h);
        (void)local_vertex(chart, h);
        h = surface_.next_on_border(h);
      } while (!is_corner_[surface_.start_of(h)]);
      loop.push_back(add_pass(index));
      size += static_cast<std::uint32_t>(pass_.size());
    } while (h != start);
    chart.chart.loop_sizes.push_back(size);
  }

  /// The wire that the half-edges of `pass_` run along; the first pass makes it.
  NetLoopStep add_pass(std::uint32_t chart) {
    const std::uint32_t first = surface_.edge_of(pass_.front());
    if (wire_of_edge_[first] == kNone) add_wire();
    NetWire& wire = net_.wires[wire_of_edge_[first]];
    wire.charts.push_back(chart);
    const bool same_start = surface_.start_of(pass_.front()) == wire.vertices[0];
    const bool same_second = surface_.end_of(pass_.front()) == wire.vertices[1];
    return {wire_of_edge_[first], !(same_start && same_second)};
  }

  void add_wire() {
    NetWire wire;
    for (const HalfEdge h : pass_) {
      wire_of_edge_[surface_.edge_of(h)] = static_cast<std::uint32_t>(net_.wires.size());
      wire.vertices.push_back(surface_.start_of(h));
    }
    wire.vertices.push_back(surface_.end_of(pass_.back()));
    net_.origin.push_back(surface_.origin_of(surface_.edge_of(pass_.front())));
    if (runs_against(pass_.front())) {
      std::reverse(wire.vertices.begin(), wire.vertices.end());
      net_.origin.back() = surface_.origin_of(surface_.edge_of(pass_.back()));
    }
    wire.begin_corner = corner_at(wire.vertices.front());
    wire.end_corner = corner_at(wire.vertices.back());
    net_.wires.push_back(std::move(wire));
  }

  /// Whether a half-edge on a fixed wire passes it backwards.
  [[nodiscard]] bool runs_against(HalfEdge h) const {
    const WireOrigin origin = surface_.origin_of(surface_.edge_of(h));
    return origin.fixed != kNone && fixed_[origin.fixed].vertices[origin.first] != surface_.start_of(h);
  }

  std::uint32_t corner_at(std::uint32_t vertex) {
    if (corner_of_[vertex] == kNone) {
      corner_of_[vertex] = static_cast<std::uint32_t>(net_.corners.size());
      net_.corners.push_back(vertex);
    }
    return corner_of_[vertex];
  }

  std::uint32_t local_vertex(NetChart& chart, HalfEdge h) {
    std::uint32_t& local = local_of_fan_[surface_.fan_of(h)];
    if (local == kNone) local = add_vertex(chart, surface_.start_of(h));
    return local;
  }

  std::uint32_t add_vertex(NetChart& chart, std::uint32_t vertex) const {
    chart.mesh_vertex.push_back(vertex);
    chart.chart.positions.push_back(mesh_.positions[vertex]);
    return static_cast<std::uint32_t>(chart.mesh_vertex.size() - 1);
  }

  void add_isolated_vertices() {
    std::vector<std::uint8_t> used(mesh_.positions.size(), 0);
    for (const Triangle& t : mesh_.faces)
      for (const std::uint32_t v : t) used[v] = 1;
    std::size_t next = 0;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (!used[v]) (void)add_vertex(net_.charts[charts_.chart_of_isolated_vertex[next++]], v);
  }

  const IndexedMesh& mesh_;
  const Charts& charts_;
  std::span<const FixedWire> fixed_;
  unsigned threads_;
  CutSurface surface_;
  std::vector<std::uint8_t> is_corner_;
  std::vector<std::uint32_t> wire_of_edge_, corner_of_, local_of_fan_;
  std::vector<bool> on_loop_;
  std::vector<HalfEdge> pass_;
  WireNet net_;
};

}  // namespace

WireNet build_wire_net(const IndexedMesh& mesh, const Charts& charts, std::span<const FixedWire> fixed,
                       std::span<const std::uint32_t> corners) {
  return Builder(mesh, Adjacency(mesh), charts, fixed, corners, 1).run();
}

WireNet build_wire_net(const IndexedMesh& mesh, Adjacency adjacency, const Charts& charts, unsigned threads) {
  return Builder(mesh, std::move(adjacency), charts, {}, {}, threads).run();
}

}  // namespace ramcdb::chartify
