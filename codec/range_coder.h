#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "codec/vectors.h"
#include "ramcdb/bytes.h"

/// An adaptive binary range coder: what all blobs of the codec are written with.
///
/// The coder narrows an interval [low, low + range) of 64-bit numbers, bit by bit; a one takes the lower part. Whenever
/// range falls below 2^32, the upper 32 bits of low are final but for a carry, and leave as four bytes, most
/// significant first. At the end come the fewest bytes (0 to 8) that, followed by zeros, name a number of the interval.
/// So a stream has exactly one length, which the decoder computes too: a stream that was cut or has anything behind it
/// is noticed, and a decoder never asks for more than 8 bytes past the end.
///
/// After G. N. N. Martin, "Range encoding" (1979), with the carry propagated into bytes already written.
namespace ramcdb::codec {

namespace range_coder_detail {

inline constexpr int kRateLimit = 120;

/// 32768 / (n + 1.6): how far the n-th observation moves a probability.
inline constexpr auto kRates = [] {
  std::array<std::uint16_t, kRateLimit + 1> rates{};
  for (std::size_t n = 0; n < rates.size(); ++n) rates[n] = static_cast<std::uint16_t>(327680 / (10 * n + 16));
  return rates;
}();

/// 256 * log2(1 + i / 256) for i < 256, rounded; by repeated squaring in fixed point, so that no libm decides.
inline constexpr auto kLog2 = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint64_t x = (256 + i) << 23;  // in [1, 2), 31 fractional bits
    std::uint32_t bits = 0;
    for (int k = 0; k < 12; ++k) {
      x = (x * x) >> 31;
      const auto bit = static_cast<std::uint32_t>(x >> 32);
      bits = 2 * bits + bit;
      x >>= bit;
    }
    table[i] = static_cast<std::uint16_t>((bits + 8) >> 4);
  }
  return table;
}();

/// 256 * log2(x) for x > 0.
inline std::uint64_t log2_256(std::uint64_t x) {
  const int top = static_cast<int>(std::bit_width(x)) - 1;
  return 256 * static_cast<std::uint64_t>(top) + kLog2[((x << (63 - top)) >> 55) & 255];
}

/// How much was coded when `words` words have left and `range` remains, in 1/256 bit.
inline std::uint64_t position_256(std::uint64_t words, std::uint64_t range) {
  return 256 * (32 * words + 64) - log2_256(range);
}

/// The end of a stream: the 64-bit number to send (its first `bytes` bytes; the others are zero) and whether reaching
/// it carries into the bytes before.
struct Flush {
  std::uint64_t value = 0;
  int bytes = 0;
  bool carry = false;
};
Flush shortest_flush(std::uint64_t low, std::uint64_t range);

}  // namespace range_coder_detail

/// The probability of a one in 1/65536, learned while coding: quickly at first, then over the last 120 bits or so.
class AdaptiveBit {
 public:
  constexpr AdaptiveBit() = default;
  /// Starts from a probability that stands for `observations` earlier bits (at most 120).
  constexpr AdaptiveBit(std::uint16_t p, std::uint16_t observations)
      : p_(std::clamp(p, kLeast, kMost)), n_(observations) {}

  /// In [48, 65488], so that no bit costs more than 10.5 bits or less than 1/1000 bit.
  [[nodiscard]] std::uint32_t p_one() const { return p_; }

  void learn(bool bit) {
    const int target = bit ? kMost : kLeast;
    const std::int32_t step = (target - p_) * range_coder_detail::kRates[n_];
    p_ = static_cast<std::uint16_t>(p_ + (step >> 15));
    n_ = static_cast<std::uint16_t>(n_ + (n_ < range_coder_detail::kRateLimit));
  }

 private:
  static constexpr std::uint16_t kLeast = 48, kMost = 65536 - 48;

  std::uint16_t p_ = 32768;
  std::uint16_t n_ = 0;
};

