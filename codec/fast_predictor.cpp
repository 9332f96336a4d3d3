#include "codec/fast_predictor.h"

#include <bit>

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

/// Calls with_guess(i, guess) for all places in order.
template <class WithGuess>
RAMCDB_INLINE void for_all(const FastPlan& plan, const FastPosition* positions, std::uint32_t border,
                           LatticePoint origin, const FastWeights& weights, bool wide, const WithGuess& with_guess) {
  std::size_t first = 0;
  if (border == 0 && !plan.places.empty()) with_guess(first++, fast_position(origin));
  const std::size_t count = plan.places.size();
  const FastPlace* places = plan.places.data();
  if (wide)
    for (std::size_t i = first; i < count; ++i)
      with_guess(i, wide_guess(places[i], positions, weights[places[i].predictor]));
  else
    for (std::size_t i = first; i < count; ++i)
      with_guess(i, narrow_guess(places[i], positions, weights[places[i].predictor]));
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

std::vector<FastResidual> misses(const FastPlan& plan, std::uint32_t border, const std::vector<FastPosition>& positions,
                                 LatticePoint origin, const FastWeights& weights, bool wide) {
  std::vector<FastResidual> residuals(plan.places.size());
  for_all(plan, positions.data(), border, origin, weights, wide, [&](std::size_t i, FastPosition guess) {
    residuals[i] = std::bit_cast<Int4>(positions[border + i] - guess);
  });
  return residuals;
}

RAMCDB_FAST_CLONES
void place_all(const FastPlan& plan, std::uint32_t border, const std::vector<FastResidual>& residuals,
               LatticePoint origin, const FastWeights& weights, bool wide, std::vector<FastPosition>& positions) {
  FastPosition* const all = positions.data();
  for_all(plan, all, border, origin, weights, wide,
          [&](std::size_t i, FastPosition guess) { all[border + i] = guess + std::bit_cast<Unsigned4>(residuals[i]); });
}

}  // namespace ramcdb::codec
