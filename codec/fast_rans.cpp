#include "codec/fast_rans.h"

#include <algorithm>
#include <numeric>

namespace ramcdb::codec {

RansTable::RansTable(std::span<const std::uint16_t> frequencies) {
  std::uint32_t start = 0;
  for (std::uint32_t symbol = 0; symbol < frequencies.size(); ++symbol) {
    const std::uint32_t frequency = frequencies[symbol];
    ranges_[symbol] = {static_cast<std::uint16_t>(frequency), static_cast<std::uint16_t>(start)};
    std::fill_n(symbols_.begin() + start, frequency, static_cast<std::uint8_t>(symbol));
    start += frequency;
  }
}

std::array<std::uint16_t, RansTable::kMostSymbols> rans_frequencies(std::span<const std::uint64_t> weights,
                                                                    std::uint32_t most) {
  std::array<std::uint16_t, RansTable::kMostSymbols> frequencies{};
  const std::uint64_t sum = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
  std::int64_t left = kRansTotal;
  for (std::size_t s = 0; s < weights.size(); ++s) {
    if (weights[s] == 0) continue;
    const std::uint64_t share = (weights[s] * kRansTotal + sum / 2) / sum;
    frequencies[s] = static_cast<std::uint16_t>(std::clamp<std::uint64_t>(share, 1, most));
    left -= frequencies[s];
  }
  // What rounding left over goes to those that lose least by it: one at a time to or from the largest.
  while (left != 0) {
    std::size_t best = 0;
    for (std::size_t s = 0; s < weights.size(); ++s)
      if (weights[s] != 0 && frequencies[s] > frequencies[best] && (left < 0 || frequencies[s] < most)) best = s;
    if (left > 0 && frequencies[best] >= most) best = 0;
    const std::int64_t step = left > 0 ? 1 : -1;
    frequencies[best] = static_cast<std::uint16_t>(frequencies[best] + step);
    left -= step;
  }
  return frequencies;
}

void push_run(std::span<RansEncoder> states, const RansTable& table, std::span<const std::uint8_t> symbols,
              std::vector<std::uint16_t>& words) {
  for (std::size_t i = symbols.size(); i-- > 0;) states[i % states.size()].push(table, symbols[i], words);
}

void pop_run(std::span<RansDecoder> states, const RansTable& table, WordReader& words,
             std::span<std::uint8_t> symbols) {
  std::size_t i = 0;
  if (states.size() == kRansLanes) {
    std::array<RansDecoder, kRansLanes> lanes;  // so that they may live in registers
    std::copy_n(states.begin(), kRansLanes, lanes.begin());
    for (; i + kRansLanes <= symbols.size() && words.has(kRansLanes); i += kRansLanes)
      for (std::size_t lane = 0; lane < kRansLanes; ++lane)
        symbols[i + lane] = static_cast<std::uint8_t>(lanes[lane].pop_sure(table, words));
    std::copy_n(lanes.begin(), kRansLanes, states.begin());
  }
  for (; i < symbols.size(); ++i) symbols[i] = static_cast<std::uint8_t>(states[i % states.size()].pop(table, words));
}

}  // namespace ramcdb::codec
