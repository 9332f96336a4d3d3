#include "codec/fast_table_coder.h"

#include <algorithm>
#include <numeric>

#include "codec/range_coder.h"
#include "ramcdb/error.h"

namespace ramcdb::codec {

namespace {

using StepContext = std::array<std::uint16_t, kStepSymbols>;

/// Both directions: the encoder is given the tables, the decoder fills in those that differ from the built-in ones.
template <class Coder>
class TablePart {
 public:
  explicit TablePart(Coder& coder) : coder_(coder) {}

  void code(StepFrequencies& steps, FastWeights& weights) {
    for (std::size_t c = 0; c < kStepContexts; ++c)
      if (coder_.code(other_context_, steps[c] != built_in_.steps()[c])) code_context(steps[c], built_in_.steps()[c]);
    for (std::size_t c = 0; c < kFastPredictors; ++c)
      if (coder_.code(other_class_, weights[c] != built_in_.weights()[c]))
        for (std::size_t k = 0; k < 6; ++k)
          weights[c][k] = static_cast<std::int16_t>(
              code_near(weight_[k], weights[c][k], built_in_.weights()[c][k], -kMostPlaceWeight, kMostPlaceWeight));
  }

 private:
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
    if (left != 0) refuse();
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
  FastTables built_in_;
  AdaptiveBit other_context_, other_class_;
  std::array<AdaptiveSigned, kStepSymbols> frequency_;
  std::array<AdaptiveSigned, 6> weight_;
};

}  // namespace

Buffer encode_fast_tables(const FastTables& tables) {
  RangeEncoder coder;
  StepFrequencies steps = tables.steps();
  FastWeights weights = tables.weights();
  TablePart(coder).code(steps, weights);
  return coder.finish();
}

FastTables decode_fast_tables(Bytes bytes) {
  RangeDecoder coder(bytes);
  const FastTables built_in;
  StepFrequencies steps = built_in.steps();
  FastWeights weights = built_in.weights();
  TablePart(coder).code(steps, weights);
  coder.finish();
  return FastTables(steps, weights);
}

}  // namespace ramcdb::codec
