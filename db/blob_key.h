#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "db/store.h"

namespace ramcdb::db {

/// The LMDB databases: `main` is the unnamed one of the file and holds all kinds of which there is little, for each
/// database needs pages of its own. The others are named.
enum class Table : std::uint8_t { main, wire, chart, attribute };
inline constexpr std::size_t kTableCount = 4;
inline constexpr std::array<const char*, kTableCount> kTableNames{nullptr, "wire", "chart", "attribute"};

[[nodiscard]] Table table_of(Kind kind);
[[nodiscard]] const char* kind_name(Kind kind);

/// A key as LMDB holds it, big-endian so that keys sort by mesh, then object, then version, then part:
///
///     wire, chart   mesh:u16 | id:u32 | version:u32 | part:u16                          12 bytes
///     attribute     mesh:u16 | layer:u16 | id:u32 | version:u32 | part:u16              14 bytes
///     main          255-kind:u8 | mesh:u16 | layer:u16 | id:u32 | version:u32 | part:u16    15 bytes
///
/// In `main` the names of the other tables come first and pages last, so that the pages of a new mesh are appended.
class EncodedKey {
 public:
  EncodedKey(const BlobKey& key, std::uint16_t part);

  [[nodiscard]] const std::uint8_t* data() const { return bytes_.data(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The bytes that all parts of one blob have in common.
  [[nodiscard]] std::size_t blob_prefix() const { return size_ - 2; }
  void set_part(std::uint16_t part);

  friend bool operator<(const EncodedKey& a, const EncodedKey& b) {
    return std::lexicographical_compare(a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
  }

 private:
  void append(std::uint32_t value, int bytes);

  std::array<std::uint8_t, 15> bytes_{};
  std::size_t size_ = 0;
};

struct DecodedKey {
  BlobKey key;
  std::uint16_t part = 0;
};
/// Nothing where the bytes are no key of the table.
[[nodiscard]] std::optional<DecodedKey> decode_key(Table table, const std::uint8_t* data, std::size_t size);

/// "chart 17 of mesh 1, version 3"
[[nodiscard]] std::string describe(const BlobKey& key);

}  // namespace ramcdb::db
