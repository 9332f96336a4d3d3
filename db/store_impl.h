#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "db/catalogue.h"
#include "db/environment.h"
#include "db/file_lock.h"
#include "db/store.h"

/// The files of a repository's folder:
///
///     data.mdb, data.mdb-lock      LMDB: all blobs
///     catalogue.sqlite (-wal -shm) SQLite: versions, branches, tags, chart locks
///     writer.lock                  kernel lock of the one writer
///     pins/                        kernel locks of those who read a version
namespace ramcdb::db {

struct Layout {
  explicit Layout(const std::filesystem::path& root)
      : folder(root),
        blobs(root / "data.mdb"),
        catalogue(root / "catalogue.sqlite"),
        lock(root / "writer.lock"),
        pins(root / "pins") {}

  std::filesystem::path folder, blobs, catalogue, lock, pins;
};

class StoreImpl : public Store, public std::enable_shared_from_this<StoreImpl> {
 public:
  StoreImpl(const Layout& layout, Environment::Mode mode);

  [[nodiscard]] std::string id() const override { return id_; }
  [[nodiscard]] VersionId resolve(std::string_view revision) override;
  [[nodiscard]] VersionInfo version(VersionId id) override;
  [[nodiscard]] std::vector<MeshRoot> roots(VersionId id) override;
  [[nodiscard]] std::vector<VersionInfo> history(VersionId from, std::size_t limit) override;
  [[nodiscard]] std::vector<VersionId> all_versions() override;
  [[nodiscard]] std::vector<ChangedCharts> changed(VersionId id) override;
  [[nodiscard]] std::optional<VersionId> published_by(std::string_view attempt) override;
  [[nodiscard]] VersionId merge_base(VersionId a, VersionId b) override;
  [[nodiscard]] bool is_ancestor(VersionId old, VersionId version) override;
  [[nodiscard]] std::vector<VersionId> only_in(VersionId from, const std::vector<VersionId>& others) override;
  [[nodiscard]] std::vector<Ref> refs() override;
  [[nodiscard]] VersionId tip(std::string_view branch) override;
  std::vector<VersionId> create_branch(std::string_view name, VersionId at, bool force,
                                       std::optional<VersionId> expected) override;
  void rename_branch(std::string_view from, std::string_view to) override;
  std::vector<VersionId> delete_branch(std::string_view name, bool force) override;
  std::vector<VersionId> create_tag(std::string_view name, VersionId at, bool force) override;
  std::vector<VersionId> delete_tag(std::string_view name) override;
  [[nodiscard]] std::vector<ChartLock> locks(std::int64_t now_us) override;
  [[nodiscard]] std::vector<ChartLock> locks_against(MeshId mesh, std::span<const ChartId> charts,
                                                     std::string_view owner, std::int64_t now_us) override;
  [[nodiscard]] LockTaken lock(const ChartLock& wanted, bool steal) override;
  [[nodiscard]] Unlocked unlock(const LockSelection& which, std::string_view owner, bool force,
                                std::int64_t now_us) override;
  [[nodiscard]] std::unique_ptr<Pin> pin(VersionId id, std::string_view holder) override;
  [[nodiscard]] std::unique_ptr<BlobReader> reader() override;
  [[nodiscard]] std::unique_ptr<Writer> writer(double wait_seconds) override;
  [[nodiscard]] Usage usage() override;
  std::uint64_t check(const std::function<void(const Problem&)>& found) override;

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] Environment& environment() { return environment_; }
  [[nodiscard]] bool writable() const { return environment_.writable(); }

 private:
  /// Calls `read(catalogue)` as the only thread that uses the connection.
  template <class Read>
  auto with_catalogue(Read&& read) {
    environment_.require_own_process();
    const std::lock_guard<std::mutex> alone(mutex_);
    return read(catalogue_);
  }

  /// Takes the writer lock and calls `change(catalogue)` in a transaction. No attempt is at work then, so that nothing
  /// in the blob half needs a look: what a crash left there has no row, and so no name.
  template <class Change>
  auto change_names(Change&& change) {
    const FileLock alone = take_writer_lock();
    return with_catalogue([&](Catalogue& c) { return c.change_names([&] { return change(c); }); });
  }
  [[nodiscard]] FileLock take_writer_lock();
  void require_version(Catalogue& catalogue, VersionId version);

  Layout layout_;
  Environment environment_;
  std::mutex mutex_;
  Catalogue catalogue_;
  std::string id_;
};

/// Takes the writer lock, recovers, and begins an attempt.
[[nodiscard]] std::unique_ptr<Writer> begin_attempt(std::shared_ptr<StoreImpl> store, double wait_seconds);

/// What Store::check does, apart from locking the catalogue.
std::uint64_t check_halves(Environment& environment, Catalogue& catalogue, std::string_view repository_id,
                           const std::function<void(const Store::Problem&)>& found);

/// Finds a version by what users write (Store::resolve). `has_blobs` is asked about rows that were read before.
[[nodiscard]] VersionId resolve_revision(Catalogue& catalogue, std::string_view revision,
                                         const std::function<bool(VersionId)>& has_blobs);

}  // namespace ramcdb::db
