#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_residuals.h"
#include "codec/fast_tables.h"

/// Positions from their neighbours, as one run over all places. With P = pivot, a vertex is guessed at
///
///   P + floor((w1 (q1 - P) + ... + w6 (q6 - P) + 128) / 256)
///
/// where q1 ... q6 are the vertices around the place and w the weights of its predictor. All of it wraps around at
/// 2^32, in both directions alike, so no lattice is too wide for it; but when edges are so long that products would
/// wrap, the sum is made in 64 bits.
namespace ramcdb::codec {

/// The fourth number is 0.
using FastPosition = Unsigned4;
[[nodiscard]] inline FastPosition fast_position(LatticePoint p) {
  return FastPosition{static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), static_cast<std::uint32_t>(p.z),
                      0};
}

/// Whether positions within `box` and `border` may be too far apart for sums of 32 bits.
[[nodiscard]] bool needs_wide_sums(const LatticeBox& box, std::span<const LatticePoint> border);

/// How far the guesses for all places miss `positions`; 0 for free places.
[[nodiscard]] std::vector<FastResidual> misses(const FastPlan& plan, std::uint32_t border,
                                               std::span<const FastPosition> positions, const ReadyWeights& weights,
                                               bool wide);

/// The other way round: completes `positions`, of which the border is known, and takes the raw bits of `misses`.
/// `free`: one point for each free place.
void place_all(const FastPlan& plan, std::uint32_t border, ResidualTokens& misses, std::span<const LatticePoint> free,
               const ReadyWeights& weights, bool wide, RawArray<FastPosition>& positions);

/// The same as plain points. Throws corrupt when an inner vertex lies outside of `box`.
[[nodiscard]] std::vector<LatticePoint> checked_points(const RawArray<FastPosition>& positions, std::uint32_t border,
                                                       const LatticeBox& box);

}  // namespace ramcdb::codec
