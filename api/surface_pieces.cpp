#include "api/surface_pieces.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNoPiece = ~std::uint32_t{0};

/// Charts come leaf by leaf.
class SurfaceCounter {
 public:
  void add(const LeafPage& leaf) {
    for (const PageChart& chart : leaf.charts) add_pieces(leaf, chart);
    for (const PageWire& wire : leaf.wires)
      if (wire.charts.size() == 1 && !is_point(wire)) add_boundary(wire);
  }

  [[nodiscard]] SurfaceCounts counts() const { return counts_; }

 private:
  /// The edge of a degenerate face from a vertex to itself.
  static bool is_point(const PageWire& wire) { return wire.begin == wire.end && wire.inner_points == 0; }

  void add_pieces(const LeafPage& leaf, const PageChart& chart) {
    counts_.components += chart.pieces.closed;
    std::vector<std::uint32_t> nodes;
    for (std::size_t l = 0; l < chart.loops.size(); ++l) {
      const std::uint32_t piece = chart.pieces.of_loop[l];
      if (piece == nodes.size()) {
        nodes.push_back(pieces_.add());
        ++counts_.components;
      }
      for (const DirectedWire step : chart.loops[l]) {
        const PageWire& wire = *find_wire(leaf, step.wire);
        join(nodes[piece], wire_piece_.emplace(wire.id, nodes[piece]).first->second);
        for (const CornerId corner : {wire.begin, wire.end})
          join(nodes[piece], corner_piece_.emplace(corner, nodes[piece]).first->second);
      }
    }
  }

  void join(std::uint32_t a, std::uint32_t b) { counts_.components -= pieces_.join(a, b); }

  /// The one chart that passes it is of one leaf, so it comes once.
  void add_boundary(const PageWire& wire) {
    const auto node = [&](CornerId corner) {
      const auto [it, is_new] = boundary_corner_.emplace(corner, 0);
      if (is_new) it->second = boundary_.add();
      counts_.boundary_loops += is_new;
      return it->second;
    };
    const std::uint32_t begin = node(wire.begin), end = node(wire.end);
    counts_.boundary_loops -= boundary_.join(begin, end);
  }

  SurfaceCounts counts_;
  DisjointSets pieces_, boundary_;
  std::unordered_map<WireId, std::uint32_t> wire_piece_;
  std::unordered_map<CornerId, std::uint32_t> corner_piece_, boundary_corner_;
};

}  // namespace

ChartPieces pieces_of(const Chart& chart) {
  DisjointSets sets(chart.positions.size());
  for (const Triangle& t : chart.faces) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  ChartPieces pieces;
  std::vector<std::uint32_t> piece_of(chart.positions.size(), kNoPiece);
  std::uint32_t first = 0, count = 0;
  for (const std::uint32_t size : chart.loop_sizes) {
    std::uint32_t& piece = piece_of[sets.root(first)];
    if (piece == kNoPiece) piece = count++;
    pieces.of_loop.push_back(piece);
    first += size;
  }
  for (const Triangle& t : chart.faces) {
    std::uint32_t& piece = piece_of[sets.root(t[0])];
    if (piece != kNoPiece) continue;
    piece = count++;
    ++pieces.closed;
  }
  return pieces;
}

SurfaceCounts count_surfaces(const PageIndex& pages) {
  SurfaceCounter counter;
  pages.visit([](const LatticeBox&) { return true; }, [&](const LeafRef& ref) { counter.add(*ref.leaf); });
  return counter.counts();
}

}  // namespace ramcdb::detail
