#include "db/blob_key.h"

#include <fmt/format.h>

namespace ramcdb::db {
namespace {

std::uint32_t take(const std::uint8_t*& at, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | *at++;
  return value;
}

constexpr std::uint32_t kKindComplement = 255;

/// The kind that the first byte of a key in `main` says.
std::optional<Kind> kind_in_main(std::uint32_t first_byte) {
  const std::uint32_t kind = kKindComplement - first_byte;
  if (kind < 1 || kind > static_cast<std::uint32_t>(Kind::store_state)) return std::nullopt;
  if (table_of(static_cast<Kind>(kind)) != Table::main) return std::nullopt;
  return static_cast<Kind>(kind);
}

}  // namespace

Table table_of(Kind kind) {
  switch (kind) {
    case Kind::wire:
      return Table::wire;
    case Kind::chart:
      return Table::chart;
    case Kind::attribute:
      return Table::attribute;
    default:
      return Table::main;
  }
}

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
  const Table table = table_of(key.kind);
  if (table == Table::main) append(kKindComplement - static_cast<std::uint32_t>(key.kind), 1);
  append(key.mesh.value, 2);
  if (table == Table::main || table == Table::attribute) append(key.layer, 2);
  append(key.id, 4);
  append(key.version.value, 4);
  append(part, 2);
}

void EncodedKey::append(std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) bytes_[size_++] = static_cast<std::uint8_t>(value >> shift);
}

void EncodedKey::set_part(std::uint16_t part) {
  size_ -= 2;
  append(part, 2);
}

std::optional<DecodedKey> decode_key(Table table, const std::uint8_t* data, std::size_t size) {
  const std::size_t expected = table == Table::main ? 15 : table == Table::attribute ? 14 : 12;
  if (size != expected) return std::nullopt;
  constexpr std::array kKinds{Kind::page, Kind::wire, Kind::chart, Kind::attribute};  // of `main` it is in the key
  DecodedKey out;
  out.key.kind = kKinds[static_cast<std::size_t>(table)];
  if (table == Table::main) {
    const auto kind = kind_in_main(take(data, 1));
    if (!kind) return std::nullopt;
    out.key.kind = *kind;
  }
  out.key.mesh = MeshId(take(data, 2));
  if (table == Table::main || table == Table::attribute) out.key.layer = static_cast<std::uint16_t>(take(data, 2));
  out.key.id = take(data, 4);
  out.key.version = VersionId(take(data, 4));
  out.part = static_cast<std::uint16_t>(take(data, 2));
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