/// Writes bits. Single use: after finish() only position() makes sense.
///
/// code() and code_raw() return what they were given. The decoder has the same calls and ignores the value, so that a
/// format can be written once, as a template over the coder, and both directions cannot drift apart.
class RangeEncoder {
 public:
  static constexpr bool kEncodes = true;

  bool code(AdaptiveBit& model, bool bit) {
    const std::uint64_t part = (range_ >> 16) * model.p_one();
    if (bit) {
      range_ = part;
    } else {
      add(part);
      range_ -= part;
    }
    model.learn(bit);
    if (range_ >> 32 == 0) shift_out();
    return bit;
  }

  /// One of the symbols of `model`, an AdaptiveSymbol; the last one also takes what rounding leaves.
  template <class Model>
  std::uint32_t code_symbol(Model& model, std::uint32_t symbol) {
    const std::uint64_t unit = range_ >> 16, begin = model.begin(symbol), below = unit * begin;
    range_ = symbol == Model::kSymbols - 1 ? range_ - below : unit * (model.end(symbol) - begin);
    add(below);
    model.learn(symbol);
    if (range_ >> 32 == 0) shift_out();
    return symbol;
  }

  /// The lower `bits` bits of `value`, unmodelled; 0 <= bits <= 32. REQUIRES: value < 2^bits.
  std::uint32_t code_raw(std::uint32_t value, int bits) {
    if (bits > 16) {
      code_chunk(value >> 16, bits - 16);
      code_chunk(value & 0xffff, 16);
    } else if (bits > 0) {
      code_chunk(value, bits);
    }
    return value;
  }

  /// What was coded so far, in 1/256 bit. Only differences mean something; those of parts add up exactly.
  [[nodiscard]] std::uint64_t position() const { return range_coder_detail::position_256(out_.size() / 4, range_); }

  /// Ends the stream and returns it.
  [[nodiscard]] Buffer finish();

 private:
  void add(std::uint64_t amount) {
    low_ += amount;
    if (low_ < amount) carry();
  }
  void code_chunk(std::uint32_t value, int bits) {
    range_ >>= bits;
    add(range_ * value);
    if (range_ >> 32 == 0) shift_out();
  }
  void carry();
  void shift_out();

  std::uint64_t low_ = 0;
  std::uint64_t range_ = ~std::uint64_t{0};
  Buffer out_;
};

/// Reads what RangeEncoder wrote. Throws corrupt as soon as it would need more bytes than any encoder leaves out, so
/// whatever loop it is asked to drive ends. `stream` must outlive it.
class RangeDecoder {
 public:
  static constexpr bool kEncodes = false;

  explicit RangeDecoder(Bytes stream) : stream_(stream) {
    shift_in();
    shift_in();
  }

  RAMCDB_INLINE bool code(AdaptiveBit& model, bool /*ignored*/ = false) {
    const std::uint64_t part = (range_ >> 16) * model.p_one();
    const bool bit = offset_ < part;
    if (bit) {
      range_ = part;
    } else {
      offset_ -= part;
      range_ -= part;
    }
    model.learn(bit);
    if (range_ >> 32 == 0) {
      shift_in();
      range_ <<= 32;
    }
    return bit;
  }

  template <class Model>
  RAMCDB_INLINE std::uint32_t code_symbol(Model& model, std::uint32_t /*ignored*/ = 0) {
    const std::uint64_t unit = range_ >> 16;
    const std::uint32_t symbol = model.find(static_cast<std::uint32_t>(std::min<std::uint64_t>(offset_ / unit, 65535)));
    const std::uint64_t begin = model.begin(symbol), below = unit * begin;
    range_ = symbol == Model::kSymbols - 1 ? range_ - below : unit * (model.end(symbol) - begin);
    offset_ -= below;
    model.learn(symbol);
    if (range_ >> 32 == 0) {
      shift_in();
      range_ <<= 32;
    }
    return symbol;
  }

  std::uint32_t code_raw(std::uint32_t /*ignored*/, int bits) {
    if (bits > 16) {
      const std::uint32_t high = code_chunk(bits - 16);
      return high << 16 | code_chunk(16);
    }
    return bits > 0 ? code_chunk(bits) : 0;
  }

