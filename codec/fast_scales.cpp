#include "codec/fast_scales.h"

#include <cmath>
#include <memory>

namespace ramcdb::codec {

namespace {

/// No symbol takes all: so no number is for free, and a stream of some bytes cannot hold any number of vertices.
constexpr std::uint32_t kMostFrequent = kRansTotal - 16;

/// The sum of the terms `from`, ..., `to` - 1 of 1, ratio, ratio^2 ...
double geometric(double ratio, std::uint64_t from, std::uint64_t to) {
  const auto power = [](double base, std::uint64_t exponent) {
    double result = 1;
    for (; exponent > 0; exponent >>= 1, base *= base)
      if (exponent & 1) result *= base;
    return result;
  };
  return (power(ratio, from) - power(ratio, to)) / (1 - ratio);
}

/// The probability of magnitudes in [from, to) when they fall off by a constant ratio on either side of zero and have
/// this mean.
double two_sided(double mean, std::uint64_t from, std::uint64_t to) {
  const double ratio = (std::sqrt(1 + mean * mean) - 1) / mean;
  const double zero = (1 - ratio) / (1 + ratio);
  return zero * (from == 0 ? 1 + 2 * geometric(ratio, 1, to) : 2 * geometric(ratio, from, to));
}

/// Misses of surfaces: mostly near, a part with a longer tail.
double probability(double mean, std::uint64_t from, std::uint64_t to) {
  return 0.85 * two_sided(0.85 * mean, from, to) + 0.15 * two_sided(1.85 * mean, from, to);
}

RansTable table_of(double mean) {
  constexpr double kUnit = 1099511627776.0;  // 2^40
  std::array<std::uint64_t, kTokens> weights{};
  const auto weigh = [&](std::uint32_t token, double p) {
    // What is rarer than half a share is left to the wide token.
    const double least = kUnit / (2.0 * kRansTotal);
    if (p * kUnit >= least) weights[token] = static_cast<std::uint64_t>(p * kUnit);
  };
  weigh(0, probability(mean, 0, 1));
  for (std::uint32_t token = 1; token < kDirectTokens; ++token) {
    const std::uint32_t magnitude = (token + 1) / 2;
    weigh(token, probability(mean, magnitude, magnitude + 1) / 2);
  }
  for (std::uint32_t token = kDirectTokens; token < kWideToken; ++token) {
    const std::uint32_t half = token - kDirectTokens, bits = 4 + half / 2;
    const std::uint64_t magnitude = (std::uint64_t{2} + half % 2) << bits >> 1;
    weigh(token, probability(mean, magnitude, magnitude + (std::uint64_t{1} << bits >> 1)));
  }
  weights[kWideToken] = 1;
  return RansTable(rans_frequencies(weights, kMostFrequent));
}

}  // namespace

const std::array<RansTable, kScales>& scale_tables() {
  static const auto tables = [] {
    auto all = std::make_unique<std::array<RansTable, kScales>>();
    (*all)[0] = table_of(0.0625);
    for (std::uint32_t s = 1; s < kScales; ++s) {
      const auto quarters = static_cast<double>(quarters_of(s - 1));
      (*all)[s] = table_of(quarters / 32);
    }
    return all;
  }();
  return *tables;
}

}  // namespace ramcdb::codec
