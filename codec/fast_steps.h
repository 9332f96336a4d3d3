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
#include "codec/varint.h"

/// What FastWalk asks for, from a stream (FastStepReader) or from a chart (FastStepWriter).
///
/// Degrees are symbols that a static range coder has given in one go before the walk. What does not fit into one, where
/// joins go, and where vertices without neighbours lie, is coded on the side, adaptively.
///
///   degrees = state:4{1 or kRansLanes} word*
namespace ramcdb::codec {

/// Numbers that are rare: large degrees, joins, and vertices without neighbours.
///
///   large = degree - kLargeDegree (step, seed) or - kLargeDegree + 1 (border)
///   free  = x y z                          to the free vertex before, or the low corner of the box; modulo 2^32
///   join  = near:bit [backwards:bit] (distance | number) open_here - 1
///
/// distance: how many corners that could be joined lie between, from the pivot's next one forwards or from the one
/// before `before` backwards, when no more than kJoinReach corners are passed. number: counted back from the newest.
template <class Coder>
class FastSide {
 public:
  explicit FastSide(Coder& coder) : coder_(coder) {}

  std::uint32_t code_large(std::uint32_t above) { return large_.code(coder_, above); }

  LatticePoint code_free(LatticePoint before, LatticePoint point);

  struct Join {
    FastNode* there = nullptr;
    std::uint32_t open_here = 0;
  };
  /// \param nodes all that were made so far
  Join code_join(std::span<FastNode> nodes, const FastNode& before, const FastNode& pivot, Join join);

 private:
  static constexpr std::uint32_t kJoinReach = 255;
  static constexpr std::uint32_t kFar = ~std::uint32_t{0};

  static bool joinable(const FastNode& node) { return node.open >= 3; }
  /// How many joinable corners lie before `there` on the way that `step` takes from `from`; kFar beyond the reach.
  template <class Step>
  static std::uint32_t distance(const FastNode* from, const FastNode* there, Step step);
  template <class Step>
  static FastNode* at_distance(FastNode* from, std::uint32_t distance, Step step);

  Coder& coder_;
  AdaptiveBit near_{52000, 4};
  AdaptiveBit backwards_;
  AdaptiveUnsigned distance_[2];
  AdaptiveUnsigned number_;
  AdaptiveUnsigned open_here_;
  AdaptiveUnsigned large_;
  std::array<AdaptiveSigned, 3> free_;
};

template <class Coder>
LatticePoint FastSide<Coder>::code_free(LatticePoint before, LatticePoint point) {
  for (int a = 0; a < 3; ++a) {
    const auto from = static_cast<std::uint32_t>(before[a]);
    const std::uint32_t way = static_cast<std::uint32_t>(point[a]) - from;
    const std::int32_t coded = free_[static_cast<std::size_t>(a)].code(coder_, static_cast<std::int32_t>(way));
    point[a] = static_cast<std::int32_t>(from + static_cast<std::uint32_t>(coded));
  }
  return point;
}

template <class Coder>
template <class Step>
std::uint32_t FastSide<Coder>::distance(const FastNode* from, const FastNode* there, Step step) {
  std::uint32_t passed = 0;
  for (std::uint32_t i = 0; i < kJoinReach; ++i, from = step(*from)) {
    if (from == there) return passed;
    passed += joinable(*from);
  }
  return kFar;
}

template <class Coder>
template <class Step>
FastNode* FastSide<Coder>::at_distance(FastNode* from, std::uint32_t distance, Step step) {
  for (std::uint32_t i = 0; i < kJoinReach; ++i, from = step(*from))
    if (joinable(*from) && distance-- == 0) return from;
  throw Error(Errc::corrupt, "a chart joins a corner out of reach");
}

template <class Coder>
typename FastSide<Coder>::Join FastSide<Coder>::code_join(std::span<FastNode> nodes, const FastNode& before,
                                                          const FastNode& pivot, Join join) {
  const auto forwards = [](const FastNode& node) { return node.next; };
  const auto backwards = [](const FastNode& node) { return node.prev; };
  FastNode *const ahead = pivot.next->next, *const back = before.prev->prev;
  std::uint32_t steps_ahead = kFar, steps_back = kFar, number = 0;
  if constexpr (Coder::kEncodes) {
    steps_ahead = distance(ahead, join.there, forwards);
    steps_back = distance(back, join.there, backwards);
    number = static_cast<std::uint32_t>(&nodes.back() - join.there);
  }
  if (coder_.code(near_, std::min(steps_ahead, steps_back) != kFar)) {
    if (coder_.code(backwards_, steps_back < steps_ahead))
      join.there = at_distance(back, distance_[1].code(coder_, steps_back), backwards);
    else
      join.there = at_distance(ahead, distance_[0].code(coder_, steps_ahead), forwards);
  } else {
    number = number_.code(coder_, number);
    if (number >= nodes.size()) throw Error(Errc::corrupt, "a chart joins a corner that it does not have");
    join.there = &nodes[nodes.size() - 1 - number];
  }
  join.open_here = 1 + (open_here_.code(coder_, join.open_here - 1) & 0x7fffffff);
  return join;
}

/// Takes the symbols of `border` vertices and of `inner` other ones and joins. One more stands behind them for streams
/// that ask for too many: a join, which there are not so many of.
[[nodiscard]] std::vector<std::uint8_t> take_degrees(ByteReader& reader, std::uint32_t border, std::uint32_t inner,
                                                     const FastStepTables& tables);

/// Reads the connectivity of a chart.
class FastStepReader {
 public:
  /// \param symbols what take_degrees() gave; must outlive the reader
  FastStepReader(Bytes side, const std::vector<std::uint8_t>& symbols, LatticePoint origin)
      : coder_(side), side_(coder_), symbol_(symbols.data()), last_free_(origin) {}

