#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "db/blob_parts.h"
#include "db/recovery.h"
#include "db/store_impl.h"
#include "db/store_state.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

using Found = std::function<void(const Store::Problem&)>;

/// LMDB keeps the named tables as entries of the unnamed one.
bool is_table_name(Table table, Bytes key) {
  return table == Table::main && std::any_of(kTableNames.begin() + 1, kTableNames.end(), [&](const char* name) {
           return std::equal(key.begin(), key.end(), name, name + std::strlen(name));
         });
}

/// Looks at every blob of one table: its key, its parts, its checksum.
class TableCheck {
 public:
  TableCheck(const Transaction& transaction, Table table, const Found& found)
      : transaction_(transaction), table_(table), found_(found) {}

  std::uint64_t run() {
    Cursor keys(transaction_, table_), blobs(transaction_, table_);
    std::uint64_t count = 0;
    std::optional<DecodedKey> before;
    for (bool more = keys.first(); more; more = keys.next()) {
      if (is_table_name(table_, keys.key())) continue;
      const auto now = decode_key(table_, keys.key().data(), keys.key().size());
      if (!now) {
        found_({"key", std::nullopt, fmt::format("table {} holds a key of another form", name())});
        continue;
      }
      if (now->part == 0) {
        ++count;
        check_blob(blobs, now->key);
      } else if (!before || before->key != now->key || before->part + 1 != now->part) {
        found_({"missing", now->key, fmt::format("part {} of {} has none before it", now->part, describe(now->key))});
      }
      before = now;
    }
    return count;
  }

 private:
  [[nodiscard]] const char* name() const {
    return table_ == Table::main ? "main" : kTableNames[static_cast<std::size_t>(table_)];
  }

  void check_blob(Cursor& cursor, const BlobKey& key) {
    try {
      (void)read_blob(cursor, key);
    } catch (const Error& e) {
      found_({"checksum", key, e.what()});
    }
  }

  const Transaction& transaction_;
  Table table_;
  const Found& found_;
};

bool same(const CommitRecord& a, const CommitRecord& b) { return encode_record(a) == encode_record(b); }

/// Every row has its commit record, and the same content.
void check_record(const Transaction& transaction, Catalogue& catalogue, VersionId version, const Found& found) {
  try {
    Cursor cursor(transaction, Table::main);
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

/// Blobs that no published version wrote. While a writer is at work its own are such, and no problem.
void check_leftovers(const Transaction& transaction, VersionId newest, const std::set<VersionId>& versions,
                     const Found& found) {
  const std::size_t tables = transaction.has_tables() ? kTableCount : 1;
  for (std::size_t t = 0; t < tables; ++t) {
    Cursor cursor(transaction, static_cast<Table>(t));
    for (bool more = cursor.first(); more; more = cursor.next()) {
      const auto key = decode_key(static_cast<Table>(t), cursor.key().data(), cursor.key().size());
      if (!key || key->part != 0 || key->key.kind == Kind::store_state || key->key.version > newest) continue;
      if (!versions.contains(key->key.version))
        found({"orphan", key->key, describe(key->key) + " belongs to no published version"});
    }
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
  std::uint64_t count = 0;
  for (std::size_t t = 0; t < kTableCount; ++t) count += TableCheck(*transaction, static_cast<Table>(t), found).run();
  check_leftovers(*transaction, versions.empty() ? VersionId() : *versions.rbegin(), versions, found);
  return count;
}

}  // namespace ramcdb::db
