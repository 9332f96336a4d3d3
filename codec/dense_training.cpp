#include "codec/dense_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "codec/dense_coder.h"
#include "codec/dense_guide.h"
#include "codec/least_squares.h"

namespace ramcdb::codec {

namespace {

constexpr float kWeightOne = 128;  ///< of weights
constexpr int kRounds = 4;         ///< of reweighting
/// Fewer samples than that determine no six weights.
constexpr std::size_t kLeastSamples = 32;
/// About what a class of own weights takes in the table.
constexpr std::int64_t kFanClassBits = 42, kPlaneClassBits = 21;

/// What was known of a new vertex, and where it is. All relative to the pivot.
struct Sample {
  FanVectors fan;
  Vec normal;
  std::array<float, 3> planes;  ///< heights along the main axis over the vertex, of pivot, current and next
  std::array<bool, 3> has_plane;
  Vec target;
};

/// A coder that codes nothing: it takes what the guide says, and keeps what predictions are made from.
class TrainingCoder {
 public:
  static constexpr bool kEncodes = true;

  explicit TrainingCoder(std::vector<Sample>& samples) : samples_(samples) {}

  bool code(AdaptiveBit& /*model*/, bool bit) { return bit; }
  std::uint32_t code_symbol(AdaptiveSymbol& /*model*/, std::uint32_t symbol) { return symbol; }
  std::uint32_t code_raw(std::uint32_t value, int /*bits*/) { return value; }
  [[nodiscard]] std::uint64_t position() const { return 0; }

  void observe(const DenseSurface& surface, const FanPlace& place, LatticePoint actual) {
    Sample sample{FanVectors(surface, place), place.normal, {}, {}, {}};
    sample.target = difference(actual, surface[place.pivot].position);
    const std::array<std::uint32_t, 3> around{place.pivot, place.current, place.next};
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Vec at = difference(surface[around[i]], surface[place.pivot]);
      const HeightPlane plane(surface[around[i]].normal, at, sample.fan.main_axis);
      sample.has_plane[i] = plane.tells;
      sample.planes[i] = plane.height(sample.target[sample.fan.axis(0)], sample.target[sample.fan.axis(1)]);
    }
    samples_.push_back(sample);
  }

 private:
  std::vector<Sample>& samples_;
};

void gather(const Chart& chart, std::vector<Sample>& samples) {
  const std::optional<HalfEdges> edges = HalfEdges::of(chart);
  if (!edges) return;
  static const CoderTables kUnused;
  DenseContext context;
  context.border = std::span(chart.positions).first(chart.border_count());
  context.loop_sizes = chart.loop_sizes;
  context.counts.inner_vertices = static_cast<std::uint32_t>(chart.positions.size() - context.border.size());
  context.counts.faces = static_cast<std::uint32_t>(chart.faces.size());
  context.expected = context.counts;
  context.edge_exponent = mean_edge_exponent(chart);
  for (const LatticePoint p : chart.positions) context.box.add(p);
  context.tables = &kUnused;
  TrainingCoder coder(samples);
  ChartGuide guide(chart, *edges);
  DenseWalk(coder, guide, context).run();
}

/// The sum of log2 of many numbers, as good as whole: their product, with its exponent apart. (Logarithms of the
/// library are not the same everywhere.)
class LogSum {
 public:
  void multiply(double factor) {
    int exponent = 0;
    product_ = std::frexp(product_ * factor, &exponent);
    sum_ += exponent;
  }
  [[nodiscard]] std::int64_t value() const { return sum_; }

