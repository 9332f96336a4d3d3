#include "db/blob_key.h"

#include <fmt/format.h>

namespace ramcdb::db {
namespace {

/// The order of kinds within a mesh; the place in this list is what keys hold. Numbers are stored, and never reused.
constexpr std::array kOrder{Kind::store_state, Kind::commit_record, Kind::pending, Kind::mesh_record, Kind::table,
                            Kind::page,        Kind::wire,          Kind::chart,   Kind::attribute};

bool has_layer(Kind kind) { return kind == Kind::attribute || kind == Kind::pending; }

std::uint8_t place_of(Kind kind) {
  return static_cast<std::uint8_t>(1 + (std::find(kOrder.begin(), kOrder.end(), kind) - kOrder.begin()));
}

/// Takes numbers off the front of a key.
class KeyReader {
 public:
  explicit KeyReader(Bytes bytes) : bytes_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

  std::uint32_t byte() {
    if (at_end()) ok_ = false;
    return ok_ ? bytes_[at_++] : 0;
  }

  std::uint32_t number() {
    const std::uint32_t first = byte();
    if (first <= 240) return first;
    if (first < 249) return 240 + 256 * (first - 241) + byte();
    if (first == 249) return 2288 + big_endian(2);
    if (first > 251) ok_ = false;
    return big_endian(first - 247);
  }

 private:
  std::uint32_t big_endian(std::uint32_t count) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < count && ok_; ++i) value = value << 8 | byte();
    return value;
  }

  Bytes bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::page:
      return "page";
    case Kind::wire:
      return "wire";
    case Kind::chart:
      return "chart";
    case Kind::attribute:
      return "attribute";
    case Kind::table:
      return "coder table";
    case Kind::commit_record:
      return "commit record";
    case Kind::pending:
      return "pending list";
    case Kind::mesh_record:
      return "mesh record";
    case Kind::store_state:
      return "store state";
  }
  return "blob";
}

EncodedKey::EncodedKey(const BlobKey& key, std::uint16_t part) {
  append(key.mesh.value);
  bytes_[size_++] = place_of(key.kind);
  if (has_layer(key.kind)) append(key.layer);
  append(key.id);
  append(key.version.value);
  prefix_ = size_;
  append(part);
}

void EncodedKey::append(std::uint32_t value) {
  const auto put = [&](std::uint32_t byte) { bytes_[size_++] = static_cast<std::uint8_t>(byte); };
  if (value <= 240) return put(value);
  if (value <= 2287) {
    put(241 + (value - 240) / 256);
    return put((value - 240) % 256);
  }
  const int bytes = value <= 67823 ? 2 : value < 1U << 24 ? 3 : 4;
  put(static_cast<std::uint32_t>(247 + bytes));
  const std::uint32_t rest = bytes == 2 ? value - 2288 : value;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) put(rest >> shift & 0xFF);
}

void EncodedKey::set_part(std::uint16_t part) {
  size_ = prefix_;
  append(part);
}

std::optional<DecodedKey> decode_key(Bytes bytes) {
  KeyReader in(bytes);
  DecodedKey out;
  out.key.mesh = MeshId(in.number());
  const std::uint32_t place = in.byte();
  if (place < 1 || place > kOrder.size()) return std::nullopt;
  out.key.kind = kOrder[place - 1];
  if (has_layer(out.key.kind)) out.key.layer = static_cast<std::uint16_t>(in.number());
  out.key.id = in.number();
  out.key.version = VersionId(in.number());
  out.part = static_cast<std::uint16_t>(in.number());
  if (!in.ok() || !in.at_end()) return std::nullopt;
  // One form only: what is longer than it need be is no key.
  const EncodedKey again(out.key, out.part);
  if (!std::equal(bytes.begin(), bytes.end(), again.bytes().begin(), again.bytes().end())) return std::nullopt;
  return out;
}

std::string describe(const BlobKey& key) {
  if (key.kind == Kind::commit_record || key.kind == Kind::pending)
    return fmt::format("{} of version {}", kind_name(key.kind), key.id);
  std::string text =
      fmt::format("{} {} of mesh {}, version {}", kind_name(key.kind), key.id, key.mesh.value, key.version.value);
  if (key.layer) text += fmt::format(", layer {}", key.layer);
  return text;
}

}  // namespace ramcdb::db
