#pragma once

#include <cstddef>
#include <cstdint>

#include "codec/fast_rans.h"
#include "ramcdb/bytes.h"

/// Bits as they are, highest first. They are read from the end of a buffer, so that other things may be read from its
/// beginning.
namespace ramcdb::codec {

class RawBitWriter {
 public:
  void put(std::uint32_t value, std::uint32_t count) {
    for (std::uint32_t i = count; i-- > 0;) {
      if (filled_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1) << (7 - filled_ % 8));
      ++filled_;
    }
  }
  [[nodiscard]] Buffer backwards() const { return {bytes_.rbegin(), bytes_.rend()}; }

 private:
  Buffer bytes_;
  std::size_t filled_ = 0;
};

/// Reads them from the end of `bytes`. Before the beginning come zeros.
class RawBitReader {
 public:
  RawBitReader() = default;
  explicit RawBitReader(Bytes bytes) : bytes_(bytes) {}

  /// The next bits, highest first: 57 at least.
  [[nodiscard]] std::uint64_t window() const {
    const std::size_t skip = at_ / 8;
    if (skip + 8 > bytes_.size()) return window_at_end(bytes_, skip) << at_ % 8;
    return load_le64(bytes_.data() + (bytes_.size() - skip - 8)) << at_ % 8;
  }
  void skip(std::uint32_t count) { at_ += count; }

  /// Up to 32 bits.
  std::uint32_t take(std::uint32_t count) {
    const std::uint64_t bits = window();
    skip(count);
    return static_cast<std::uint32_t>(bits >> 32 >> (32 - count));
  }
  /// Bytes that were read of, the last one perhaps in part; what is left of that must be zeros.
  [[nodiscard]] std::size_t bytes_taken() const { return (at_ + 7) / 8; }
  /// The first of these bits, which are less than 64.
  [[nodiscard]] static std::uint32_t top(std::uint64_t window, std::uint32_t bits) {
    return static_cast<std::uint32_t>(window >> 1 >> (63 - bits));
  }
  [[nodiscard]] std::uint32_t padding() { return take(static_cast<std::uint32_t>(8 * bytes_taken() - at_)); }

 private:
  [[gnu::noinline]] static std::uint64_t window_at_end(Bytes bytes, std::size_t skip) {
    std::uint64_t window = 0;
    for (std::size_t i = 0; i < 8; ++i)
      window = window << 8 | (skip + i < bytes.size() ? bytes[bytes.size() - 1 - skip - i] : 0u);
    return window;
  }

  Bytes bytes_;
  std::size_t at_ = 0;  ///< bits taken
};

}  // namespace ramcdb::codec
