#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "db/blob_parts.h"
#include "db/recovery.h"
#include "db/store_impl.h"
#include "db/store_state.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

using Found = std::function<void(const Store::Problem&)>;

void check_blob(Cursor& cursor, const BlobKey& key, const Found& found) {
  try {
    if (!read_blob(cursor, key)) found({"key", key, describe(key) + " is there, and its key does not lead to it"});
  } catch (const Error& e) {
    found({"checksum", key, e.what()});
  }
}

/// Looks at every blob: its key, its parts, its checksum. Returns their number.
std::uint64_t check_blobs(const Transaction& transaction, const Found& found) {
  Cursor keys(transaction), blobs(transaction);
  std::uint64_t count = 0;
  std::optional<DecodedKey> before;
  Bytes name_before;
  for (bool more = keys.first(); more; more = keys.next()) {
    const Bytes name = keys.key();
    const auto now = decode_key(name);
    if (!std::lexicographical_compare(name_before.begin(), name_before.end(), name.begin(), name.end()))
      found({"key", std::nullopt, "the keys of the blob file are out of order: some blobs cannot be found"});
    name_before = name;
    if (!now) {
      found({"key", std::nullopt, "the blob file holds a key of another form"});
    } else if (now->part != 0) {
      if (!before || before->key != now->key || before->part + 1 != now->part)
        found({"missing", now->key, fmt::format("part {} of {} has none before it", now->part, describe(now->key))});
    } else {
      ++count;
      check_blob(blobs, now->key, found);
    }
    before = now;
  }
  return count;
}

bool same(const CommitRecord& a, const CommitRecord& b) { return encode_record(a) == encode_record(b); }

/// Every row has its commit record, and the same content.
void check_record(const Transaction& transaction, Catalogue& catalogue, VersionId version, const Found& found) {
  try {
    Cursor cursor(transaction);
    const auto blob = read_blob(cursor, record_key(version));
    if (!blob)
      found({"missing", record_key(version), fmt::format("version {} has no commit record", version.value)});
    else if (const auto row = catalogue.record(version); row && !same(*row, decode_record(*blob)))
      found(
          {"catalogue", record_key(version), fmt::format("version {} differs from its commit record", version.value)});
  } catch (const Error& e) {
    found({"catalogue", record_key(version), e.what()});
  }
}

/// Every name leads to a version that is there; every lock names charts.
void check_names(Catalogue& catalogue, const Found& found) {
  for (const std::string& problem : catalogue.refs().problems()) found({"catalogue", std::nullopt, problem});
  for (const std::string& problem : catalogue.locks().problems()) found({"catalogue", std::nullopt, problem});
}

/// Blobs that no published version wrote. While a writer is at work its own are such, and no problem.
void check_leftovers(const Transaction& transaction, VersionId newest, const std::set<VersionId>& versions,
                     const Found& found) {
  Cursor cursor(transaction);
  for (bool more = cursor.first(); more; more = cursor.next()) {
    const auto key = decode_key(cursor.key());
    if (!key || key->part != 0 || key->key.kind == Kind::store_state || key->key.version > newest) continue;
    if (!versions.contains(key->key.version))
      found({"orphan", key->key, describe(key->key) + " belongs to no published version"});
  }
}

}  // namespace

std::uint64_t check_halves(Environment& environment, Catalogue& catalogue, std::string_view repository_id,
                           const Found& found) {
  const auto transaction = environment.read();
  for (const std::string& problem : catalogue.integrity_problems()) found({"catalogue", std::nullopt, problem});
  if (catalogue.repository_id() != repository_id)
    found({"catalogue", std::nullopt, "the catalogue belongs to another repository"});
  const VersionId seq(read_state(*transaction).seq);
  std::set<VersionId> versions;
  for (const VersionId version : catalogue.all_versions()) {
    versions.insert(version);
    // A version may have been published since the transaction began.
    if (version <= seq)
      check_record(*transaction, catalogue, version, found);
    else if (version > VersionId(read_state(*environment.read()).seq))
      found({"missing", std::nullopt, fmt::format("version {} has lost its blobs", version.value)});
  }
  check_names(catalogue, found);
  const std::uint64_t count = check_blobs(*transaction, found);
  check_leftovers(*transaction, versions.empty() ? VersionId() : *versions.rbegin(), versions, found);
  return count;
}

}  // namespace ramcdb::db
