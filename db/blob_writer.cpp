#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "db/blob_parts.h"
#include "db/fail_points.h"
#include "db/file_lock.h"
#include "db/file_system.h"
#include "db/key_list.h"
#include "db/recovery.h"
#include "db/ref_name.h"
#include "db/store_impl.h"
#include "db/store_state.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr std::uint64_t kFlushBytes = std::uint64_t{64} << 20;
// LMDB copies the pages above what it changes, in every table; SQLite writes a log of a few pages.
constexpr std::uint64_t kPageCopies = std::uint64_t{256} << 10;

std::uint64_t space_for(std::uint64_t bytes) { return bytes + bytes / 8 + kPageCopies; }

/// Address space for the worst case: every blob copies a leaf page, splits it and ends in a page of its own.
std::uint64_t map_for(std::uint64_t bytes, std::size_t blobs) { return space_for(bytes) + 3 * 4096 * blobs; }

struct HeldBlob {
  BlobKey key;
  EncodedKey order;
  Buffer sealed;
};

/// One attempt at a version, from the writer lock to its row (db/FORMAT.md, "Commit").
class Attempt : public Writer {
 public:
  Attempt(std::shared_ptr<StoreImpl> store, double wait_seconds)
      : store_(std::move(store)),
        lock_(FileLock::take(store_->layout().lock, wait_seconds)),
        catalogue_(store_->layout().catalogue, Database::Mode::write) {
    lock_.write_note(fmt::format("process {}\n", ::getpid()));
    finished_lists_ = recover(environment(), catalogue_);
    state_ = read_state(*environment().read());
    state_.repository_id = store_->id();
    state_.seq = std::max(state_.seq, catalogue_.newest().value) + 1;
    fail_point("writer.locked");
  }

  ~Attempt() override {
    // Once a row was tried only the catalogue, read anew, knows how that ended: the next writer's recovery asks it.
    if (!flushed_ || row_tried_) return;
    try {
      environment().reserve_for_deleting();
      const auto transaction = environment().write();
      take_back(*transaction, version());
      transaction->commit();
    } catch (const std::exception&) {
      // The next writer's recovery does it.
    }
  }

  VersionId version() const override { return VersionId(state_.seq); }
  VersionId tip(std::string_view branch) override { return catalogue_.refs().tip(branch); }

  MeshId new_mesh_id() override {
    if (state_.last_mesh == 0xFFFF)
      throw Error(Errc::limit_exceeded, "a repository holds at most 65,535 meshes in its life");
    return MeshId(++state_.last_mesh);
  }

  void put(BlobKey key, Buffer blob) override {
    key.version = version();
    held_.push_back({key, EncodedKey(key, 0), seal(key, blob)});
    held_bytes_ += held_.back().sealed.size();
    bytes_put_ += held_.back().sealed.size();
    if (held_bytes_ >= kFlushBytes) flush();
  }

  void flush() override {
    if (held_.empty()) return;
    write_held();
    fail_point("blobs.flushed");
  }

  std::uint64_t bytes_put() const override { return bytes_put_; }

  VersionId publish(const CommitInfo& info) override {
    if (const auto earlier = catalogue_.published_by(info.attempt)) return *earlier;
    if (!info.nameless) require_tip(info);
    const CommitRecord record = record_of(info);
    put(record_key(version()), encode_record(record));
    fail_point("blobs.before");
    write_held();
    fail_point("blobs.committed");
    row_tried_ = true;
    catalogue_.publish(record, info.expected_tip);
    fail_point("row.committed");
    catalogue_.checkpoint();
    return version();
  }

 private:
  void require_tip(const CommitInfo& info) {
    if (!info.expected_tip) require_ref_name(info.branch);
    if (const VersionId now = tip(info.branch); now != info.expected_tip)
      throw Error(Errc::conflict, fmt::format("branch {} moved to version {}", info.branch, now.value),
                  fmt::format("expected version {}", info.expected_tip.value), "check out again");
  }

  [[nodiscard]] Environment& environment() const { return store_->environment(); }

  [[nodiscard]] CommitRecord record_of(const CommitInfo& info) const {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    CommitRecord record;
    record.info = {version(),    info.parents, info.nameless ? std::string() : info.branch,
                   info.author,  info.message, std::chrono::duration_cast<std::chrono::microseconds>(now).count(),
                   info.attempt, info.figures};
    record.roots = info.roots;
    record.changed = info.changed;
    return record;
  }

  /// One LMDB transaction: the held blobs in key order, their pending list and the number given away.
  void write_held() {
    std::sort(held_.begin(), held_.end(), [](const HeldBlob& a, const HeldBlob& b) { return a.order < b.order; });
    require_free_bytes(store_->layout().folder, space_for(held_bytes_));
    environment().reserve(map_for(held_bytes_, held_.size()));
    const auto transaction = environment().write();
    drop_pending_lists(*transaction, finished_lists_);
    std::vector<BlobKey> keys;
    PartWriter parts(*transaction);
    for (const HeldBlob& blob : held_) {
      parts.put(blob.key, blob.sealed);
      keys.push_back(blob.key);
    }
    put_pending_list(*transaction, keys);
    write_state(*transaction, state_);
    transaction->commit();
    flushed_ = true;
    finished_lists_.clear();
    held_.clear();
    held_bytes_ = 0;
  }

  void put_pending_list(const Transaction& transaction, std::vector<BlobKey>& keys) {
    std::sort(keys.begin(), keys.end());
    if (chunks_ == 0xFFFF) throw Error(Errc::limit_exceeded, "an import writes more than 4 TB of blobs");
    const BlobKey key = pending_key(version(), chunks_++);
    PartWriter(transaction).put(key, seal(key, encode_key_list(keys)));
  }

  std::shared_ptr<StoreImpl> store_;
  FileLock lock_;
  Catalogue catalogue_;
  StoreState state_;
  std::vector<VersionId> finished_lists_;
  std::vector<HeldBlob> held_;
  std::uint64_t held_bytes_ = 0, bytes_put_ = 0;
  std::uint16_t chunks_ = 0;
  bool flushed_ = false, row_tried_ = false;
};

}  // namespace

std::unique_ptr<Writer> begin_attempt(std::shared_ptr<StoreImpl> store, double wait_seconds) {
  return std::make_unique<Attempt>(std::move(store), wait_seconds);
}

}  // namespace ramcdb::db
