#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <shared_mutex>

#include "db/blob_key.h"
#include "ramcdb/bytes.h"

struct MDB_env;
struct MDB_txn;
struct MDB_cursor;

namespace ramcdb::db {

/// Throws ramcdb::Error for an LMDB code other than MDB_SUCCESS; a full disk is named as such.
void check_lmdb(int rc, const std::filesystem::path& file);

class Environment;

/// A transaction over all blobs. Read transactions see one moment and block nobody.
class Transaction {
 public:
  Transaction(Transaction&&) = delete;
  ~Transaction();

  [[nodiscard]] MDB_txn* get() const { return txn_; }
  [[nodiscard]] unsigned table() const;  ///< LMDB's handle of the one table
  [[nodiscard]] const std::filesystem::path& file() const;

  /// Of a write transaction: makes it durable. Throws, and leaves nothing, when it cannot be.
  void commit();
  /// Of a read transaction: goes on with the newest state.
  void renew();

 private:
  friend class Environment;
  Transaction(Environment& environment, bool write);
  void begin();

  Environment& environment_;
  bool write_;
  std::shared_lock<std::shared_timed_mutex> map_;  ///< while held the map stays where it is
  MDB_txn* txn_ = nullptr;
};

/// A cursor over the keys of a transaction, which must outlive it.
class Cursor {
 public:
  explicit Cursor(const Transaction& transaction);
  Cursor(Cursor&&) = delete;
  ~Cursor();

  /// Moves to the first key >= `key`. Returns whether there is one.
  [[nodiscard]] bool seek(const EncodedKey& key);
  [[nodiscard]] bool next();
  [[nodiscard]] bool first();
  [[nodiscard]] Bytes key() const { return key_; }
  [[nodiscard]] Bytes value() const { return value_; }

 private:
  [[nodiscard]] bool move(int operation);

  const std::filesystem::path& file_;
  MDB_cursor* cursor_ = nullptr;
  Bytes key_, value_;  ///< in the map
};

/// The LMDB half of a repository: one file, one environment per process.
class Environment {
 public:
  enum class Mode { read, write, create };

  /// Throws corrupt for a file shorter than its own account of its pages, storage.
  Environment(std::filesystem::path file, Mode mode);
  Environment(Environment&&) = delete;
  ~Environment();

  [[nodiscard]] std::unique_ptr<Transaction> read();
  [[nodiscard]] std::unique_ptr<Transaction> write();

  /// Makes room in the memory map for that many more bytes. REQUIRES: the writer lock, no transaction of this thread.
  /// Waits for the read transactions of other threads where the map must grow; throws storage when they take too long.
  void reserve(std::uint64_t bytes);
  /// The same for a transaction that only deletes: it copies at most every page there is.
  void reserve_for_deleting();

  /// Frees the reader slots of processes that are gone.
  void sweep_readers();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Throws storage in a forked child: neither store may cross a fork.
  void require_own_process() const;
  [[nodiscard]] bool writable() const { return mode_ != Mode::read; }

 private:
  friend class Transaction;
  void open();
  void require_whole_file() const;
  /// Another process grew the map: follow.
  void adopt_map_size();
  /// Moves the map when no transaction of this process is open. Waits for them, but not for ever: one of them may be
  /// this thread's own.
  void set_map_size(std::uint64_t bytes);

  std::filesystem::path file_;
  Mode mode_;
  pid_t process_;
  MDB_env* env_ = nullptr;
  unsigned table_ = 0;
  std::shared_timed_mutex map_gate_;  ///< shared by transactions, exclusive while the map moves
};

/// For tests, before a repository is opened: the size that memory maps begin with. 0 for the usual one.
void set_first_map_size(std::uint64_t bytes);

}  // namespace ramcdb::db
