#include "db/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "db/blob_parts.h"
#include "db/fail_points.h"
#include "db/key_list.h"
#include "db/store_state.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

/// All keys of a rare kind, one per blob.
std::vector<BlobKey> keys_of(const Transaction& transaction, Kind kind) {
  std::vector<BlobKey> keys;
  Cursor cursor(transaction);
  if (!cursor.seek(EncodedKey({kind, MeshId(), 0, VersionId(), 0}, 0))) return keys;
  do {
    const auto decoded = decode_key(cursor.key());
    if (!decoded || decoded->key.kind != kind) break;
    if (decoded->part == 0) keys.push_back(decoded->key);
  } while (cursor.next());
  return keys;
}

/// Versions with a commit record, newer than the newest row.
std::set<VersionId> records_after(const Transaction& transaction, VersionId newest) {
  std::set<VersionId> versions;
  Cursor cursor(transaction);
  if (!cursor.seek(EncodedKey(record_key(VersionId(newest.value + 1)), 0))) return versions;
  do {
    const auto decoded = decode_key(cursor.key());
    if (!decoded || decoded->key.kind != Kind::commit_record) break;
    versions.insert(decoded->key.version);
  } while (cursor.next());
  return versions;
}

}  // namespace

void take_back(const Transaction& transaction, VersionId version) {
  for (const BlobKey& list : keys_of(transaction, Kind::pending)) {
    if (list.version != version) continue;
    std::vector<BlobKey> keys;
    {
      Cursor cursor(transaction);
      keys = decode_key_list(*read_blob(cursor, list), version);
    }
    for (const BlobKey& key : keys) (void)delete_blob(transaction, key);
    (void)delete_blob(transaction, list);
  }
  (void)delete_blob(transaction, record_key(version));
}

void drop_pending_lists(const Transaction& transaction, const std::vector<VersionId>& versions) {
  if (versions.empty()) return;
  for (const BlobKey& list : keys_of(transaction, Kind::pending))
    if (std::binary_search(versions.begin(), versions.end(), list.version)) (void)delete_blob(transaction, list);
}

std::vector<VersionId> recover(Environment& environment, Catalogue& catalogue) {
  environment.sweep_readers();
  // A writer that was killed after LMDB's commit may not have told other processes of it. Reading would still see what
  // was there before; beginning to write finds out.
  (void)environment.write();
  std::vector<VersionId> published;
  std::set<VersionId> unpublished;
  {
    const auto transaction = environment.read();
    const VersionId newest = catalogue.newest();
    if (const std::uint32_t seq = read_state(*transaction).seq; seq < newest.value)
      throw Error(
          Errc::corrupt,
          fmt::format("the blobs are older than the history: versions {} to {} have none", seq + 1, newest.value),
          environment.file().string(), "restore both files from the same backup; reading older versions works");
    unpublished = records_after(*transaction, newest);
    if (unpublished.size() > 1)
      throw Error(Errc::corrupt,
                  fmt::format("the history is older than the blobs: versions {} to {} are not in it",
                              unpublished.begin()->value, unpublished.rbegin()->value),
                  environment.file().string(), "restore both files from the same backup");
    for (const BlobKey& list : keys_of(*transaction, Kind::pending)) {
      if (catalogue.version(list.version))
        published.push_back(list.version);
      else
        unpublished.insert(list.version);
    }
  }
  if (!unpublished.empty()) {
    fail_point("recovery.begin");
    environment.reserve_for_deleting();
    const auto transaction = environment.write();
    for (const VersionId version : unpublished) take_back(*transaction, version);
    transaction->commit();
    fail_point("recovery.deleted");
  }
  std::sort(published.begin(), published.end());
  published.erase(std::unique(published.begin(), published.end()), published.end());
  return published;
}

}  // namespace ramcdb::db
