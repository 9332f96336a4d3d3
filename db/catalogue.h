#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/commit_record.h"
#include "db/fail_points.h"
#include "db/lock_table.h"
#include "db/ref_table.h"
#include "db/sqlite.h"

/// The SQLite half of a repository: which versions are published, and what they are called.
///
///     repository(id)                                      one row
///     version(id, branch, author, message, time_us, attempt, figures, parents, roots, changed)
///     ref, lock                                           in their own headers
namespace ramcdb::db {

/// For one thread at a time.
class Catalogue {
 public:
  /// Makes the file and its tables; the file must not exist.
  static void create(const std::filesystem::path& file, std::string_view repository_id);

  /// Throws corrupt, unsupported_version, storage.
  Catalogue(const std::filesystem::path& file, Database::Mode mode);

  [[nodiscard]] std::string repository_id();
  [[nodiscard]] VersionId newest();  ///< the largest number of a published version
  [[nodiscard]] std::optional<VersionInfo> version(VersionId id);
  [[nodiscard]] std::optional<CommitRecord> record(VersionId id);
  [[nodiscard]] std::vector<MeshRoot> roots(VersionId id);
  [[nodiscard]] std::vector<ChangedCharts> changed(VersionId id);
  [[nodiscard]] std::vector<VersionId> all_versions();
  [[nodiscard]] std::optional<VersionId> published_by(std::string_view attempt);
  /// None for a version that is not there.
  [[nodiscard]] std::vector<VersionId> parents(VersionId id);
  [[nodiscard]] RefTable refs() { return RefTable(database_); }
  [[nodiscard]] LockTable locks() { return LockTable(database_); }

  /// Calls `change`, which may use refs() and locks(), and makes what it did durable, all or nothing.
  template <class Change>
  auto change_names(Change&& change) {
    DatabaseTransaction transaction(database_);
    auto result = change();
    fail_point("names.before_commit");
    transaction.commit();
    fail_point("names.committed");
    checkpoint();
    return result;
  }

  /// Publishes a version as the new tip of its branch, in one durable transaction, and sweeps expired locks. Throws
  /// conflict, and changes nothing, when the branch's tip is not `expected_tip`.
  void publish(const CommitRecord& record, VersionId expected_tip);

  void checkpoint() { database_.checkpoint(); }
  /// What SQLite finds wrong with its file; empty when nothing is.
  [[nodiscard]] std::vector<std::string> integrity_problems();

 private:
  void insert(const CommitRecord& record);
  [[nodiscard]] Buffer blob_of(VersionId id, std::string_view column);

  Database database_;
};

}  // namespace ramcdb::db
