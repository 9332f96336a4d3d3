#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "db/store.h"

namespace ramcdb::db {

[[nodiscard]] const char* kind_name(Kind kind);

/// A key as LMDB holds it. All blobs are in one table: a mesh's lie together, kind by kind, in the order of ids, and
/// the blobs of a mesh that is imported come behind all others, so that they are appended.
///
///     key    = mesh number | place of the kind u8 | [layer number] | id number | version number | part number
///     number = 1 to 5 bytes that sort like their values:
///              value <= 240         value
///              value <= 2,287       241 + (value - 240) / 256, (value - 240) % 256
///              value <= 67,823      249, value - 2,288 in 2 bytes, big-endian
///              value < 2^24         250, value in 3 bytes
///              else                 251, value in 4 bytes
///
/// Attributes and pending lists have a layer.
class EncodedKey {
 public:
  EncodedKey(const BlobKey& key, std::uint16_t part);

  [[nodiscard]] Bytes bytes() const { return {bytes_.data(), size_}; }
  /// The bytes that all parts of one blob have in common.
  [[nodiscard]] Bytes blob_prefix() const { return {bytes_.data(), prefix_}; }
  void set_part(std::uint16_t part);

  friend bool operator<(const EncodedKey& a, const EncodedKey& b) {
    return std::lexicographical_compare(a.bytes_.begin(), a.bytes_.begin() + a.size_, b.bytes_.begin(),
                                        b.bytes_.begin() + b.size_);
  }

 private:
  void append(std::uint32_t value);

  std::array<std::uint8_t, 24> bytes_{};
  std::uint8_t size_ = 0, prefix_ = 0;
};

struct DecodedKey {
  BlobKey key;
  std::uint16_t part = 0;
};
/// Nothing where the bytes are no key.
[[nodiscard]] std::optional<DecodedKey> decode_key(Bytes bytes);

/// "chart 17 of mesh 1, version 3"
[[nodiscard]] std::string describe(const BlobKey& key);

}  // namespace ramcdb::db
