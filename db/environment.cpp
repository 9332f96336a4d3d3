#include "db/environment.h"

#include <fmt/format.h>
#include <lmdb.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "db/file_system.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr std::uint64_t kUsualMapSize = std::uint64_t{1} << 40;  // of address space, not of memory
constexpr std::uint64_t kSmallestMapSize = std::uint64_t{64} << 20;
constexpr std::uint64_t kGrain = std::uint64_t{1} << 20;
constexpr unsigned kMaxReaders = 1024;
constexpr std::chrono::seconds kMapPatience{20};
constexpr std::uint64_t kLowDisk = std::uint64_t{1} << 20;

std::uint64_t& first_map_size() {
  static std::uint64_t bytes = 0;
  return bytes;
}

std::uint64_t length_of(const std::filesystem::path& file) {
  struct stat info {};
  return ::stat(file.c_str(), &info) == 0 ? static_cast<std::uint64_t>(info.st_size) : 0;
}

}  // namespace

void set_first_map_size(std::uint64_t bytes) { first_map_size() = bytes; }

void check_lmdb(int rc, const std::filesystem::path& file) {
  if (rc == MDB_SUCCESS) return;
  const std::string where = file.string();
  // A write beyond the last free block comes back as EIO.
  if (rc == ENOSPC || rc == EDQUOT || (rc == EIO && free_bytes(file) < kLowDisk))
    throw Error(Errc::disk_full, fmt::format("disk full: {} bytes are left", free_bytes(file)), where,
                "nothing was changed; free some space and try again");
  switch (rc) {
    case MDB_CORRUPTED:
    case MDB_PAGE_NOTFOUND:
    case MDB_INVALID:
      throw Error(Errc::corrupt, mdb_strerror(rc), where, "restore it from a backup");
    case MDB_PANIC:
      throw Error(Errc::storage, "an earlier write failed", where, "open the repository again");
    case MDB_VERSION_MISMATCH:
      throw Error(Errc::unsupported_version, "the file was written by another version of LMDB", where);
    case MDB_READERS_FULL:
      throw Error(Errc::storage, fmt::format("more than {} readers at once", kMaxReaders), where, "try again later");
    case EACCES:
    case EPERM:
    case EROFS:
      throw Error(Errc::storage, mdb_strerror(rc), where, "the files of a repository must be writable, locks included");
    default:
      throw Error(Errc::storage, mdb_strerror(rc), where);
  }
}

Transaction::Transaction(Environment& environment, bool write)
    : environment_(environment), write_(write), map_(environment.map_gate_) {
  begin();
}

void Transaction::begin() {
  environment_.require_own_process();
  const unsigned flags = write_ ? 0 : MDB_RDONLY;
  int rc = mdb_txn_begin(environment_.env_, nullptr, flags, &txn_);
  if (rc == MDB_READERS_FULL) {
    environment_.sweep_readers();
    rc = mdb_txn_begin(environment_.env_, nullptr, flags, &txn_);
  }
  while (rc == MDB_MAP_RESIZED) {
    map_.unlock();
    environment_.adopt_map_size();
    map_.lock();
    rc = mdb_txn_begin(environment_.env_, nullptr, flags, &txn_);
  }
  check_lmdb(rc, environment_.file_);
}

Transaction::~Transaction() {
  if (txn_ && ::getpid() == environment_.process_) mdb_txn_abort(txn_);
}

unsigned Transaction::table() const { return environment_.table_; }

const std::filesystem::path& Transaction::file() const { return environment_.file_; }

void Transaction::commit() {
  MDB_txn* txn = std::exchange(txn_, nullptr);
  check_lmdb(mdb_txn_commit(txn), environment_.file_);
}

void Transaction::renew() {
  environment_.require_own_process();
  mdb_txn_reset(txn_);
  if (mdb_txn_renew(txn_) == MDB_SUCCESS) return;
  mdb_txn_abort(std::exchange(txn_, nullptr));
  begin();
}

Cursor::Cursor(const Transaction& transaction) : file_(transaction.file()) {
  check_lmdb(mdb_cursor_open(transaction.get(), transaction.table(), &cursor_), file_);
}

Cursor::~Cursor() { mdb_cursor_close(cursor_); }

bool Cursor::seek(const EncodedKey& key) {
  key_ = key.bytes();
  return move(MDB_SET_RANGE);
}

bool Cursor::next() { return move(MDB_NEXT); }

bool Cursor::first() { return move(MDB_FIRST); }

bool Cursor::move(int operation) {
  MDB_val key{key_.size(), const_cast<std::uint8_t*>(key_.data())};  // LMDB reads it and points it into the map
  MDB_val value{};
  const int rc = mdb_cursor_get(cursor_, &key, &value, static_cast<MDB_cursor_op>(operation));
  if (rc == MDB_NOTFOUND) return false;
  check_lmdb(rc, file_);
  key_ = {static_cast<const std::uint8_t*>(key.mv_data), key.mv_size};
  value_ = {static_cast<const std::uint8_t*>(value.mv_data), value.mv_size};
  return true;
}

