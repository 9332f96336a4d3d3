#pragma once

#include <cstdint>
#include <string_view>

#include "ramcdb/bytes.h"
#include "ramcdb/error.h"

/// Whole numbers in bytes: seven bits per byte, lowest first, the top bit says that more follow. Each number has one
/// form only: a last byte of zero behind others is refused.
namespace ramcdb::codec {

inline void put_varint(Buffer& out, std::uint64_t value) {
  for (; value >= 128; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 128));
  out.push_back(static_cast<std::uint8_t>(value));
}

/// 0, -1, 1, -2, 2 ... become 0, 1, 2, 3, 4 ...
inline std::uint64_t zigzag(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}
inline std::int64_t unzigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}
inline void put_signed_varint(Buffer& out, std::int64_t value) { put_varint(out, zigzag(value)); }

/// Takes values from the front of bytes that may be hostile. Everything throws corrupt rather than read past the end.
class ByteReader {
 public:
  /// `what` names the blob in errors; it must outlive the reader, as `bytes` must.
  ByteReader(Bytes bytes, std::string_view what) : rest_(bytes), what_(what) {}

  std::uint8_t byte() { return take(1)[0]; }

  Bytes take(std::size_t count) {
    if (count > rest_.size()) fail("ends too early");
    const Bytes taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint64_t>(next & 127) << shift;
      if (next < 128) {
        if ((next == 0 && shift > 0) || (shift == 63 && next > 1)) break;
        return value;
      }
    }
    fail("has a number in no valid form");
  }

  /// A varint that must not exceed `max`.
  std::uint32_t varint_up_to(std::uint32_t max) {
    const std::uint64_t value = varint();
    if (value > max) fail("has a number that is too large");
    return static_cast<std::uint32_t>(value);
  }

  std::int64_t signed_varint() { return unzigzag(varint()); }

  /// Four bytes, lowest first.
  std::uint32_t fixed32() {
    const Bytes b = take(4);
    return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
  }

  [[nodiscard]] Bytes rest() const { return rest_; }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  void expect_end() const {
    if (!at_end()) fail("has bytes behind its end");
  }

  [[noreturn]] void fail(std::string_view problem) const {
    throw Error(Errc::corrupt, std::string("a ").append(what_).append(" ").append(problem));
  }

 private:
  Bytes rest_;
  std::string_view what_;
};

inline void put_fixed32(Buffer& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace ramcdb::codec
