#include "codec/fast_tables.h"

namespace ramcdb::codec {

FastStepTables::FastStepTables(const StepFrequencies& frequencies) {
  tables_.reserve(frequencies.size());
  for (const auto& of_context : frequencies) tables_.emplace_back(of_context);
}

const FastStepTables& built_in_step_tables() {
  static const FastStepTables tables([] {
    StepFrequencies f{};
    const std::array<std::uint64_t, kStepSymbols> inner{6, 1, 1, 3, 40, 200, 400, 200, 50, 20, 8, 4, 2, 1, 1, 1};
    const std::array<std::uint64_t, kStepSymbols> border{0, 1, 50, 200, 400, 200, 40, 20, 8, 4, 2, 1, 1, 1, 1, 1};
    for (std::size_t c = 0; c < kStepContexts; ++c) {
      const auto all = rans_frequencies(c == kBorderContext ? border : inner, kRansTotal - 32);
      for (std::size_t s = 0; s < kStepSymbols; ++s) f[c][s] = all[s];
    }
    return f;
  }());
  return tables;
}

const std::array<PlaceWeights, kFastPredictors>& built_in_place_weights() {
  static const auto weights = [] {
    std::array<PlaceWeights, kFastPredictors> w{};
    for (std::size_t i = 0; i < w.size(); ++i) {
      const bool c = i & 4, d = i & 2, e = i & 1;
      const int count = c + d + e;
      if (count == 0) {
        w[i] = {128, 128, 0, 0, 0, 0};
        continue;
      }
      const auto part = static_cast<std::int16_t>(256 / count);
      // before - behind, next - behind, (before's) before + before - behind
      if (c) w[i][0] = static_cast<std::int16_t>(w[i][0] + part), w[i][2] = static_cast<std::int16_t>(-part);
      if (d) w[i][1] = static_cast<std::int16_t>(w[i][1] + part), w[i][3] = static_cast<std::int16_t>(-part);
      if (e)
        w[i][0] = static_cast<std::int16_t>(w[i][0] + part), w[i][4] = part, w[i][5] = static_cast<std::int16_t>(-part);
    }
    return w;
  }();
  return weights;
}

}  // namespace ramcdb::codec
