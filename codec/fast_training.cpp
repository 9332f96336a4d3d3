#include "codec/fast_training.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "codec/fast_steps.h"
#include "codec/fast_walk.h"
#include "codec/least_squares.h"
#include "codec/range_coder.h"

namespace ramcdb::codec {

namespace {

constexpr int kPasses = 6;
/// A class with fewer vertices keeps the weights that it started from.
constexpr std::uint64_t kEnough = 24;
/// How much the weights at the start are worth, in vertices.
constexpr double kPull = 12;
/// Counts of each symbol that the frequencies at the start are worth, in all.
constexpr std::uint64_t kSymbolPull = 200;

/// What the tables of a context and of a class take, about, in 1/256 bit.
constexpr std::int64_t kContextCost = 256 * 90, kClassCost = 256 * 45;

/// Of a symbol with this frequency, but for a constant; in 1/256 bit.
std::int64_t cost_of(std::uint32_t frequency) {
  return -static_cast<std::int64_t>(range_coder_detail::log2_256(frequency));
}

std::array<double, 6> unscaled(const PlaceWeights& weights) {
  std::array<double, 6> out;
  for (std::size_t k = 0; k < 6; ++k) out[k] = weights[k] / 256.0;
  return out;
}

}  // namespace

void FastTrainer::add(const Chart& chart) {
  const std::optional<HalfEdges> edges = HalfEdges::of(chart);
  if (!edges) return;
  const std::uint32_t border = chart.border_count();
  const auto inner = static_cast<std::uint32_t>(chart.positions.size()) - border;
  const auto faces = static_cast<std::uint32_t>(chart.faces.size());
  FastStepWriter steps(chart, *edges);
  const FastPlan plan = FastWalk(steps, FastOutline{chart.loop_sizes, {inner, faces}, faces}).run();
  steps.count_symbols(symbols_);
  const auto at = [&](std::uint32_t vertex) { return chart.positions[steps.guide().source_vertices()[vertex]]; };
  for (std::uint32_t i = 0; i < inner; ++i) {
    const FastPlace& place = plan.places[i];
    if (place.trust == kFastFree) continue;
    const LatticePoint pivot = at(place.pivot), vertex = at(border + i);
    Sample& sample = samples_.emplace_back();
    sample.predictor = place.predictor;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      sample.target[axis] = static_cast<float>(std::int64_t{vertex[a]} - pivot[a]);
      for (std::size_t k = 0; k < 6; ++k)
        sample.around[k][axis] = static_cast<float>(std::int64_t{at(place.around[k])[a]} - pivot[a]);
    }
  }
}

FastTables FastTrainer::learn() const { return FastTables(learn_steps(), learn_weights()); }

StepFrequencies FastTrainer::learn_steps() const {
  StepFrequencies frequencies = start_.steps();
  for (std::size_t c = 0; c < kStepContexts; ++c) {
    std::array<std::uint64_t, kStepSymbols> weights{};
    for (std::size_t s = 0; s < kStepSymbols; ++s)
      weights[s] = symbols_[c][s] * kRansTotal + kSymbolPull * start_.steps()[c][s];
    const auto learnt = rans_frequencies(weights, kMostFrequentStep);
    std::int64_t saved = 0;
    for (std::size_t s = 0; s < kStepSymbols; ++s)
      if (symbols_[c][s] > 0)
        saved += static_cast<std::int64_t>(symbols_[c][s]) * (cost_of(start_.steps()[c][s]) - cost_of(learnt[s]));
    if (saved > kContextCost) std::copy_n(learnt.begin(), kStepSymbols, frequencies[c].begin());
  }
  return frequencies;
}

FastWeights FastTrainer::learn_weights() const {
  std::array<std::array<double, 6>, kFastPredictors> weights{};
  std::array<std::uint64_t, kFastPredictors> count{};
  for (std::size_t c = 0; c < kFastPredictors; ++c) weights[c] = unscaled(start_.weights()[c]);
  for (const Sample& sample : samples_) ++count[sample.predictor];

  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<LeastSquares<6>> problems(kFastPredictors);
    for (const Sample& sample : samples_) {
      const std::array<double, 6>& w = weights[sample.predictor];
      std::array<std::array<double, 6>, 3> around;
      double missed = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        double miss = sample.target[a];
        for (std::size_t k = 0; k < 6; ++k) {
          around[a][k] = sample.around[k][a];
          miss -= w[k] * around[a][k];
        }
        missed += miss * miss;
      }
      for (std::size_t a = 0; a < 3; ++a) problems[sample.predictor].add(around[a], sample.target[a], 1 / (missed + 3));
    }
    for (std::size_t c = 0; c < kFastPredictors; ++c)
      if (count[c] >= kEnough)
        weights[c] = problems[c].solve(unscaled(start_.weights()[c]), kPull / static_cast<double>(count[c]));
  }

  FastWeights rounded = start_.weights();
  for (std::size_t c = 0; c < kFastPredictors; ++c)
    for (std::size_t k = 0; k < 6; ++k) {
      const double clamped = std::clamp(256 * weights[c][k], -double{kMostPlaceWeight}, double{kMostPlaceWeight});
      rounded[c][k] = static_cast<std::int16_t>(std::floor(clamped + 0.5));
    }
  keep_what_pays(rounded);
  return rounded;
}

void FastTrainer::keep_what_pays(FastWeights& weights) const {
  std::array<std::int64_t, kFastPredictors> saved{};
  const auto cost = [](const Sample& sample, const PlaceWeights& w) {
    std::int64_t bits = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      double miss = 256 * static_cast<double>(sample.target[a]);
      for (std::size_t k = 0; k < 6; ++k) miss -= w[k] * static_cast<double>(sample.around[k][a]);
      bits += static_cast<std::int64_t>(range_coder_detail::log2_256(256 + static_cast<std::uint64_t>(std::abs(miss))));
    }
    return bits;
  };
  for (const Sample& sample : samples_) {
    const std::uint32_t c = sample.predictor;
    saved[c] += cost(sample, start_.weights()[c]) - cost(sample, weights[c]);
  }
  for (std::size_t c = 0; c < kFastPredictors; ++c)
    if (saved[c] <= kClassCost) weights[c] = start_.weights()[c];
}

}  // namespace ramcdb::codec
