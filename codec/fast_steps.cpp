#include "codec/fast_steps.h"

#include "codec/varint.h"

namespace ramcdb::codec {

std::uint32_t FastStepReader::large() {
  const std::uint32_t above = side_.code_large(0);
  if (above > kMostLarge) throw Error(Errc::corrupt, "a chart has a vertex with more faces than any chart has");
  return kLargeDegree + above;
}

std::size_t FastStepReader::finish() const {
  coder_.finish();
  if (!state_.at_end() || words_.over()) throw Error(Errc::corrupt, "a chart's connectivity is cut short or damaged");
  return words_.position();
}

FastStepWriter::FastStepWriter(const Chart& chart, const HalfEdges& edges)
    : side_(coder_), guide_(chart, edges), degrees_(chart.positions.size(), 0) {
  for (const Triangle& face : chart.faces)
    for (const std::uint32_t v : face) ++degrees_[v];
  for (std::uint32_t v = 0; v < chart.border_count(); ++v) guide_.on_border(v);
  symbols_.reserve(chart.positions.size());
}

std::uint32_t FastStepWriter::put_degree(std::uint32_t context, std::uint32_t degree, std::uint32_t shift) {
  const bool large = degree + shift >= kLargeDegree;
  if (large) (void)side_.code_large(degree + shift - kLargeDegree);
  const std::uint32_t symbol = large ? kLargeSymbol : degree + shift;
  symbols_.push_back({static_cast<std::uint8_t>(context), static_cast<std::uint8_t>(symbol)});
  return degree;
}

std::uint32_t FastStepWriter::step_degree(const std::vector<FastNode>& nodes, std::uint32_t before,
                                          std::uint32_t pivot) {
  guide_.turn_to(before);
  const std::uint32_t context = step_context(nodes[before], nodes[pivot]);
  if (!guide_.apex_is_known()) return put_degree(context, degrees_[guide_.apex_vertex()], 0);
  symbols_.push_back({static_cast<std::uint8_t>(context), kJoinSymbol});
  ++joins_;
  return 0;
}

FastSide<RangeEncoder>::Join FastStepWriter::join_target(const std::vector<FastNode>& nodes, std::uint32_t used,
                                                         std::uint32_t before, std::uint32_t pivot) {
  const ChartGuide::Corner corner = guide_.apex_corner([&](std::uint32_t node) { return nodes[node].open > 0; });
  return side_.code_join(nodes, used, before, pivot, {corner.node, nodes[corner.node].open - 1 - corner.faces_after});
}

Buffer FastStepWriter::finish_symbols(const FastStepTables& tables) const {
  RansEncoder state;
  std::vector<std::uint16_t> words;
  for (std::size_t i = symbols_.size(); i-- > 0;)
    state.push(tables.table(symbols_[i].context), symbols_[i].symbol, words);
  Buffer out;
  put_fixed32(out, state.state());
  for (std::size_t i = words.size(); i-- > 0;) {
    out.push_back(static_cast<std::uint8_t>(words[i]));
    out.push_back(static_cast<std::uint8_t>(words[i] >> 8));
  }
  return out;
}

}  // namespace ramcdb::codec
