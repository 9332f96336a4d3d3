#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
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

  [[nodiscard]] std::uint32_t frequency(std::uint32_t symbol) const { return ranges_[symbol].frequency; }
  [[nodiscard]] std::uint32_t start(std::uint32_t symbol) const { return ranges_[symbol].start; }
  /// The symbol that a state with these lower bits says.
  [[nodiscard]] std::uint32_t symbol(std::uint32_t low_bits) const { return symbols_[low_bits]; }

 private:
  struct Range {
    std::uint16_t frequency = 0, start = 0;
  };
  // Small, so that the tables in use stay in the nearest cache.
  std::array<std::uint8_t, kRansTotal> symbols_{};
  std::array<Range, kMostSymbols> ranges_{};
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

inline std::uint32_t load_le16(const std::uint8_t* from) {
  std::uint16_t word;
  std::memcpy(&word, from, 2);
  if constexpr (std::endian::native == std::endian::little) return word;
  return static_cast<std::uint32_t>(from[0]) | static_cast<std::uint32_t>(from[1]) << 8;
}
inline std::uint64_t load_le64(const std::uint8_t* from) {
  std::uint64_t word = 0;
  if constexpr (std::endian::native == std::endian::little)
    std::memcpy(&word, from, 8);
  else
    for (int i = 8; i-- > 0;) word = word << 8 | from[i];
  return word;
}

/// Words of 16 bits, lowest byte first. Past the end come zeros; who reads there is found out by over().
class WordReader {
 public:
  WordReader() = default;
  explicit WordReader(Bytes bytes) : begin_(bytes.data()), at_(begin_), end_(begin_ + bytes.size()) {}

  std::uint32_t take() {
    if (has(1)) {
      const std::uint32_t word = peek();
      skip(1);
      return word;
    }
    over_ = true;
    return 0;
  }
  /// Whether `count` words are there for sure, so that peek() and skip() will do.
  [[nodiscard]] bool has(std::ptrdiff_t count) const { return end_ - at_ >= 2 * count; }
  [[nodiscard]] std::uint32_t peek() const { return load_le16(at_); }
  void skip(std::size_t count) { at_ += 2 * count; }

  [[nodiscard]] bool over() const { return over_; }
  [[nodiscard]] std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }

 private:
  const std::uint8_t* begin_ = nullptr;
  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  bool over_ = false;
};

/// States that take turns, so that a processor works at all of them at once; so many symbols are worth their bytes.
inline constexpr std::size_t kRansLanes = 4;
[[nodiscard]] inline std::size_t rans_lanes(std::size_t symbols) { return symbols < 512 ? 1 : kRansLanes; }

inline void put_words(Buffer& out, std::span<const std::uint16_t> last_first) {
  for (std::size_t i = last_first.size(); i-- > 0;) {
    out.push_back(static_cast<std::uint8_t>(last_first[i]));
    out.push_back(static_cast<std::uint8_t>(last_first[i] >> 8));
  }
}

class RansDecoder {
 public:
  RansDecoder() = default;
  explicit RansDecoder(std::uint32_t state) : state_(state) {}

  std::uint32_t pop(const RansTable& table, WordReader& words) {
    const std::uint32_t symbol = step(table);
    if (state_ < kRansLow) state_ = state_ << 16 | words.take();
    return symbol;
  }

  /// The same without a branch: whether a word is needed nobody can guess. REQUIRES: words.has(1).
  std::uint32_t pop_sure(const RansTable& table, WordReader& words) {
    const std::uint32_t symbol = step(table);
    const std::uint32_t all_if_low = 0u - static_cast<std::uint32_t>(state_ < kRansLow);
    state_ = state_ << (all_if_low & 16) | (words.peek() & all_if_low);
    words.skip(all_if_low & 1);
    return symbol;
  }
  [[nodiscard]] bool at_end() const { return state_ == kRansLow; }

 private:
  std::uint32_t step(const RansTable& table) {
    const std::uint32_t low = state_ & (kRansTotal - 1), symbol = table.symbol(low);
    state_ = table.frequency(symbol) * (state_ >> kRansBits) + low - table.start(symbol);
    return symbol;
  }

  std::uint32_t state_ = kRansLow;
};

/// Symbols of one distribution, the first with the first state. REQUIRES: states.size() is 1 or kRansLanes.
void push_run(std::span<RansEncoder> states, const RansTable& table, std::span<const std::uint8_t> symbols,
              std::vector<std::uint16_t>& words);
void pop_run(std::span<RansDecoder> states, const RansTable& table, WordReader& words, std::span<std::uint8_t> symbols);

}  // namespace ramcdb::codec