 private:
  double product_ = 1;
  std::int64_t sum_ = 0;
};

/// About 2 ^ (2 * bits) of coding an error.
double coding_cost(double error) { return error * error + 0.25; }

Vec fan_guess(const Sample& sample, const FanWeights& weights) {
  Vec guess;
  for (std::size_t i = 0; i < weights.size(); ++i) guess = guess + sample.fan.vectors[i] * (weights[i] / kWeightOne);
  return guess;
}

/// The guess of the last coordinate before planes have their say, when the first two are known.
double last_guess(const Sample& sample, Vec guess) {
  const int x = sample.fan.axis(0), y = sample.fan.axis(1), z = sample.fan.main_axis;
  const Vec& n = sample.normal;
  return guess[z] - (n[x] * (sample.target[x] - guess[x]) + n[y] * (sample.target[y] - guess[y])) / n[z];
}

std::array<double, 3> errors_of(const Sample& sample, const FanWeights& weights) {
  const Vec guess = fan_guess(sample, weights);
  const int x = sample.fan.axis(0), y = sample.fan.axis(1), z = sample.fan.main_axis;
  return {sample.target[x] - guess[x], sample.target[y] - guess[y], sample.target[z] - last_guess(sample, guess)};
}

std::array<double, 3> plane_shifts(const Sample& sample, double from) {
  std::array<double, 3> shifts{};
  for (std::size_t i = 0; i < 3; ++i)
    if (sample.has_plane[i])
      shifts[i] = std::clamp<double>(sample.planes[i] - from, -sample.fan.reach, sample.fan.reach);
  return shifts;
}

template <std::size_t N>
std::array<double, N> from_table(const std::array<std::int16_t, N>& weights) {
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = weights[i] / kWeightOne;
  return out;
}

template <std::size_t N>
std::array<std::int16_t, N> to_table(const std::array<double, N>& weights) {
  std::array<std::int16_t, N> out;
  for (std::size_t i = 0; i < N; ++i)
    out[i] = static_cast<std::int16_t>(std::floor(std::clamp(weights[i] * kWeightOne, -1024.0, 1024.0) + 0.5));
  return out;
}

using Samples = std::span<const Sample* const>;

/// As strong as so many hundredths of the samples, the built-in weights speak, too.
double pull_of(std::size_t samples) { return 8.0 / static_cast<double>(samples); }

FanWeights fit_fan(Samples samples, const FanWeights& built_in) {
  const std::array<double, 6> start = from_table(built_in);
  std::array<double, 6> weights = start;
  for (int round = 0; round <= kRounds; ++round) {
    LeastSquares<6> problem;
    for (const Sample* sample : samples) {
      const auto& v = sample->fan.vectors;
      const double first_weight = 1 / (squared_length(v[0]) + squared_length(v[1]) + 1);
      for (int axis = 0; axis < 3; ++axis) {
        std::array<double, 6> regressors;
        double error = sample->target[axis];
        for (std::size_t i = 0; i < 6; ++i) {
          regressors[i] = v[i][axis];
          error -= weights[i] * regressors[i];
        }
        problem.add(regressors, sample->target[axis], round == 0 ? first_weight : 1 / (error * error + 2));
      }
    }
    weights = problem.solve(start, pull_of(samples.size()));
  }
  return to_table(weights);
}

PlaneWeights fit_planes(Samples samples, const CoderTables& tables, const PlaneWeights& built_in) {
  const std::array<double, 3> start = from_table(built_in);
  std::array<double, 3> weights = start;
  for (int round = 0; round <= kRounds; ++round) {
    LeastSquares<3> problem;
    for (const Sample* sample : samples) {
      const double from = last_guess(*sample, fan_guess(*sample, tables.fan[sample->fan.fan_class]));
      const std::array<double, 3> shifts = plane_shifts(*sample, from);
      const double value = sample->target[sample->fan.main_axis] - from;
      const double error = value - weights[0] * shifts[0] - weights[1] * shifts[1] - weights[2] * shifts[2];
      problem.add(shifts, value, 1 / (error * error + 1));
    }
    weights = problem.solve(start, pull_of(samples.size()));
  }
  return to_table(weights);
}

/// Bits that `samples` save with `weights` instead of `built_in`.
std::int64_t saved_by(Samples samples, const FanWeights& weights, const FanWeights& built_in) {
  LogSum saved;
  for (const Sample* sample : samples) {
    const std::array<double, 3> before = errors_of(*sample, built_in), after = errors_of(*sample, weights);
    for (std::size_t k = 0; k < 3; ++k) saved.multiply(coding_cost(before[k]) / coding_cost(after[k]));
  }
  return saved.value() / 2;
}

std::int64_t saved_by(Samples samples, const CoderTables& tables, const PlaneWeights& weights,
                      const PlaneWeights& built_in) {
  LogSum saved;
  for (const Sample* sample : samples) {
    const double from = last_guess(*sample, fan_guess(*sample, tables.fan[sample->fan.fan_class]));
    const std::array<double, 3> shifts = plane_shifts(*sample, from);
    double before = sample->target[sample->fan.main_axis] - from, after = before;
    for (std::size_t i = 0; i < 3; ++i) {
      before -= shifts[i] * (built_in[i] / kWeightOne);
      after -= shifts[i] * (weights[i] / kWeightOne);
    }
    saved.multiply(coding_cost(before) / coding_cost(after));
  }
  return saved.value() / 2;
}

/// The samples of each class, in their order.
template <class ClassOf>
std::vector<std::vector<const Sample*>> by_class(const std::vector<Sample>& samples, std::size_t classes,
                                                 ClassOf&& class_of) {
  std::vector<std::vector<const Sample*>> sorted(classes);
  for (const Sample& sample : samples) sorted[class_of(sample)].push_back(&sample);
  return sorted;
}

}  // namespace

CoderTables train_dense(std::span<const Chart* const> charts, std::uint64_t vertices) {
  std::vector<Sample> samples;
  for (const Chart* chart : charts) gather(*chart, samples);
  CoderTables tables;
  if (samples.empty()) return tables;
  const double stand_for = static_cast<double>(vertices) / static_cast<double>(samples.size());
  const auto pays = [&](std::int64_t saved, std::int64_t cost) {
    return static_cast<double>(saved) * stand_for > static_cast<double>(cost);
  };
  const auto by_fan = by_class(samples, kFanClasses, [](const Sample& s) { return s.fan.fan_class; });
  for (std::size_t c = 0; c < kFanClasses; ++c) {
    if (by_fan[c].size() < kLeastSamples) continue;
    const FanWeights built_in = tables.fan[c], weights = fit_fan(by_fan[c], built_in);
    if (pays(saved_by(by_fan[c], weights, built_in), kFanClassBits)) tables.fan[c] = weights;
  }
  const auto by_plane = by_class(samples, kPlaneClasses, [](const Sample& s) { return s.fan.plane_class; });
  for (std::size_t c = 0; c < kPlaneClasses; ++c) {
    if (by_plane[c].size() < kLeastSamples) continue;
    const PlaneWeights built_in = tables.plane[c], weights = fit_planes(by_plane[c], tables, built_in);
    if (pays(saved_by(by_plane[c], tables, weights, built_in), kPlaneClassBits)) tables.plane[c] = weights;
  }
  return tables;
}

}  // namespace ramcdb::codec
