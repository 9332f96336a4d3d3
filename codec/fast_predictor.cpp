#include "codec/fast_predictor.h"

#include <bit>
#include <limits>
#include <utility>

namespace ramcdb::codec {

namespace {

/// 32 bits.
RAMCDB_INLINE Unsigned4 narrow_guess(const FastPlace& place, const FastPosition* positions, const PlaceWeights& w) {
  const Unsigned4 p = positions[place.pivot];
  Unsigned4 sum = Unsigned4{} + 128;
  for (std::size_t k = 0; k < 6; ++k)
    sum += (positions[place.around[k]] - p) * static_cast<std::uint32_t>(std::int32_t{w[k]});
  return p + std::bit_cast<Unsigned4>(std::bit_cast<Int4>(sum) >> 8);
}

/// 64 bits: ways are shorter than 2^32, and the weights below 2^11 in all.
Unsigned4 wide_guess(const FastPlace& place, const FastPosition* positions, const PlaceWeights& w) {
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

RAMCDB_INLINE FastPosition guess(const FastPlace& place, const FastPosition* positions, const FastWeights& weights,
                                 bool wide) {
  const PlaceWeights& w = weights[place.predictor];
  return wide ? wide_guess(place, positions, w) : narrow_guess(place, positions, w);
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
                                 const FastWeights& weights, bool wide) {
  std::vector<FastResidual> residuals(plan.places.size());
  for (std::size_t i = 0; i < residuals.size(); ++i)
    if (plan.places[i].predictor != kFreePlace)
      residuals[i] =
          std::bit_cast<Int4>(positions[border + i] - guess(plan.places[i], positions.data(), weights, wide));
  return residuals;
}

RAMCDB_FAST_CLONES
LatticeBox place_all(const FastPlan& plan, std::uint32_t border, ResidualReader& residuals,
                     std::span<const LatticePoint> free, const FastWeights& weights, bool wide,
                     std::vector<FastPosition>& positions) {
  ResidualReader reader = std::move(residuals);  // so that its states may live in registers
  FastPosition* const all = positions.data();
  const LatticePoint* next_free = free.data();
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  Int4 low = Int4{} + kMost, high = -low;
  const std::size_t count = plan.places.size();
  for (std::size_t i = 0; i < count; ++i) {
    const FastPlace& place = plan.places[i];
    if (place.predictor == kFreePlace) [[unlikely]] {
      all[border + i] = fast_position(*next_free++);
    } else {
      const FastResidual miss = reader.take(place, border + i);
      all[border + i] = guess(place, all, weights, wide) + std::bit_cast<Unsigned4>(miss);
    }
    const Int4 p = std::bit_cast<Int4>(all[border + i]);
    low = p < low ? p : low;
    high = p > high ? p : high;
  }
  residuals = std::move(reader);
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

}  // namespace ramcdb::codec
