#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/bytes.h"

/// A static range coder by asymmetric numeral systems (J. Duda, 2013): a 32-bit state that numbers are pushed onto and
/// popped from, 16 bits at a time to and from a stream of words. What is pushed last comes out first, so the encoder
/// takes the symbols backwards. Several states may share one stream of words.
namespace ramcdb::codec {

inline constexpr int kRansBits = 11;
inline constexpr std::uint32_t kRansTotal = 1u << kRansBits;
/// States lie in [kRansLow, 2^32); an encoder begins with kRansLow, so a decoder has to end there.
inline constexpr std::uint32_t kRansLow = 1u << 16;

/// How often symbols occur, of kRansTotal. Fewer than 64 symbols.
class RansTable {
 public:
  static constexpr std::size_t kMostSymbols = 64;

  RansTable() = default;
  /// REQUIRES: `frequencies` add up to kRansTotal.
  explicit RansTable(std::span<const std::uint16_t> frequencies);

  [[nodiscard]] std::uint32_t frequency(std::uint32_t symbol) const { return frequency_[symbol]; }
  [[nodiscard]] std::uint32_t start(std::uint32_t symbol) const { return start_[symbol]; }
  /// What a state with these lower bits says: offset in the symbol's range, its frequency, the symbol.
  [[nodiscard]] std::uint32_t slot(std::uint32_t low_bits) const { return slots_[low_bits]; }

 private:
  std::array<std::uint16_t, kMostSymbols> frequency_{};
  std::array<std::uint16_t, kMostSymbols> start_{};
  std::array<std::uint32_t, kRansTotal> slots_{};  ///< offset | frequency << 11 | symbol << 23
};

/// Frequencies that add up to kRansTotal and follow `weights`: at least 1 for each weight that is not zero, at most
/// `most`. REQUIRES: some weight is not zero; the sum of the weights is below 2^52.
[[nodiscard]] std::array<std::uint16_t, RansTable::kMostSymbols> rans_frequencies(
    std::span<const std::uint64_t> weights, std::uint32_t most);

/// Takes symbols last one first; words come out last one first, too.
class RansEncoder {
 public:
  void push(const RansTable& table, std::uint32_t symbol, std::vector<std::uint16_t>& words) {
    const std::uint32_t frequency = table.frequency(symbol);
    if (state_ >> (32 - kRansBits) >= frequency) {
      words.push_back(static_cast<std::uint16_t>(state_));
      state_ >>= 16;
    }
    state_ = (state_ / frequency << kRansBits) + state_ % frequency + table.start(symbol);
  }
  [[nodiscard]] std::uint32_t state() const { return state_; }

 private:
  std::uint32_t state_ = kRansLow;
};

/// Words of 16 bits, lowest byte first. Past the end come zeros; who reads there is found out by over().
class WordReader {
 public:
  explicit WordReader(Bytes bytes) : bytes_(bytes) {}

  std::uint32_t take() {
    const std::size_t at = at_;
    at_ += 2;
    if (at_ > bytes_.size()) return 0;
    return bytes_[at] | std::uint32_t{bytes_[at + 1]} << 8;
  }
  [[nodiscard]] bool over() const { return at_ > bytes_.size(); }
  [[nodiscard]] std::size_t position() const { return at_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

class RansDecoder {
 public:
  RansDecoder() = default;
  explicit RansDecoder(std::uint32_t state) : state_(state) {}

  std::uint32_t pop(const RansTable& table, WordReader& words) {
    const std::uint32_t slot = table.slot(state_ & (kRansTotal - 1));
    state_ = (slot >> kRansBits & 0xfff) * (state_ >> kRansBits) + (slot & (kRansTotal - 1));
    if (state_ < kRansLow) state_ = state_ << 16 | words.take();
    return slot >> 23;
  }
  [[nodiscard]] bool at_end() const { return state_ == kRansLow; }

 private:
  std::uint32_t state_ = kRansLow;
};

}  // namespace ramcdb::codec
