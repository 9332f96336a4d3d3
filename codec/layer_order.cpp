#include "codec/layer_order.h"

#include "codec/half_edges.h"

namespace ramcdb::codec {

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
