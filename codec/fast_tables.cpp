#include "codec/fast_tables.h"

#include "codec/built_in_fast.h"

namespace ramcdb::codec {

FastStepTables::FastStepTables(const StepFrequencies& frequencies) {
  tables_.reserve(frequencies.size());
  for (const auto& of_context : frequencies) tables_.emplace_back(of_context);
}

FastTables::FastTables() : steps_(kBuiltInSteps), weights_(kBuiltInPlaceWeights) {
  static const auto ready = std::make_shared<const FastStepTables>(kBuiltInSteps);
  ready_ = ready;
}

FastTables::FastTables(const StepFrequencies& steps, const FastWeights& weights)
    : steps_(steps), weights_(weights), ready_(std::make_shared<const FastStepTables>(steps)) {}

}  // namespace ramcdb::codec
