#pragma once

#include <array>
#include <cstdint>
#include <memory>
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

/// Weights of the six neighbours of a place, in 1/256.
using PlaceWeights = std::array<std::int16_t, 6>;
inline constexpr std::uint32_t kFastPredictors = 288;
using FastWeights = std::array<PlaceWeights, kFastPredictors>;
/// Six such weights keep sums over ways of up to 2^20 within 32 bits.
inline constexpr int kMostPlaceWeight = 340;
/// No step is for free, so that a stream of some bytes cannot hold any number of them.
inline constexpr std::uint32_t kMostFrequentStep = kRansTotal - 16;

/// StepFrequencies made ready for decoding.
class FastStepTables {
 public:
  explicit FastStepTables(const StepFrequencies& frequencies);
  [[nodiscard]] const RansTable& table(std::uint32_t context) const { return tables_[context]; }

 private:
  std::vector<RansTable> tables_;
};

/// What the fast profile codes with: part of a mesh's CoderTables. Copies share what was made ready.
class FastTables {
 public:
  /// The built-in ones.
  FastTables();
  /// REQUIRES: each context's frequencies add up to kRansTotal, and none is above kMostFrequentStep.
  FastTables(const StepFrequencies& steps, const FastWeights& weights);

  [[nodiscard]] const StepFrequencies& steps() const { return steps_; }
  [[nodiscard]] const FastWeights& weights() const { return weights_; }
  [[nodiscard]] const FastStepTables& step_tables() const { return *ready_; }
  /// XXH3-64 of all numbers, two bytes each, lowest first: stands for the tables in checks.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

  friend bool operator==(const FastTables& a, const FastTables& b) {
    return a.steps_ == b.steps_ && a.weights_ == b.weights_;
  }

 private:
  StepFrequencies steps_;
  FastWeights weights_;
  std::shared_ptr<const FastStepTables> ready_;
  std::uint64_t digest_ = 0;
};

}  // namespace ramcdb::codec