  std::uint32_t border_degree(std::uint32_t /*vertex*/) { return degree() - 1; }
  std::uint32_t seed_degree(std::uint32_t /*vertex*/) { return degree(); }
  std::uint32_t step_degree(std::uint32_t /*before*/) {
    const std::uint32_t symbol = *symbol_++;
    return symbol == kLargeSymbol ? large() : symbol;
  }
  FastSide<RangeDecoder>::Join join_target(std::span<FastNode> nodes, const FastNode& before, const FastNode& pivot) {
    return side_.code_join(nodes, before, pivot, {});
  }
  void closed(std::uint32_t /*before*/) {}
  void vertex_placed(std::uint32_t /*before*/, std::uint32_t /*node*/, std::uint32_t /*vertex*/) {}
  void joined(std::uint32_t /*before*/, std::uint32_t /*here*/) {}
  void seed_placed(std::uint32_t /*first_vertex*/, std::uint32_t /*first_node*/) {
    for (int i = 0; i < 3; ++i) take_free();
  }
  void isolated_placed(std::uint32_t /*vertex*/) { take_free(); }

  /// Where vertices without neighbours lie, in their order.
  [[nodiscard]] const std::vector<LatticePoint>& free_points() const { return free_points_; }
  /// What they took, in 1/256 bit.
  [[nodiscard]] std::uint64_t free_cost() const { return free_cost_; }
  /// Throws corrupt unless the side ended as a writer ends it.
  void finish() const { coder_.finish(); }

 private:
  std::uint32_t degree() {
    const std::uint32_t symbol = *symbol_++;
    if (symbol > kLargeSymbol) return symbol;
    if (symbol == kJoinSymbol) throw Error(Errc::corrupt, "a chart joins where it cannot");
    return large();
  }
  std::uint32_t large();
  void take_free();

  RangeDecoder coder_;
  FastSide<RangeDecoder> side_;
  const std::uint8_t* symbol_;
  LatticePoint last_free_;
  std::vector<LatticePoint> free_points_;
  std::uint64_t free_cost_ = 0;
};

/// Writes the connectivity of a chart, and remembers which vertex and face of it became which.
class FastStepWriter {
 public:
  FastStepWriter(const Chart& chart, const HalfEdges& edges, LatticePoint origin);

  std::uint32_t border_degree(std::uint32_t vertex) { return put_degree(degrees_[vertex], 1); }
  std::uint32_t seed_degree(std::uint32_t vertex) { return put_degree(degrees_[guide_.source_vertices()[vertex]], 0); }
  std::uint32_t step_degree(std::uint32_t before);
  FastSide<RangeEncoder>::Join join_target(std::span<FastNode> nodes, const FastNode& before, const FastNode& pivot);
  void closed(std::uint32_t before) {
    guide_.turn_to(before);
    guide_.fan_closed(before);
  }
  void vertex_placed(std::uint32_t before, std::uint32_t node, std::uint32_t vertex) {
    guide_.apex_placed(vertex);
    guide_.face_opened(before, node);
  }
  void joined(std::uint32_t before, std::uint32_t here) { guide_.face_opened(before, here); }
  void seed_placed(std::uint32_t first_vertex, std::uint32_t first_node);
  void isolated_placed(std::uint32_t vertex);

  [[nodiscard]] const std::vector<std::uint32_t>& isolated() const { return isolated_; }
  [[nodiscard]] std::vector<std::uint32_t> source_vertices() const;
  [[nodiscard]] const std::vector<std::uint32_t>& source_faces() const { return guide_.source_faces(); }
  [[nodiscard]] std::uint32_t joins() const { return joins_; }
  /// What take_degrees() reads; apart from that, what was coded on the side.
  [[nodiscard]] Buffer finish_degrees(const FastStepTables& tables) const;
  [[nodiscard]] Buffer finish_side() { return coder_.finish(); }
  void count_symbols(std::array<std::array<std::uint64_t, kStepSymbols>, kStepContexts>& counts) const {
    for (std::size_t i = 0; i < symbols_.size(); ++i)
      ++counts[i < border_ ? kBorderContext : kInnerContext][symbols_[i]];
  }

 private:
  std::uint32_t put_degree(std::uint32_t degree, std::uint32_t shift);
  void put_free(std::uint32_t chart_vertex);

  const Chart& chart_;
  RangeEncoder coder_;
  FastSide<RangeEncoder> side_;
  ChartGuide guide_;
  std::uint32_t border_;
  std::vector<std::uint32_t> degrees_;   ///< faces around each vertex of the chart
  std::vector<std::uint32_t> isolated_;  ///< vertices of the chart without faces, in the order of coding
  std::vector<std::uint8_t> symbols_;
  LatticePoint last_free_;
  std::uint32_t joins_ = 0;
};

}  // namespace ramcdb::codec
