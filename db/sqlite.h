#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ramcdb/bytes.h"

struct sqlite3;
struct sqlite3_stmt;

/// SQLite's C interface with owners and exceptions; no more than the catalogue needs.
namespace ramcdb::db {

/// A prepared statement. Bind from 1, columns from 0, as in SQLite.
class Statement {
 public:
  Statement(sqlite3* db, std::string_view sql);

  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, std::string_view text);
  Statement& bind(int index, Bytes blob);

  /// True while there is a row. Throws Error: disk_full, corrupt, storage.
  bool step();
  /// To be bound and stepped anew.
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] Buffer blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* s) const;
  };
  sqlite3* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A connection, for one thread at a time.
class Database {
 public:
  enum class Mode { read, write, create };

  Database(const std::filesystem::path& file, Mode mode);

  [[nodiscard]] Statement prepare(std::string_view sql) { return Statement(db_.get(), sql); }
  /// One or more statements without parameters or rows that matter.
  void run(const std::string& sql);
  [[nodiscard]] std::int64_t integer(std::string_view sql);
  [[nodiscard]] std::string text(std::string_view sql);

  /// Copies the write-ahead log into the database and empties it, as far as readers let it; never waits for them.
  void checkpoint();

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  std::unique_ptr<sqlite3, Close> db_;
};

/// BEGIN IMMEDIATE ... COMMIT; rolled back unless committed.
class DatabaseTransaction {
 public:
  explicit DatabaseTransaction(Database& db) : db_(db) { db_.run("BEGIN IMMEDIATE"); }
  DatabaseTransaction(DatabaseTransaction&&) = delete;
  ~DatabaseTransaction();
  void commit();

 private:
  Database& db_;
  bool open_ = true;
};

}  // namespace ramcdb::db
