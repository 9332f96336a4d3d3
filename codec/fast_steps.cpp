#include "codec/fast_steps.h"

#include "codec/near_order.h"

namespace ramcdb::codec {

// ---- reading ----

std::vector<std::uint8_t> take_degrees(ByteReader& reader, std::uint32_t border, std::uint32_t inner,
                                       const FastStepTables& tables) {
  std::array<RansDecoder, kRansLanes> all;
  const std::span states = std::span(all).first(rans_lanes(std::size_t{border} + inner));
  for (RansDecoder& state : states) state = RansDecoder(reader.fixed32());
  WordReader words(reader.rest());
  std::vector<std::uint8_t> symbols(std::size_t{border} + inner + 1);
  pop_run(states, tables[kBorderContext], words, std::span(symbols).first(border));
  pop_run(states, tables[kInnerContext], words, std::span(symbols).subspan(border, inner));
  symbols.back() = kJoinSymbol;
  for (const RansDecoder& state : states)
    if (!state.at_end() || words.over()) reader.fail("has a connectivity that is cut short or damaged");
  (void)reader.take(words.position());
  return symbols;
}

std::uint32_t FastStepReader::large() {
  const std::uint32_t above = side_.code_large(0);
  if (above > kMostLarge) throw Error(Errc::corrupt, "a chart has a vertex with more faces than any chart has");
  return kLargeDegree + above;
}

void FastStepReader::take_free() {
  const std::uint64_t start = coder_.position();
  last_free_ = side_.code_free(last_free_, {});
  free_points_.push_back(last_free_);
  free_cost_ += coder_.position() - start;
}

// ---- writing ----

FastStepWriter::FastStepWriter(const Chart& chart, const HalfEdges& edges, LatticePoint origin)
    : chart_(chart),
      side_(coder_),
      guide_(chart, edges),
      border_(chart.border_count()),
      degrees_(chart.positions.size(), 0),
      last_free_(origin) {
  for (const Triangle& face : chart.faces)
    for (const std::uint32_t v : face) ++degrees_[v];
  for (std::uint32_t v = 0; v < border_; ++v) guide_.on_border(v);
  for (std::uint32_t v = border_; v < degrees_.size(); ++v)
    if (degrees_[v] == 0) isolated_.push_back(v);
  isolated_ = near_order(chart.positions, isolated_);
  symbols_.reserve(chart.positions.size());
}

std::uint32_t FastStepWriter::put_degree(std::uint32_t degree, std::uint32_t shift) {
  const bool large = degree + shift >= kLargeDegree;
  if (large) (void)side_.code_large(degree + shift - kLargeDegree);
  symbols_.push_back(static_cast<std::uint8_t>(large ? kLargeSymbol : degree + shift));
  return degree;
}

std::uint32_t FastStepWriter::step_degree(std::uint32_t before) {
  guide_.turn_to(before);
  if (!guide_.apex_is_known()) return put_degree(degrees_[guide_.apex_vertex()], 0);
  symbols_.push_back(kJoinSymbol);
  ++joins_;
  return 0;
}

FastSide<RangeEncoder>::Join FastStepWriter::join_target(std::span<FastNode> nodes, const FastNode& before,
                                                         const FastNode& pivot) {
  const ChartGuide::Corner corner = guide_.apex_corner([&](std::uint32_t node) { return nodes[node].open > 0; });
  FastNode& there = nodes[corner.node];
  return side_.code_join(nodes, before, pivot, {&there, there.open - 1 - corner.faces_after});
}

void FastStepWriter::seed_placed(std::uint32_t first_vertex, std::uint32_t first_node) {
  (void)guide_.next_seed();
  guide_.seed_placed(first_vertex, first_node);
  for (std::uint32_t i = 0; i < 3; ++i) put_free(guide_.source_vertices()[first_vertex + i]);
}

void FastStepWriter::isolated_placed(std::uint32_t vertex) {
  put_free(isolated_[vertex - guide_.source_vertices().size()]);
}

void FastStepWriter::put_free(std::uint32_t chart_vertex) {
  last_free_ = side_.code_free(last_free_, chart_.positions[chart_vertex]);
}

std::vector<std::uint32_t> FastStepWriter::source_vertices() const {
  std::vector<std::uint32_t> all = guide_.source_vertices();
  all.insert(all.end(), isolated_.begin(), isolated_.end());
  return all;
}

Buffer FastStepWriter::finish_degrees(const FastStepTables& tables) const {
  std::array<RansEncoder, kRansLanes> all;
  const std::span states = std::span(all).first(rans_lanes(symbols_.size()));
  std::vector<std::uint16_t> words;
  push_run(states, tables[kInnerContext], std::span(symbols_).subspan(border_), words);
  push_run(states, tables[kBorderContext], std::span(symbols_).first(border_), words);
  Buffer out;
  for (const RansEncoder& state : states) put_fixed32(out, state.state());
  put_words(out, words);
  return out;
}

}  // namespace ramcdb::codec
