#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "codec/dense_guide.h"
#include "codec/fast_plan.h"
#include "codec/fast_rans.h"
#include "codec/fast_tables.h"
#include "codec/range_coder.h"

/// What FastWalk asks for, from a stream (FastStepReader) or from a chart (FastStepWriter).
///
/// Degrees are symbols of a static range coder; what does not fit into one, and where joins go, is coded on the side,
/// adaptively.
namespace ramcdb::codec {

/// The contexts that symbols are coded in. Steps: by how many faces the two corners at hand still take.
inline std::uint32_t step_context(const FastNode& before, const FastNode& pivot) {
  return (std::min(pivot.open, 5u) - 2) * 4 + std::min(before.open, 5u) - 2;
}

/// Numbers that are rare: large degrees, and joins.
///
///   large = degree - kLargeDegree (step, seed) or - kLargeDegree + 1 (border)
///   join  = near:bit [backwards:bit] (distance | number) open_here - 1
///
/// distance: how many corners that could be joined lie between, from the pivot's next one forwards or from the one
/// before `before` backwards, when no more than kJoinReach corners are passed. number: counted back from the newest.
template <class Coder>
class FastSide {
 public:
  explicit FastSide(Coder& coder) : coder_(coder) {}

  std::uint32_t code_large(std::uint32_t above) { return large_.code(coder_, above); }

  struct Join {
    std::uint32_t there = 0;
    std::uint32_t open_here = 0;
  };
  Join code_join(const std::vector<FastNode>& nodes, std::uint32_t used, std::uint32_t before, std::uint32_t pivot,
                 Join join);

 private:
  static constexpr std::uint32_t kJoinReach = 255;
  static constexpr std::uint32_t kFar = ~std::uint32_t{0};

  static bool joinable(const FastNode& node) { return node.open >= 3; }
  /// How many joinable corners lie before `there` on the way that `step` takes from `from`; kFar beyond the reach.
  template <class Step>
  static std::uint32_t distance(const std::vector<FastNode>& nodes, std::uint32_t from, std::uint32_t there, Step step);
  template <class Step>
  static std::uint32_t at_distance(const std::vector<FastNode>& nodes, std::uint32_t from, std::uint32_t distance,
                                   Step step);

  Coder& coder_;
  AdaptiveBit near_{52000, 4};
  AdaptiveBit backwards_;
  AdaptiveUnsigned distance_[2];
  AdaptiveUnsigned number_;
  AdaptiveUnsigned open_here_;
  AdaptiveUnsigned large_;
};

template <class Coder>
template <class Step>
std::uint32_t FastSide<Coder>::distance(const std::vector<FastNode>& nodes, std::uint32_t from, std::uint32_t there,
                                        Step step) {
  std::uint32_t passed = 0;
  for (std::uint32_t i = 0, node = from; i < kJoinReach; ++i, node = step(nodes[node])) {
    if (node == there) return passed;
    passed += joinable(nodes[node]);
  }
  return kFar;
}

template <class Coder>
template <class Step>
std::uint32_t FastSide<Coder>::at_distance(const std::vector<FastNode>& nodes, std::uint32_t from,
                                           std::uint32_t distance, Step step) {
  for (std::uint32_t i = 0, node = from; i < kJoinReach; ++i, node = step(nodes[node]))
    if (joinable(nodes[node]) && distance-- == 0) return node;
  throw Error(Errc::corrupt, "a chart joins a corner out of reach");
}

template <class Coder>
typename FastSide<Coder>::Join FastSide<Coder>::code_join(const std::vector<FastNode>& nodes, std::uint32_t used,
                                                          std::uint32_t before, std::uint32_t pivot, Join join) {
  const auto forwards = [](const FastNode& node) { return node.next; };
  const auto backwards = [](const FastNode& node) { return node.prev; };
  const std::uint32_t ahead = nodes[nodes[pivot].next].next, back = nodes[nodes[before].prev].prev;
  std::uint32_t steps_ahead = kFar, steps_back = kFar;
  if constexpr (Coder::kEncodes) {
    steps_ahead = distance(nodes, ahead, join.there, forwards);
    steps_back = distance(nodes, back, join.there, backwards);
  }
  if (coder_.code(near_, std::min(steps_ahead, steps_back) != kFar)) {
    if (coder_.code(backwards_, steps_back < steps_ahead))
      join.there = at_distance(nodes, back, distance_[1].code(coder_, steps_back), backwards);
    else
      join.there = at_distance(nodes, ahead, distance_[0].code(coder_, steps_ahead), forwards);
  } else {
    const std::uint32_t number = number_.code(coder_, used - 1 - join.there);
    if (number >= used) throw Error(Errc::corrupt, "a chart joins a corner that it does not have");
    join.there = used - 1 - number;
  }
  join.open_here = 1 + (open_here_.code(coder_, join.open_here - 1) & 0x7fffffff);
  return join;
}

/// Reads the connectivity of a chart.
class FastStepReader {
 public:
  FastStepReader(Bytes side, RansDecoder state, WordReader words, const FastStepTables& tables)
      : coder_(side), side_(coder_), state_(state), words_(words), tables_(tables) {}

