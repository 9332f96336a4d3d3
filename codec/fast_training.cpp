#include "codec/fast_training.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "codec/fast_residuals.h"
#include "codec/fast_steps.h"
#include "codec/fast_walk.h"
#include "codec/least_squares.h"
#include "codec/range_coder.h"

namespace ramcdb::codec {

namespace {

/// How far the guess of fast_predictor.h misses.
template <class Sample>
FastResidual miss_of(const Sample& sample, const FastWeights& weights) {
  FastResidual miss{};
  for (std::size_t a = 0; a < 3; ++a) {
    std::int64_t sum = 128;
    for (std::size_t k = 0; k < 6; ++k)
      sum += std::int64_t{weights[sample.predictor][k]} * static_cast<std::int64_t>(sample.around[k][a]);
    miss[a] = static_cast<std::int32_t>(static_cast<std::int64_t>(sample.target[a]) - (sum >> 8));
  }
  return miss;
}

constexpr int kPasses = 6;
/// A class with fewer vertices keeps the weights that it started from.
constexpr std::uint64_t kEnough = 24;
/// How much the weights at the start are worth, in vertices.
constexpr double kPull = 12;
/// Counts of each symbol that the frequencies at the start are worth, in all.
constexpr std::uint64_t kSymbolPull = 200;

/// What the tables of a context and of a class take, about, in 1/256 bit.
constexpr std::int64_t kContextCost = 256 * 90, kClassCost = 256 * 45, kScalesCost = 256 * 100;

/// Of a symbol with this frequency, but for a constant; in 1/256 bit.
std::int64_t cost_of(std::uint32_t frequency) {
  return -static_cast<std::int64_t>(range_coder_detail::log2_256(frequency));
}

/// Of a token with this distribution; in 1/256 bit. Without its raw bits, which it takes in any case.
std::int64_t token_cost(const RansTable& table, std::uint32_t token) {
  constexpr std::int64_t kWideCost = 256 * (kWideSize + 3);
  const std::uint32_t frequency = table.frequency(token);
  return frequency > 0 ? cost_of(frequency) : cost_of(table.frequency(kWideToken)) + kWideCost;
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
  FastStepWriter steps(chart, *edges, {});
  const auto isolated = static_cast<std::uint32_t>(steps.isolated().size());
  const FastPlan plan = FastWalk(steps, FastOutline{chart.loop_sizes, {inner, faces}, isolated, faces}).run();
  steps.count_symbols(symbols_);
  const std::vector<std::uint32_t> source = steps.source_vertices();
  const auto at = [&](std::uint32_t vertex) { return chart.positions[source[vertex]]; };
  std::vector<std::uint32_t> sample_of(source.size(), kNone);
  for (std::uint32_t i = 0; i < inner; ++i) {
    const FastPlace& place = plan.places[i];
    if (place.predictor == kFreePlace) continue;
    sample_of[border + i] = static_cast<std::uint32_t>(samples_.size());
    const LatticePoint pivot = at(place.pivot), vertex = at(border + i);
    Sample& sample = samples_.emplace_back();
    sample.predictor = place.predictor;
    sample.fixed_to = {sample_of[place.pivot], sample_of[place.around[0]], sample_of[place.around[1]]};
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      sample.target[axis] = static_cast<float>(std::int64_t{vertex[a]} - pivot[a]);
      for (std::size_t k = 0; k < 6; ++k)
        sample.around[k][axis] = static_cast<float>(std::int64_t{at(place.around[k])[a]} - pivot[a]);
    }
  }
  chart_ends_.push_back(samples_.size());
}

FastTables FastTrainer::learn() const {
  FastNumbers numbers;
  numbers.steps = learn_steps();
  numbers.weights = learn_weights();
  numbers.scales = learn_scales(numbers.weights);
  return FastTables(numbers);
}

StepFrequencies FastTrainer::learn_steps() const {
  const StepFrequencies& known = start_.numbers().steps;
  StepFrequencies frequencies = known;
  for (std::size_t c = 0; c < kStepContexts; ++c) {
    std::array<std::uint64_t, kStepSymbols> weights{};
    for (std::size_t s = 0; s < kStepSymbols; ++s) weights[s] = symbols_[c][s] * kRansTotal + kSymbolPull * known[c][s];
    const auto learnt = rans_frequencies(weights, kMostFrequentStep);
    std::int64_t saved = 0;
    for (std::size_t s = 0; s < kStepSymbols; ++s)
      if (symbols_[c][s] > 0)
        saved += static_cast<std::int64_t>(symbols_[c][s]) * (cost_of(known[c][s]) - cost_of(learnt[s]));
    if (saved > kContextCost) std::copy_n(learnt.begin(), kStepSymbols, frequencies[c].begin());
  }
  return frequencies;
}

FastWeights FastTrainer::learn_weights() const {
  std::array<std::array<double, 6>, kFastPredictors> weights{};
  std::array<std::uint64_t, kFastPredictors> count{};
  for (std::size_t c = 0; c < kFastPredictors; ++c) weights[c] = unscaled(start_.numbers().weights[c]);
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
        weights[c] = problems[c].solve(unscaled(start_.numbers().weights[c]), kPull / static_cast<double>(count[c]));
  }

  FastWeights rounded = start_.numbers().weights;
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
    saved[c] += cost(sample, start_.numbers().weights[c]) - cost(sample, weights[c]);
  }
  for (std::size_t c = 0; c < kFastPredictors; ++c)
    if (saved[c] <= kClassCost) weights[c] = start_.numbers().weights[c];
}

FastTrainer::TokenCounts FastTrainer::count_tokens(const FastWeights& weights) const {
  TokenCounts counts{};
  std::vector<std::array<std::uint32_t, 3>> tokens(samples_.size());
  std::vector<FastResidual> misses;
  std::size_t first = 0;
  for (const std::size_t end : chart_ends_) {
    misses.clear();
    for (std::size_t i = first; i < end; ++i) misses.push_back(miss_of(samples_[i], weights));
    const std::uint32_t typical = misses.empty() ? 0 : typical_token(misses);
    for (std::size_t i = first; i < end; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        std::uint32_t sum = 0;
        for (const std::uint32_t near : samples_[i].fixed_to) sum += near == kNone ? typical : tokens[near][a];
        tokens[i][a] = token_of(zigzag(misses[i - first][a]));
        ++counts[miss_class(sum)][tokens[i][a]];
      }
    first = end;
  }
  return counts;
}

MissScales FastTrainer::learn_scales(const FastWeights& weights) const {
  const TokenCounts counts = count_tokens(weights);
  const MissScales& known = start_.numbers().scales;
  MissScales scales = known;
  std::int64_t saved = 0;
  for (std::size_t c = 0; c < kMissClasses; ++c) {
    const auto cost = [&](std::uint32_t scale) {
      std::int64_t bits = 0;
      for (std::uint32_t t = 0; t < kTokens; ++t)
        bits += static_cast<std::int64_t>(counts[c][t]) * token_cost(scale_tables()[scale], t);
      return bits;
    };
    const std::int64_t at_start = cost(known[c]);
    std::int64_t least = at_start;
    for (std::uint32_t scale = 0; scale < kScales; ++scale)
      if (const std::int64_t bits = cost(scale); bits < least) {
        least = bits;
        scales[c] = static_cast<std::uint8_t>(scale);
      }
    saved += at_start - least;
  }
  return saved > kScalesCost ? scales : known;
}

}  // namespace ramcdb::codec
