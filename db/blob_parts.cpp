#include "db/blob_parts.h"

#define XXH_INLINE_ALL
#include <lmdb.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

// LMDB 0.9 on pages of 4,096 bytes: a leaf page has 4,080 bytes for nodes, a node is 8 bytes, key and value, rounded up
// to even, and 2 bytes of index; one that takes more than half a page goes to pages of its own, 16 bytes less in all.
constexpr std::size_t kPage = 4096, kPageHeader = 16;
constexpr std::size_t kLeafRoom = 4080, kNodeOverhead = 10, kLongestNode = 2040;
constexpr std::size_t kWorthAPage = 2800;  // two halves of it in leaf pages, which splits leave 70 % full, take as much
constexpr std::size_t kShortestFill = 64;  // a part shorter than this is not worth its key
constexpr std::size_t kMaxParts = 0x10000;

std::size_t node_size(const EncodedKey& key, std::size_t value) {
  return (kNodeOverhead + key.bytes().size() + value + 1) & ~std::size_t{1};
}

std::size_t longest_value(const EncodedKey& key, std::size_t room) {
  const std::size_t overhead = kNodeOverhead + key.bytes().size();
  return std::min(room, kLongestNode) <= overhead ? 0 : (std::min(room, kLongestNode) & ~std::size_t{1}) - overhead;
}

std::uint64_t checksum(const BlobKey& key, Bytes payload) {
  const EncodedKey encoded(key, 0);
  const std::uint64_t seed = XXH3_64bits(encoded.blob_prefix().data(), encoded.blob_prefix().size());
  return XXH3_64bits_withSeed(payload.data(), payload.size(), seed);
}

bool is_key(Bytes key, const EncodedKey& wanted) {
  return std::equal(key.begin(), key.end(), wanted.bytes().begin(), wanted.bytes().end());
}

}  // namespace

Buffer seal(const BlobKey& key, Bytes payload) {
  Buffer sealed;
  sealed.reserve(payload.size() + kChecksumBytes);
  sealed.assign(payload.begin(), payload.end());
  const std::uint64_t sum = checksum(key, payload);
  for (int shift = 0; shift < 64; shift += 8) sealed.push_back(static_cast<std::uint8_t>(sum >> shift));
  return sealed;
}

void PartWriter::put(const BlobKey& key, Bytes sealed) {
  EncodedKey encoded(key, 0);
  if (!appending_) {
    Cursor cursor(transaction_);
    appending_ = !cursor.seek(encoded);
  }
  const std::size_t longest = longest_value(encoded, kLeafRoom);
  if ((sealed.size() + longest - 1) / longest >= kMaxParts)
    throw Error(Errc::limit_exceeded, "a blob is larger than 130 MB", describe(key));
  std::size_t at = 0;
  for (std::uint16_t part = 0; at < sealed.size(); ++part) {
    const std::size_t rest = sealed.size() - at;
    const std::size_t size = appending_ ? size_to_fill(encoded, rest) : size_between(encoded, rest);
    encoded.set_part(part);
    put_part(encoded, sealed.subspan(at, size), appending_);
    at += size;
  }
}

std::size_t PartWriter::size_to_fill(const EncodedKey& key, std::size_t rest) const {
  const std::size_t fits = longest_value(key, room_);
  return std::min(rest, fits >= std::min(rest, kShortestFill) ? fits : longest_value(key, kLeafRoom));
}

std::size_t PartWriter::size_between(const EncodedKey& key, std::size_t rest) {
  const std::size_t longest = longest_value(key, kLeafRoom);
  if (rest <= longest) return rest;
  if (const std::size_t pages = (rest + kPageHeader) / kPage; pages > 0) return pages * kPage - kPageHeader;
  return rest < kWorthAPage ? (rest + 1) / 2 : rest;
}

void PartWriter::put_part(const EncodedKey& key, Bytes part, bool append) {
  MDB_val k{key.bytes().size(), const_cast<std::uint8_t*>(key.bytes().data())},
      v{part.size(), const_cast<std::uint8_t*>(part.data())};
  const MDB_dbi dbi = transaction_.table();
  const int rc = mdb_put(transaction_.get(), dbi, &k, &v, append ? MDB_APPEND : MDB_NOOVERWRITE);
  if (rc == MDB_KEYEXIST)
    throw Error(Errc::corrupt, "a blob that is to be written exists already", transaction_.file().string(),
                "run `ramcdb verify`");
  check_lmdb(rc, transaction_.file());
  MDB_stat stat;
  check_lmdb(mdb_stat(transaction_.get(), dbi, &stat), transaction_.file());
  if (stat.ms_leaf_pages != leaf_pages_) room_ = kLeafRoom;
  leaf_pages_ = stat.ms_leaf_pages;
  room_ -= std::min(room_, node_size(key, part.size()));
}

std::optional<Buffer> read_blob(Cursor& cursor, const BlobKey& key) {
  EncodedKey encoded(key, 0);
  if (!cursor.seek(encoded) || !is_key(cursor.key(), encoded)) return std::nullopt;
  Buffer blob;
  std::uint16_t part = 0;
  do {
    const Bytes value = cursor.value();
    blob.insert(blob.end(), value.begin(), value.end());
    encoded.set_part(++part);
  } while (cursor.next() && is_key(cursor.key(), encoded));
  const auto damaged = [&] {
    return Error(Errc::corrupt, "a stored blob is damaged", describe(key),
                 "run `ramcdb verify`, restore from a backup");
  };
  if (blob.size() < kChecksumBytes) throw damaged();
  const std::size_t size = blob.size() - kChecksumBytes;
  std::uint64_t stored = 0;
  for (std::size_t i = 0; i < kChecksumBytes; ++i) stored |= static_cast<std::uint64_t>(blob[size + i]) << (8 * i);
  blob.resize(size);
  if (checksum(key, blob) != stored) throw damaged();
  return blob;
}

bool delete_blob(const Transaction& transaction, const BlobKey& key) {
  EncodedKey encoded(key, 0);
  bool any = false;
  for (std::uint32_t part = 0; part < kMaxParts; ++part) {
    encoded.set_part(static_cast<std::uint16_t>(part));
    MDB_val k{encoded.bytes().size(), const_cast<std::uint8_t*>(encoded.bytes().data())};
    const int rc = mdb_del(transaction.get(), transaction.table(), &k, nullptr);
    if (rc == MDB_NOTFOUND) break;
    check_lmdb(rc, transaction.file());
    any = true;
  }
  return any;
}

}  // namespace ramcdb::db