  std::uint32_t border_degree(std::uint32_t /*vertex*/) { return degree(kBorderContext) - 1; }
  std::uint32_t seed_degree(std::uint32_t /*vertex*/) { return degree(kSeedContext); }
  std::uint32_t step_degree(const std::vector<FastNode>& nodes, std::uint32_t before, std::uint32_t pivot) {
    const std::uint32_t symbol = pop(step_context(nodes[before], nodes[pivot]));
    return symbol == kLargeSymbol ? large() : symbol;
  }
  FastSide<RangeDecoder>::Join join_target(const std::vector<FastNode>& nodes, std::uint32_t used, std::uint32_t before,
                                           std::uint32_t pivot) {
    return side_.code_join(nodes, used, before, pivot, {});
  }
  void closed(std::uint32_t /*before*/) {}
  void vertex_placed(std::uint32_t /*before*/, std::uint32_t /*node*/, std::uint32_t /*vertex*/) {}
  void joined(std::uint32_t /*before*/, std::uint32_t /*here*/) {}
  void seed_placed(std::uint32_t /*first_vertex*/, std::uint32_t /*first_node*/) {}
  void isolated_placed(std::uint32_t /*vertex*/) {}

  /// How many bytes of words were taken. Throws corrupt unless all ended as a writer ends it.
  [[nodiscard]] std::size_t finish() const;

 private:
  std::uint32_t pop(std::uint32_t context) {
    const RansTable& table = tables_.table(context);
    return words_.has(1) ? state_.pop_sure(table, words_) : state_.pop(table, words_);
  }
  std::uint32_t degree(std::uint32_t context) {
    const std::uint32_t symbol = pop(context);
    if (symbol > kLargeSymbol) return symbol;
    if (symbol == kJoinSymbol) throw Error(Errc::corrupt, "a chart joins where it cannot");
    return large();
  }
  std::uint32_t large();

  RangeDecoder coder_;
  FastSide<RangeDecoder> side_;
  RansDecoder state_;
  WordReader words_;
  const FastStepTables& tables_;
};

/// Writes the connectivity of a chart, and remembers which vertex and face of it became which.
class FastStepWriter {
 public:
  FastStepWriter(const Chart& chart, const HalfEdges& edges);

  std::uint32_t border_degree(std::uint32_t vertex) { return put_degree(kBorderContext, degrees_[vertex], 1); }
  std::uint32_t seed_degree(std::uint32_t vertex) {
    return put_degree(kSeedContext, degrees_[guide_.source_vertices()[vertex]], 0);
  }
  std::uint32_t step_degree(const std::vector<FastNode>& nodes, std::uint32_t before, std::uint32_t pivot);
  FastSide<RangeEncoder>::Join join_target(const std::vector<FastNode>& nodes, std::uint32_t used, std::uint32_t before,
                                           std::uint32_t pivot);
  void closed(std::uint32_t before) {
    guide_.turn_to(before);
    guide_.fan_closed(before);
  }
  void vertex_placed(std::uint32_t before, std::uint32_t node, std::uint32_t vertex) {
    guide_.apex_placed(vertex);
    guide_.face_opened(before, node);
  }
  void joined(std::uint32_t before, std::uint32_t here) { guide_.face_opened(before, here); }
  void seed_placed(std::uint32_t first_vertex, std::uint32_t first_node) {
    (void)guide_.next_seed();
    guide_.seed_placed(first_vertex, first_node);
  }
  void isolated_placed(std::uint32_t vertex) { (void)guide_.next_isolated(vertex); }

  [[nodiscard]] const ChartGuide& guide() const { return guide_; }
  [[nodiscard]] std::uint32_t joins() const { return joins_; }
  /// What FastStepReader reads: the symbols, and apart from them what was coded on the side.
  [[nodiscard]] Buffer finish_symbols(const FastStepTables& tables) const;
  void count_symbols(std::array<std::array<std::uint64_t, kStepSymbols>, kStepContexts>& counts) const {
    for (const Symbol s : symbols_) ++counts[s.context][s.symbol];
  }
  [[nodiscard]] Buffer finish_side() { return coder_.finish(); }

 private:
  struct Symbol {
    std::uint8_t context = 0;
    std::uint8_t symbol = 0;
  };
  std::uint32_t put_degree(std::uint32_t context, std::uint32_t degree, std::uint32_t shift);

  RangeEncoder coder_;
  FastSide<RangeEncoder> side_;
  ChartGuide guide_;
  std::vector<std::uint32_t> degrees_;  ///< faces around each vertex of the chart
  std::vector<Symbol> symbols_;
  std::uint32_t joins_ = 0;
};

}  // namespace ramcdb::codec
