#include "db/store_state.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <random>

#include "db/blob_parts.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr BlobKey kStateKey{Kind::store_state, MeshId(), 1, VersionId(), 0};
constexpr std::array<std::uint8_t, 6> kMagic{'R', 'A', 'M', 'C', 'd', 'b'};
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kIdBytes = 16, kIdAt = 8, kSeqAt = 24, kMeshAt = 28, kSize = 32;

void put(Buffer& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t get(Bytes in, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(in[at + i]) << (8 * i);
  return value;
}

}  // namespace

StoreState read_state(const Transaction& transaction) {
  Cursor cursor(transaction);
  if (!cursor.first()) return {};
  const auto blob = read_blob(cursor, kStateKey);
  if (!blob || blob->size() < kSize || std::memcmp(blob->data(), kMagic.data(), kMagic.size()) != 0)
    throw Error(Errc::corrupt, "the blob file does not say whose it is", transaction.file().string(),
                "it is no repository's, or damaged");
  if (const std::uint32_t format = get(*blob, kMagic.size(), 2); format != kFormat)
    throw Error(Errc::unsupported_version, fmt::format("the blob file has format {}", format),
                transaction.file().string(), fmt::format("this program knows format {}: use a newer one", kFormat));
  StoreState state;
  for (std::size_t i = 0; i < kIdBytes; ++i) state.repository_id += fmt::format("{:02x}", (*blob)[kIdAt + i]);
  state.seq = get(*blob, kSeqAt, 4);
  state.last_mesh = get(*blob, kMeshAt, 4);
  return state;
}

void write_state(const Transaction& transaction, const StoreState& state) {
  Buffer blob(kMagic.begin(), kMagic.end());
  put(blob, kFormat, 2);
  for (std::size_t i = 0; i < kIdBytes; ++i)
    blob.push_back(static_cast<std::uint8_t>(std::stoul(state.repository_id.substr(2 * i, 2), nullptr, 16)));
  put(blob, state.seq, 4);
  put(blob, state.last_mesh, 4);
  (void)delete_blob(transaction, kStateKey);
  PartWriter(transaction).put(kStateKey, seal(kStateKey, blob));
}

std::string random_id() {
  std::random_device device;
  std::string id;
  for (int i = 0; i < 4; ++i) id += fmt::format("{:08x}", static_cast<std::uint32_t>(device()));
  return id;
}

}  // namespace ramcdb::db
