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

/// Steps and seeds; border vertices.
inline constexpr std::uint32_t kStepContexts = 2;
inline constexpr std::uint32_t kInnerContext = 0;
inline constexpr std::uint32_t kBorderContext = 1;

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

/// Classes of how large the misses around a vertex were (fast_scales.h), and the distribution that each has.
inline constexpr std::uint32_t kMissClasses = 44;
using MissScales = std::array<std::uint8_t, kMissClasses>;

/// What a mesh's charts are coded with.
struct FastNumbers {
  StepFrequencies steps{};
  FastWeights weights{};
  MissScales scales{};

  friend bool operator==(const FastNumbers&, const FastNumbers&) = default;
};

/// The frequencies, made ready for decoding.
using FastStepTables = std::array<RansTable, kStepContexts>;

/// The weights in whole words, as loops over positions like them.
using ReadyWeights = std::array<std::array<std::int32_t, 8>, kFastPredictors>;

/// The distribution of a number whose neighbours' tokens have this sum.
using MissTables = std::array<const RansTable*, 256>;

/// What the fast profile codes with: part of a mesh's CoderTables. Copies share what was made ready.
class FastTables {
 public:
  /// The built-in ones.
  FastTables();
  /// REQUIRES: each context's frequencies add up to kRansTotal, and none is above kMostFrequentStep; scales are below
  /// kScales.
  explicit FastTables(const FastNumbers& numbers);

  [[nodiscard]] const FastNumbers& numbers() const { return numbers_; }
  [[nodiscard]] const ReadyWeights& weights() const { return ready_->weights; }
  [[nodiscard]] const FastStepTables& step_tables() const { return ready_->steps; }
  [[nodiscard]] const MissTables& miss_tables() const { return ready_->misses; }
  /// XXH3-64 of all numbers, two bytes each, lowest first, in the order of FastNumbers: stands for the tables in
  /// checks.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

  friend bool operator==(const FastTables& a, const FastTables& b) { return a.numbers_ == b.numbers_; }

 private:
  struct Ready {
    FastStepTables steps;
    ReadyWeights weights{};
    MissTables misses;
  };

  FastNumbers numbers_;
  std::shared_ptr<const Ready> ready_;
  std::uint64_t digest_ = 0;
};

}  // namespace ramcdb::codec