  /// As RangeEncoder::position() at the same place.
  [[nodiscard]] std::uint64_t position() const { return range_coder_detail::position_256(read_ / 4 - 2, range_); }

  /// Throws corrupt unless an encoder that coded just these bits would have written just this stream: nothing was cut
  /// off, nothing follows.
  void finish() const;

 private:
  std::uint32_t code_chunk(int bits) {
    range_ >>= bits;
    const std::uint64_t value = offset_ / range_;
    if (value >> bits != 0) refuse();  // the rounding gap above the last value: no encoder goes there
    offset_ -= value * range_;
    if (range_ >> 32 == 0) {
      shift_in();
      range_ <<= 32;
    }
    return static_cast<std::uint32_t>(value);
  }
  void shift_in() {
    if (read_ + 4 <= stream_.size()) {
      const std::uint8_t* p = stream_.data() + read_;
      const std::uint32_t word = static_cast<std::uint32_t>(p[0]) << 24 | static_cast<std::uint32_t>(p[1]) << 16 |
                                 static_cast<std::uint32_t>(p[2]) << 8 | p[3];
      offset_ = offset_ << 32 | word;
      read_ += 4;
    } else {
      offset_ = offset_ << 32 | word_at_end(stream_, read_);
      read_ += 4;
    }
  }
  static std::uint32_t word_at_end(Bytes stream, std::size_t at);
  [[noreturn]] static void refuse();

  Bytes stream_;
  std::size_t read_ = 0;      ///< bytes taken, those past the end included
  std::uint64_t offset_ = 0;  ///< the number that was sent, less low
  std::uint64_t range_ = ~std::uint64_t{0};
};

/// Unsigned numbers of up to 32 bits, small ones cheap: the bit count of value + 1 in unary, its second and third bit
/// modelled by bit count, the rest raw (an adaptive exp-Golomb code).
class AdaptiveUnsigned {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value = 0) {
    const std::uint64_t plus_one = std::uint64_t{value} + 1;
    const int actual = static_cast<int>(std::bit_width(plus_one)) - 1;
    int exponent = 0;
    while (exponent < 32 && coder.code(exponent_[at(exponent)], actual > exponent)) ++exponent;

    std::uint64_t x = 1;
    int left = exponent;
    if (left > 0) {
      x = 2 * x + coder.code(second_[at(exponent)], bit_of(plus_one, --left));
      if (left > 0) x = 2 * x + coder.code(third_[2 * at(exponent) + (x & 1)], bit_of(plus_one, --left));
    }
    const auto low = static_cast<std::uint32_t>(plus_one & ((std::uint64_t{1} << left) - 1));
    x = x << left | coder.code_raw(low, left);
    return static_cast<std::uint32_t>(x - 1);  // 2^32 + ... of a hostile stream wraps: any number is a legal result
  }

 private:
  static std::size_t at(int exponent) { return static_cast<std::size_t>(exponent); }
  static bool bit_of(std::uint64_t x, int i) { return (x >> i) & 1; }

  std::array<AdaptiveBit, 32> exponent_;
  std::array<AdaptiveBit, 33> second_;
  std::array<AdaptiveBit, 66> third_;
};

/// Signed numbers: zero?, sign, magnitude - 1. Any int32 but the smallest.
class AdaptiveSigned {
 public:
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t value = 0) {
    if (!coder.code(nonzero_, value != 0)) return 0;
    const bool negative = coder.code(negative_, value < 0);
    const std::uint32_t magnitude =
        value < 0 ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
    const std::uint32_t coded = 1u + (magnitude_.code(coder, magnitude - 1) & 0x7fffffff);
    return static_cast<std::int32_t>(negative ? 0u - coded : coded);
  }

 private:
  AdaptiveBit nonzero_;
  AdaptiveBit negative_;
  AdaptiveUnsigned magnitude_;
};

}  // namespace ramcdb::codec
