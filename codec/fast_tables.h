#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/fast_rans.h"

namespace ramcdb::codec {

/// Symbols of the fast coder's connectivity: a join, a large degree, or a degree itself.
inline constexpr std::uint32_t kStepSymbols = 16;
inline constexpr std::uint32_t kJoinSymbol = 0;
inline constexpr std::uint32_t kLargeSymbol = 1;
inline constexpr std::uint32_t kLargeDegree = kStepSymbols;
/// Larger degrees above kLargeDegree than this no chart has.
inline constexpr std::uint32_t kMostLarge = 1u << 21;

inline constexpr std::uint32_t kStepContexts = 18;
inline constexpr std::uint32_t kBorderContext = 16;
inline constexpr std::uint32_t kSeedContext = 17;

/// How often each symbol occurs in each context, of kRansTotal.
using StepFrequencies = std::array<std::array<std::uint16_t, kStepSymbols>, kStepContexts>;

/// StepFrequencies made ready for decoding.
class FastStepTables {
 public:
  explicit FastStepTables(const StepFrequencies& frequencies);
  [[nodiscard]] const RansTable& table(std::uint32_t context) const { return tables_[context]; }

 private:
  std::vector<RansTable> tables_;
};

[[nodiscard]] const FastStepTables& built_in_step_tables();

/// Weights of the six neighbours of a place, in 1/256.
using PlaceWeights = std::array<std::int16_t, 6>;
inline constexpr std::uint32_t kFastPredictors = 288;
[[nodiscard]] const std::array<PlaceWeights, kFastPredictors>& built_in_place_weights();

}  // namespace ramcdb::codec
