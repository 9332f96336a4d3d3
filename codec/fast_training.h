#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/fast_predictor.h"
#include "codec/fast_tables.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// Learns the tables of the fast profile from the charts of a mesh. Equal charts in an equal order give equal tables on
/// every machine.
class FastTrainer {
 public:
  /// \param start what classes without enough samples keep, and what the others are drawn to
  explicit FastTrainer(const FastTables& start) : start_(start) {}

  /// Charts that the fast coder does not take teach nothing.
  void add(const Chart& chart);

  /// Weights by robust least squares (far misses count less), frequencies by counting, scales by trying all; only where
  /// it pays to store them.
  [[nodiscard]] FastTables learn() const;

 private:
  /// A vertex: where it is and where its six neighbours are, as seen from the pivot.
  struct Sample {
    std::array<std::array<float, 3>, 6> around{};
    std::array<float, 3> target{};
    std::uint32_t predictor = 0;
    std::array<std::uint32_t, 3> fixed_to{};  ///< samples of the vertices that it is fixed to, or kNone
  };
  /// How often each token occurs in each class.
  using TokenCounts = std::array<std::array<std::uint64_t, kTokens>, kMissClasses>;

  [[nodiscard]] StepFrequencies learn_steps() const;
  [[nodiscard]] FastWeights learn_weights() const;
  [[nodiscard]] MissScales learn_scales(const FastWeights& weights) const;
  [[nodiscard]] TokenCounts count_tokens(const FastWeights& weights) const;
  /// Puts classes back to the start whose own weights save less than they take.
  void keep_what_pays(FastWeights& weights) const;

  FastTables start_;
  std::vector<Sample> samples_;
  std::vector<std::size_t> chart_ends_;  ///< number of samples after each chart
  std::array<std::array<std::uint64_t, kStepSymbols>, kStepContexts> symbols_{};
};

}  // namespace ramcdb::codec
