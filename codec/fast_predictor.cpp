#include "codec/fast_predictor.h"

#include <bit>

namespace ramcdb::codec {

namespace {

using Weights = ReadyWeights::value_type;

/// 32 bits.
struct NarrowSum {
  RAMCDB_INLINE static FastPosition guess(const FastPlace& place, const FastPosition* positions, const Weights& w) {
    const Unsigned4 p = positions[place.pivot];
    Unsigned4 sum = Unsigned4{} + 128;
    for (std::size_t k = 0; k < 6; ++k)
      sum += (positions[place.around[k]] - p) * (Unsigned4{} + static_cast<std::uint32_t>(w[k]));
    return p + std::bit_cast<Unsigned4>(std::bit_cast<Int4>(sum) >> 8);
  }
};

/// 64 bits: ways are shorter than 2^32, and the weights below 2^11 in all.
struct WideSum {
  static FastPosition guess(const FastPlace& place, const FastPosition* positions, const Weights& w) {
    const Unsigned4 p = positions[place.pivot];
    Unsigned4 guess = p;
    for (int a = 0; a < 3; ++a) {
      std::int64_t sum = 128;
      for (std::size_t k = 0; k < 6; ++k)
        sum += std::int64_t{static_cast<std::int32_t>(positions[place.around[k]][a] - p[a])} * w[k];
      guess[a] += static_cast<std::uint32_t>(sum >> 8);
    }
    return guess;
  }
};

template <class Sum>
void find_misses(const FastPlan& plan, const FastPosition* positions, const FastPosition* inner,
                 const ReadyWeights& weights, std::vector<FastResidual>& misses) {
  for (std::size_t i = 0; i < misses.size(); ++i)
    if (const FastPlace& place = plan.places[i]; place.predictor != kFreePlace)
      misses[i] = std::bit_cast<Int4>(inner[i] - Sum::guess(place, positions, weights[place.predictor]));
}

template <class Sum>
RAMCDB_INLINE void place(const FastPlan& plan, std::uint32_t border, ResidualTokens& misses, const LatticePoint* free,
                         const ReadyWeights& weights, FastPosition* positions) {
  RawBitReader raw = misses.raw;  // so that it may live in registers
  const std::uint32_t* tokens = misses.of_vertex.data() + border;
  FastPosition* position = positions + border;
  for (const FastPlace& place : plan.places) {
    if (place.predictor == kFreePlace) [[unlikely]] {
      *position = fast_position(*free++);
    } else {
      const Unsigned4 zigzag = take_numbers(raw, *tokens);
      *position = Sum::guess(place, positions, weights[place.predictor]) + (zigzag >> 1 ^ -(zigzag & 1));
    }
    ++tokens;
    ++position;
  }
  misses.raw = raw;
}

}  // namespace

bool needs_wide_sums(const LatticeBox& box, std::span<const LatticePoint> border) {
  LatticeBox all = box;
  for (const LatticePoint p : border) all.add(p);
  constexpr std::int64_t kNarrow = std::int64_t{1} << 20;
  for (int a = 0; a < 3; ++a)
    if (std::int64_t{all.hi[a]} - all.lo[a] >= kNarrow) return true;
  return false;
}

std::vector<FastResidual> misses(const FastPlan& plan, std::uint32_t border, std::span<const FastPosition> positions,
                                 const ReadyWeights& weights, bool wide) {
  std::vector<FastResidual> residuals(plan.places.size());
  const auto find = wide ? find_misses<WideSum> : find_misses<NarrowSum>;
  find(plan, positions.data(), positions.data() + border, weights, residuals);
  return residuals;
}

RAMCDB_FAST_CLONES
void place_all(const FastPlan& plan, std::uint32_t border, ResidualTokens& misses, std::span<const LatticePoint> free,
               const ReadyWeights& weights, bool wide, RawArray<FastPosition>& positions) {
  if (wide)
    place<WideSum>(plan, border, misses, free.data(), weights, positions.data());
  else
    place<NarrowSum>(plan, border, misses, free.data(), weights, positions.data());
}

RAMCDB_FAST_CLONES
std::vector<LatticePoint> checked_points(const RawArray<FastPosition>& positions, std::uint32_t border,
                                         const LatticeBox& box) {
  std::vector<LatticePoint> points(positions.size());
  const Int4 lowest{box.lo.x, box.lo.y, box.lo.z, 0}, highest{box.hi.x, box.hi.y, box.hi.z, 0};
  Int4 outside{};
  const auto copy = [&](std::size_t v) {
    const Int4 p = std::bit_cast<Int4>(positions[v]);
    points[v] = {p[0], p[1], p[2]};
    return p;
  };
  for (std::size_t v = 0; v < border; ++v) (void)copy(v);
  for (std::size_t v = border; v < points.size(); ++v) {
    const Int4 p = copy(v);
    outside |= (p < lowest) | (p > highest);
  }
  if (outside[0] != 0 || outside[1] != 0 || outside[2] != 0)
    throw Error(Errc::corrupt, "a chart's vertex lies outside of the chart's range");
  return points;
}

}  // namespace ramcdb::codec
