#include "codec/fast_predictor.h"

namespace ramcdb::codec {

namespace {

template <class Sum>
FastPosition guess(const FastPlace& place, const std::vector<FastPosition>& positions, const FastWeights& weights) {
  const FastPosition& p = positions[place.pivot];
  const PlaceWeights& w = weights[place.predictor];
  std::array<Sum, 4> sum{128, 128, 128, 128};
  for (std::size_t k = 0; k < 6; ++k) {
    const FastPosition& q = positions[place.around[k]];
    for (std::size_t a = 0; a < 4; ++a)
      sum[a] += static_cast<Sum>(static_cast<std::int32_t>(q[a] - p[a])) * static_cast<Sum>(w[k]);
  }
  FastPosition result;
  for (std::size_t a = 0; a < 4; ++a)
    result[a] = p[a] + static_cast<std::uint32_t>(static_cast<std::make_signed_t<Sum>>(sum[a]) >> 8);
  return result;
}

FastPosition position_of(LatticePoint p) {
  return {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), static_cast<std::uint32_t>(p.z), 0};
}

/// Calls with_guess(i, guess) for all places in order.
template <class Sum, class WithGuess>
void for_all(const FastPlan& plan, std::uint32_t border, const std::vector<FastPosition>& positions,
             LatticePoint origin, const FastWeights& weights, const WithGuess& with_guess) {
  std::size_t first = 0;
  if (border == 0 && !plan.places.empty()) with_guess(first++, position_of(origin));
  for (std::size_t i = first; i < plan.places.size(); ++i)
    with_guess(i, guess<Sum>(plan.places[i], positions, weights));
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
  const auto miss = [&](std::size_t i, const FastPosition& guess) {
    for (std::size_t a = 0; a < 3; ++a)
      residuals[i][a] = static_cast<std::int32_t>(positions[border + i][a] - guess[a]);
  };
  if (wide)
    for_all<std::uint64_t>(plan, border, positions, origin, weights, miss);
  else
    for_all<std::uint32_t>(plan, border, positions, origin, weights, miss);
  return residuals;
}

void place_all(const FastPlan& plan, std::uint32_t border, const std::vector<FastResidual>& residuals,
               LatticePoint origin, const FastWeights& weights, bool wide, std::vector<FastPosition>& positions) {
  const auto put = [&](std::size_t i, const FastPosition& guess) {
    for (std::size_t a = 0; a < 3; ++a)
      positions[border + i][a] = guess[a] + static_cast<std::uint32_t>(residuals[i][a]);
  };
  if (wide)
    for_all<std::uint64_t>(plan, border, positions, origin, weights, put);
  else
    for_all<std::uint32_t>(plan, border, positions, origin, weights, put);
}

}  // namespace ramcdb::codec