Environment::Environment(std::filesystem::path file, Mode mode)
    : file_(std::move(file)), mode_(mode), process_(::getpid()) {
  // LMDB takes an empty file for a new one and would begin anew in it.
  if (mode != Mode::create && length_of(file_) < 2 * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)))
    throw Error(Errc::corrupt, "the blob file is cut short", file_.string(), "restore it from a backup");
  try {
    open();
    if (mode != Mode::create) require_whole_file();
    MDB_txn* txn = nullptr;
    check_lmdb(mdb_txn_begin(env_, nullptr, MDB_RDONLY, &txn), file_);
    const int rc = mdb_dbi_open(txn, nullptr, 0, &table_);
    check_lmdb(rc == MDB_SUCCESS ? mdb_txn_commit(txn) : (mdb_txn_abort(txn), rc), file_);
    if (mode == Mode::create) check_lmdb(mdb_env_sync(env_, 1), file_);
  } catch (...) {
    mdb_env_close(env_);
    throw;
  }
}

Environment::~Environment() {
  // A forked child must leave its parent's environment alone.
  if (::getpid() == process_) mdb_env_close(env_);
}

void Environment::open() {
  const unsigned flags = MDB_NOSUBDIR | MDB_NOTLS | (mode_ == Mode::read ? MDB_RDONLY : 0);
  std::uint64_t map_size = first_map_size() ? first_map_size() : kUsualMapSize;
  for (;;) {
    check_lmdb(mdb_env_create(&env_), file_);
    check_lmdb(mdb_env_set_maxreaders(env_, kMaxReaders), file_);
    check_lmdb(mdb_env_set_mapsize(env_, map_size), file_);
    const int rc = mdb_env_open(env_, file_.c_str(), flags, 0666);
    if (rc != ENOMEM || map_size <= kSmallestMapSize) return check_lmdb(rc, file_);
    mdb_env_close(std::exchange(env_, nullptr));
    map_size /= 2;  // the address space is limited
  }
}

void Environment::require_whole_file() const {
  MDB_envinfo info;
  MDB_stat stat;
  check_lmdb(mdb_env_info(env_, &info), file_);
  check_lmdb(mdb_env_stat(env_, &stat), file_);
  const std::uint64_t expected = (info.me_last_pgno + 1) * static_cast<std::uint64_t>(stat.ms_psize);
  const std::uint64_t actual = length_of(file_);
  if (actual < expected)
    throw Error(Errc::corrupt, fmt::format("the blob file is cut short: {} of {} bytes", actual, expected),
                file_.string(), "restore it from a backup");
}

void Environment::require_own_process() const {
  if (::getpid() != process_)
    throw Error(Errc::storage, "the repository was opened before a fork", file_.string(), "fork first and open then");
}

std::unique_ptr<Transaction> Environment::read() { return std::unique_ptr<Transaction>(new Transaction(*this, false)); }

std::unique_ptr<Transaction> Environment::write() { return std::unique_ptr<Transaction>(new Transaction(*this, true)); }

void Environment::reserve_for_deleting() {
  MDB_envinfo info;
  MDB_stat stat;
  check_lmdb(mdb_env_info(env_, &info), file_);
  check_lmdb(mdb_env_stat(env_, &stat), file_);
  reserve((info.me_last_pgno + 1) * static_cast<std::uint64_t>(stat.ms_psize) + kGrain);
}

void Environment::reserve(std::uint64_t bytes) {
  require_own_process();
  MDB_envinfo info;
  MDB_stat stat;
  check_lmdb(mdb_env_info(env_, &info), file_);
  check_lmdb(mdb_env_stat(env_, &stat), file_);
  const std::uint64_t need = (info.me_last_pgno + 1) * static_cast<std::uint64_t>(stat.ms_psize) + bytes;
  if (need <= info.me_mapsize) return;
  set_map_size((2 * need + kGrain - 1) / kGrain * kGrain);
}

void Environment::sweep_readers() {
  int dead = 0;
  check_lmdb(mdb_reader_check(env_, &dead), file_);
}

void Environment::adopt_map_size() { set_map_size(0); }

void Environment::set_map_size(std::uint64_t bytes) {
  const std::unique_lock<std::shared_timed_mutex> alone(map_gate_, kMapPatience);
  if (!alone)
    throw Error(Errc::storage, "the memory map must grow, and readers of this process hold it", file_.string(),
                "let go of them and try again; with more address space this does not happen");
  check_lmdb(mdb_env_set_mapsize(env_, bytes), file_);
}

}  // namespace ramcdb::db
