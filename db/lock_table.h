#pragma once

#include <vector>

#include "db/chart_lock.h"
#include "db/sqlite.h"

/// Advisory locks, in the catalogue:
///
///     lock(id, mesh, charts, owner, reason, taken_us, expires_us, branch)     charts as in version.changed
namespace ramcdb::db {

class LockTable {
 public:
  static constexpr const char* kSchema = R"(
    CREATE TABLE lock(
      id INTEGER PRIMARY KEY AUTOINCREMENT,
      mesh INTEGER NOT NULL,
      charts BLOB NOT NULL,
      owner TEXT NOT NULL,
      reason TEXT NOT NULL,
      taken_us INTEGER NOT NULL,
      expires_us INTEGER NOT NULL,
      branch TEXT NOT NULL);
  )";

  explicit LockTable(Database& database) : database_(database) {}

  /// Those that count at a time, by id. One whose charts are damaged holds none: it must not stop anybody's commit.
  [[nodiscard]] std::vector<ChartLock> active(std::int64_t now_us);
  /// Returns its id; `lock.id` does not matter. REQUIRES: an open transaction, as for the two below.
  std::uint32_t add(const ChartLock& lock);
  /// Gives these charts of a lock back; all of it when no chart is left.
  void release(const ChartLock& lock, const std::vector<ChartId>& charts);
  void sweep(std::int64_t now_us);
  [[nodiscard]] std::vector<std::string> problems();

 private:
  Database& database_;
};

/// The charts of a lock that are among `charts`. Both ascending.
[[nodiscard]] std::vector<ChartId> held_of(const ChartLock& lock, const std::vector<ChartId>& charts);

}  // namespace ramcdb::db
