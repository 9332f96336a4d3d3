#include "codec/dense_guide.h"

#include <algorithm>

namespace ramcdb::codec {

ChartGuide::ChartGuide(const Chart& chart, const HalfEdges& edges) : chart_(chart), edges_(edges) {
  node_of_edge_.assign(edges.count(), kNone);
  edge_of_node_.reserve(chart.positions.size() + 64);
  local_.assign(chart.positions.size(), kNone);
  source_.reserve(chart.positions.size());
  face_edges_.reserve(chart.faces.size());
  for (std::uint32_t v = 0; v < chart.border_count(); ++v) place(v, v);
}

std::uint32_t ChartGuide::begin_fan(std::uint32_t before_pivot, std::uint32_t pivot) {
  at_ = edge_of_node_[before_pivot];
  const std::uint32_t last = edge_of_node_[pivot];
  std::uint32_t inside = 0;
  for (std::uint32_t out = HalfEdges::next(at_); out != last; out = HalfEdges::next(edges_.twin(out))) ++inside;
  return inside;
}

void ChartGuide::face_opened(std::uint32_t current, std::uint32_t new_node) {
  face_edges_.push_back(at_);
  set_edge(current, edges_.twin(HalfEdges::prev(at_)));
  at_ = edges_.twin(HalfEdges::next(at_));
  set_edge(new_node, at_);
}

void ChartGuide::fan_closed(std::uint32_t current) {
  face_edges_.push_back(at_);
  set_edge(current, edges_.twin(HalfEdges::prev(at_)));
}

std::array<LatticePoint, 3> ChartGuide::next_seed() {
  if (!seeds_known_) find_seeds();
  // Any face of a component that is done has all its vertices placed; one of a new component has none.
  while (local_[edges_.origin(seeds_.back())] != kNone) seeds_.pop_back();
  at_ = seeds_.back();
  const auto corner = [&](std::uint32_t h) { return chart_.positions[edges_.origin(h)]; };
  return {corner(at_), corner(HalfEdges::next(at_)), corner(HalfEdges::prev(at_))};
}

void ChartGuide::seed_placed(std::uint32_t first_vertex, std::uint32_t first_node) {
  face_edges_.push_back(at_);
  const std::array<std::uint32_t, 3> around{at_, HalfEdges::next(at_), HalfEdges::prev(at_)};
  // The front runs around the seed the other way: a-c, c-b, b-a.
  set_edge(first_node, edges_.twin(around[2]));
  set_edge(first_node + 1, edges_.twin(around[1]));
  set_edge(first_node + 2, edges_.twin(around[0]));
  for (std::uint32_t i = 0; i < 3; ++i) place(edges_.origin(around[i]), first_vertex + i);
}

LatticePoint ChartGuide::next_isolated(std::uint32_t vertex) {
  if (!isolated_known_) find_isolated();
  const std::uint32_t v = isolated_.back();
  isolated_.pop_back();
  place(v, vertex);
  return chart_.positions[v];
}

void ChartGuide::place(std::uint32_t chart_vertex, std::uint32_t vertex) {
  local_[chart_vertex] = vertex;
  source_.push_back(chart_vertex);
}

void ChartGuide::set_edge(std::uint32_t node, std::uint32_t half_edge) {
  if (node >= edge_of_node_.size()) edge_of_node_.resize(std::size_t{node} + 1, kNone);
  edge_of_node_[node] = half_edge;
  if (half_edge != kNone) node_of_edge_[half_edge] = node;
}

void ChartGuide::find_seeds() {
  seeds_known_ = true;
  struct Seed {
    std::array<LatticePoint, 3> corners;
    std::uint32_t first;
  };
  std::vector<Seed> seeds;
  for (std::uint32_t f = 0; f < chart_.faces.size(); ++f) {
    if (local_[chart_.faces[f][0]] != kNone) continue;
    Seed least{};
    for (std::uint32_t c = 0; c < 3; ++c) {
      const auto at = [&](std::uint32_t i) { return chart_.positions[chart_.faces[f][(c + i) % 3]]; };
      const Seed seed{{at(0), at(1), at(2)}, 3 * f + c};
      if (c == 0 || seed.corners < least.corners) least = seed;
    }
    seeds.push_back(least);
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) {
    return x.corners != y.corners ? x.corners > y.corners : x.first > y.first;
  });
  for (const Seed& seed : seeds) seeds_.push_back(seed.first);
}

void ChartGuide::find_isolated() {
  isolated_known_ = true;
  for (std::uint32_t v = 0; v < local_.size(); ++v)
    if (local_[v] == kNone) isolated_.push_back(v);
  std::sort(isolated_.begin(), isolated_.end(), [&](std::uint32_t x, std::uint32_t y) {
    return chart_.positions[x] != chart_.positions[y] ? chart_.positions[x] > chart_.positions[y] : x > y;
  });
}

}  // namespace ramcdb::codec
