#include "codec/layer_order.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "codec/half_edges.h"

namespace ramcdb::codec {

namespace {

/// Pairs half-edges of faces that are no manifold surface.
class Pairing {
 public:
  explicit Pairing(const Chart& chart) : chart_(chart), twins_(3 * chart.faces.size(), LayerOrder::kNone) {
    std::vector<Edge> edges;
    for (std::uint32_t h = 0; h < twins_.size(); ++h) {
      const std::uint32_t from = origin(h), to = origin(LayerOrder::next(h));
      if (from != to) edges.push_back({std::min(from, to), std::max(from, to), h});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
    });
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      for (end = i; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;) ++end;
      if (end - i <= kMost) pair(std::span(edges).subspan(i, end - i));
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> take() && { return std::move(twins_); }

 private:
  static constexpr std::size_t kMost = 16;  ///< half-edges at one edge; more stay alone
  struct Edge {
    std::uint32_t low, high, half_edge;
  };

  [[nodiscard]] std::uint32_t origin(std::uint32_t h) const { return chart_.faces[h / 3][h % 3]; }
  [[nodiscard]] std::uint32_t apex(std::uint32_t h) const { return origin(LayerOrder::prev(h)); }

  /// First those that go on to another vertex, then a face and its mirror image.
  void pair(std::span<const Edge> edges) {
    for (const bool mirrored : {false, true})
      for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size() && twins_[edges[i].half_edge] == LayerOrder::kNone; ++j) {
          const std::uint32_t h = edges[i].half_edge, other = edges[j].half_edge;
          if (twins_[other] != LayerOrder::kNone || h / 3 == other / 3 || origin(h) == origin(other)) continue;
          if ((apex(h) == apex(other)) != mirrored) continue;
          twins_[h] = other;
          twins_[other] = h;
        }
  }

  const Chart& chart_;
  std::vector<std::uint32_t> twins_;
};

}  // namespace

LayerOrder::LayerOrder(const Chart& chart)
    : twins_(3 * chart.faces.size(), kNone),
      visits_(chart.faces.size(), kNone),
      reached_(chart.positions.size(), false) {
  vertices_.reserve(chart.positions.size());
  entries_.reserve(chart.faces.size());
  const auto border = chart.border_count();
  for (std::uint32_t v = 0; v < border; ++v) reach(v);
  if (const auto edges = HalfEdges::of(chart)) {
    for (std::uint32_t h = 0; h < edges->count(); ++h) twins_[h] = edges->twin(h);
    for (std::uint32_t v = 0; v < border; ++v) visit(chart, edges->at_border(v));
  } else {
    twins_ = Pairing(chart).take();
  }
  std::size_t done = 0;
  const auto visit_neighbours = [&] {
    for (; done < entries_.size(); ++done)
      for (const std::uint32_t c : {next(entries_[done]), prev(entries_[done])})
        if (twins_[c] != kNone) visit(chart, twins_[c]);
  };
  visit_neighbours();
  for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
    visit(chart, 3 * f);
    if (done == entries_.size()) continue;
    if (twins_[3 * f] != kNone) visit(chart, twins_[3 * f]);
    visit_neighbours();
  }
  for (std::uint32_t v = 0; v < chart.positions.size(); ++v) reach(v);
}

void LayerOrder::visit(const Chart& chart, std::uint32_t entry) {
  const std::uint32_t face = entry / 3;
  if (visits_[face] != kNone) return;
  visits_[face] = static_cast<std::uint32_t>(entries_.size());
  entries_.push_back(entry);
  for (const std::uint32_t c : {entry, next(entry), prev(entry)}) reach(chart.faces[face][c % 3]);
}

void LayerOrder::reach(std::uint32_t vertex) {
  if (reached_[vertex]) return;
  reached_[vertex] = true;
  vertices_.push_back(vertex);
}

}  // namespace ramcdb::codec
