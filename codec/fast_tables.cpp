#include "codec/fast_tables.h"

#include <xxhash.h>

#include "codec/built_in_fast.h"
#include "codec/fast_scales.h"
#include "ramcdb/bytes.h"

namespace ramcdb::codec {

namespace {

std::uint64_t digest_of(const FastNumbers& numbers) {
  Buffer bytes;
  const auto put = [&](unsigned number) {
    bytes.push_back(static_cast<std::uint8_t>(number));
    bytes.push_back(static_cast<std::uint8_t>(number >> 8));
  };
  for (const auto& context : numbers.steps)
    for (const std::uint16_t frequency : context) put(frequency);
  for (const PlaceWeights& of_class : numbers.weights)
    for (const std::int16_t weight : of_class) put(static_cast<std::uint16_t>(weight));
  for (const std::uint8_t scale : numbers.scales) put(scale);
  return XXH3_64bits(bytes.data(), bytes.size());
}

/// The built-in tables are many, and all alike.
const FastTables& built_in() {
  static const FastTables tables({kBuiltInSteps, kBuiltInPlaceWeights, kBuiltInMissScales});
  return tables;
}

}  // namespace

FastTables::FastTables() : FastTables(built_in()) {}

FastTables::FastTables(const FastNumbers& numbers) : numbers_(numbers), digest_(digest_of(numbers)) {
  auto ready = std::make_shared<Ready>();
  for (std::size_t c = 0; c < kStepContexts; ++c) ready->steps[c] = RansTable(numbers.steps[c]);
  for (std::size_t c = 0; c < kFastPredictors; ++c)
    std::copy(numbers.weights[c].begin(), numbers.weights[c].end(), ready->weights[c].begin());
  for (std::uint32_t sum = 0; sum < ready->misses.size(); ++sum)
    ready->misses[sum] = &scale_tables()[numbers.scales[miss_class(sum)]];
  ready_ = std::move(ready);
}

}  // namespace ramcdb::codec
