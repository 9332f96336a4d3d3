#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "db/ref.h"
#include "db/sqlite.h"

/// Branches and tags, in the catalogue:
///
///     ref(name, kind, version, checksum)      checksum = XXH3-64 of name | 0 | kind | 0 | version
///
/// A row's checksum is what tells a name that was moved from one that was damaged.
namespace ramcdb::db {

class RefTable {
 public:
  static constexpr const char* kSchema = R"(
    CREATE TABLE ref(
      name TEXT PRIMARY KEY,
      kind TEXT NOT NULL CHECK(kind IN ('branch', 'tag')),
      version INTEGER NOT NULL REFERENCES version(id),
      checksum INTEGER NOT NULL) WITHOUT ROWID;
  )";

  explicit RefTable(Database& database) : database_(database) {}

  /// Branches first, then tags, each by name; damaged ones as they stand there.
  [[nodiscard]] std::vector<Ref> all();
  /// Throws corrupt where the row is damaged or names a version that is not there.
  [[nodiscard]] std::optional<Ref> find(std::string_view name);
  /// The tip of a branch; none where there is no such branch. Throws invalid_argument for a tag, and as find().
  [[nodiscard]] VersionId tip(std::string_view branch);
  /// Adds the name or moves it. REQUIRES: an open transaction.
  void set(const Ref& ref);
  void remove(std::string_view name);
  [[nodiscard]] std::vector<std::string> problems();

 private:
  Database& database_;
};

}  // namespace ramcdb::db
