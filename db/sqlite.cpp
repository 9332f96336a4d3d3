#include "db/sqlite.h"

#include <sqlite3.h>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr int kBusyTimeoutMs = 30'000;

[[noreturn]] void fail(sqlite3* db, int rc) {
  const char* name = db ? sqlite3_db_filename(db, "main") : nullptr;
  const std::string where = name ? name : "catalogue";
  const std::string what = db ? sqlite3_errmsg(db) : sqlite3_errstr(rc);
  switch (rc & 0xFF) {
    case SQLITE_FULL:
      throw Error(Errc::disk_full, "disk full", where, "nothing was changed; free some space and try again");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw Error(Errc::corrupt, what, where, "restore it from a backup");
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      throw Error(Errc::storage, what, where, "the folder and files of a repository must be writable");
    default:
      throw Error(Errc::storage, what, where);
  }
}

void check(sqlite3* db, int rc) {
  if (rc != SQLITE_OK) fail(db, rc);
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }

Statement::Statement(sqlite3* db, std::string_view sql) : db_(db) {
  sqlite3_stmt* statement = nullptr;
  check(db, sqlite3_prepare_v2(db, sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
  statement_.reset(statement);
}

Statement& Statement::bind(int index, std::int64_t value) {
  check(db_, sqlite3_bind_int64(statement_.get(), index, value));
  return *this;
}

Statement& Statement::bind(int index, std::string_view text) {
  const char* data = text.empty() ? "" : text.data();  // a null pointer would be NULL
  check(db_, sqlite3_bind_text64(statement_.get(), index, data, text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int index, Bytes blob) {
  check(db_, sqlite3_bind_blob64(statement_.get(), index, blob.data(), blob.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int rc = sqlite3_step(statement_.get());
  if (rc == SQLITE_ROW) return true;
  if (rc != SQLITE_DONE) fail(db_, rc);
  return false;
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return data ? std::string(data, size) : std::string();
}

Buffer Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return data ? Buffer(data, data + size) : Buffer();
}

void Database::Close::operator()(sqlite3* db) const { sqlite3_close_v2(db); }

Database::Database(const std::filesystem::path& file, Mode mode) {
  const int flags = (mode == Mode::read    ? SQLITE_OPEN_READONLY
                     : mode == Mode::write ? SQLITE_OPEN_READWRITE
                                           : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) |
                    SQLITE_OPEN_NOMUTEX;
  sqlite3* db = nullptr;
  const int rc = sqlite3_open_v2(file.c_str(), &db, flags, nullptr);
  db_.reset(db);
  check(db, rc);
  check(db, sqlite3_busy_timeout(db, kBusyTimeoutMs));
  check(db, sqlite3_extended_result_codes(db, 1));
  // The file may be somebody else's: no functions or settings of its own take effect.
  check(db, sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr));
  check(db, sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr));
  // Only the holder of the writer lock moves the log into the database.
  check(db, sqlite3_db_config(db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr));
  check(db, sqlite3_wal_autocheckpoint(db, 0));
  run("PRAGMA cell_size_check = ON; PRAGMA foreign_keys = ON; PRAGMA synchronous = FULL");
}

void Database::run(const std::string& sql) {
  check(db_.get(), sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::integer(std::string_view sql) {
  Statement s = prepare(sql);
  return s.step() ? s.integer(0) : 0;
}

std::string Database::text(std::string_view sql) {
  Statement s = prepare(sql);
  return s.step() ? s.text(0) : std::string();
}

void Database::checkpoint() {
  sqlite3_busy_timeout(db_.get(), 0);
  const int rc = sqlite3_wal_checkpoint_v2(db_.get(), nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  sqlite3_busy_timeout(db_.get(), kBusyTimeoutMs);
  // A reader in the way is no failure, nor is a full disk: the log still holds everything.
  if (rc != SQLITE_BUSY && (rc & 0xFF) != SQLITE_FULL && (rc & 0xFF) != SQLITE_IOERR) check(db_.get(), rc);
}

DatabaseTransaction::~DatabaseTransaction() {
  if (!open_) return;
  try {
    db_.run("ROLLBACK");
  } catch (const Error&) {
    // Some failures have rolled back already.
  }
}

void DatabaseTransaction::commit() {
  db_.run("COMMIT");
  open_ = false;
}

}  // namespace ramcdb::db
