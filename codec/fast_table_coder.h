#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/fast_scales.h"
#include "codec/fast_tables.h"
#include "codec/range_coder.h"
#include "ramcdb/error.h"

namespace ramcdb::codec {

/// The fast profile's part of a table blob, for both directions: the encoder is given the tables, the decoder the
/// built-in ones and fills in those that differ.
///
///   fast_part = context{kStepContexts} place{kFastPredictors} own:bit [ scale{kMissClasses} ]
///   context   = own:bit [ difference{kStepSymbols - 1} ]     the last frequency follows from the others
///   place     = own:bit [ difference{6} ]
///   scale     = difference
///
/// Differences are signed numbers, to the built-in ones; those at the same place among symbols or weights share a
/// model. Throws invalid_argument for tables that cannot code every chart when encoding, corrupt when decoding.
template <class Coder>
class FastTablePart {
 public:
  explicit FastTablePart(Coder& coder) : coder_(coder) {}

  void code(FastNumbers& numbers) {
    const FastNumbers built_in = FastTables().numbers();
    for (std::size_t c = 0; c < kStepContexts; ++c)
      if (coder_.code(own_context_, numbers.steps[c] != built_in.steps[c]))
        code_context(numbers.steps[c], built_in.steps[c]);
    for (std::size_t c = 0; c < kFastPredictors; ++c)
      if (coder_.code(own_place_, numbers.weights[c] != built_in.weights[c]))
        code_place(numbers.weights[c], built_in.weights[c]);
    if (coder_.code(own_scales_, numbers.scales != built_in.scales)) code_scales(numbers.scales, built_in.scales);
  }

 private:
  using StepContext = std::array<std::uint16_t, kStepSymbols>;

  void code_place(PlaceWeights& weights, const PlaceWeights& known) {
    for (std::size_t k = 0; k < weights.size(); ++k)
      weights[k] =
          static_cast<std::int16_t>(code_near(weight_[k], weights[k], known[k], -kMostPlaceWeight, kMostPlaceWeight));
    if (weights == known) refuse();
  }

  void code_context(StepContext& frequencies, const StepContext& known) {
    int left = kRansTotal;
    for (std::size_t s = 0; s < kStepSymbols; ++s) {
      if (s + 1 < kStepSymbols)
        frequencies[s] =
            static_cast<std::uint16_t>(code_near(frequency_[s], frequencies[s], known[s], 0, int{kMostFrequentStep}));
      else
        frequencies[s] = static_cast<std::uint16_t>(std::clamp(left, 0, int{kMostFrequentStep}));
      left -= frequencies[s];
      if ((frequencies[s] == 0) != (known[s] == 0)) refuse();
    }
    if (left != 0 || frequencies == known) refuse();
  }

  void code_scales(MissScales& scales, const MissScales& known) {
    for (std::size_t c = 0; c < kMissClasses; ++c)
      scales[c] = static_cast<std::uint8_t>(code_near(scale_, scales[c], known[c], 0, int{kScales} - 1));
    if (scales == known) refuse();
  }

  int code_near(AdaptiveSigned& model, int value, int known, int lowest, int highest) {
    const std::int64_t coded = std::int64_t{known} + model.code(coder_, value - known);
    if (coded < lowest || coded > highest) refuse();
    return static_cast<int>(coded);
  }

  [[noreturn]] static void refuse() {
    if constexpr (Coder::kEncodes) throw Error(Errc::invalid_argument, "a coder table that cannot code every chart");
    throw Error(Errc::corrupt, "a table blob cannot code every chart");
  }

  Coder& coder_;
  AdaptiveBit own_context_, own_place_, own_scales_;
  std::array<AdaptiveSigned, kStepSymbols> frequency_;
  std::array<AdaptiveSigned, 6> weight_;
  AdaptiveSigned scale_;
};

}  // namespace ramcdb::codec
