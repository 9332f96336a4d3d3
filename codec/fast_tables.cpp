#include "codec/fast_tables.h"

#include <xxhash.h>

#include "codec/built_in_fast.h"
#include "ramcdb/bytes.h"

namespace ramcdb::codec {

FastStepTables::FastStepTables(const StepFrequencies& frequencies) {
  tables_.reserve(frequencies.size());
  for (const auto& of_context : frequencies) tables_.emplace_back(of_context);
}

namespace {

std::uint64_t digest_of(const StepFrequencies& steps, const FastWeights& weights) {
  Buffer bytes;
  const auto put = [&](unsigned number) {
    bytes.push_back(static_cast<std::uint8_t>(number));
    bytes.push_back(static_cast<std::uint8_t>(number >> 8));
  };
  for (const auto& context : steps)
    for (const std::uint16_t frequency : context) put(frequency);
  for (const PlaceWeights& of_class : weights)
    for (const std::int16_t weight : of_class) put(static_cast<std::uint16_t>(weight));
  return XXH3_64bits(bytes.data(), bytes.size());
}

/// The built-in tables are many, and all alike.
const FastTables& built_in() {
  static const FastTables tables(kBuiltInSteps, kBuiltInPlaceWeights);
  return tables;
}

}  // namespace

FastTables::FastTables() : FastTables(built_in()) {}

FastTables::FastTables(const StepFrequencies& steps, const FastWeights& weights)
    : steps_(steps),
      weights_(weights),
      ready_(std::make_shared<const FastStepTables>(steps)),
      digest_(digest_of(steps, weights)) {}

}  // namespace ramcdb::codec
