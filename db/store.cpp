#include "db/store.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "db/blob_parts.h"
#include "db/fail_points.h"
#include "db/file_lock.h"
#include "db/file_system.h"
#include "db/pins.h"
#include "db/store_impl.h"
#include "db/store_state.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

namespace fs = std::filesystem;

constexpr double kWriterWaitSeconds = 600;

class TransactionReader : public BlobReader {
 public:
  explicit TransactionReader(std::shared_ptr<StoreImpl> store)
      : store_(std::move(store)), transaction_(store_->environment().read()) {}

  Buffer get(const BlobKey& key) override {
    if (auto blob = find(key)) return std::move(*blob);
    throw Error(Errc::corrupt, "a stored blob is missing", describe(key), "run `ramcdb verify`, restore from a backup");
  }

  std::optional<Buffer> find(const BlobKey& key) override {
    if (!cursor_) cursor_.emplace(*transaction_);
    auto blob = read_blob(*cursor_, key);
    if (blob) {
      ++blobs_;
      bytes_ += blob->size() + kChecksumBytes;
    }
    return blob;
  }

  void renew() override {
    cursor_.reset();
    transaction_->renew();
  }

  std::uint64_t blobs_read() const override { return blobs_; }
  std::uint64_t bytes_read() const override { return bytes_; }

 private:
  std::shared_ptr<StoreImpl> store_;
  std::unique_ptr<Transaction> transaction_;
  std::optional<Cursor> cursor_;
  std::uint64_t blobs_ = 0, bytes_ = 0;
};

/// The stores that this process has open, by device and inode of their blob file: LMDB must not open a file twice.
struct Registry {
  using Key = std::pair<dev_t, ino_t>;
  std::mutex mutex;
  std::map<Key, std::weak_ptr<StoreImpl>> open;

  static Registry& get() {
    static Registry registry;
    return registry;
  }
};

Registry::Key registry_key(const Layout& layout) {
  struct stat info {};
  if (::stat(layout.blobs.c_str(), &info) != 0)
    throw Error(Errc::corrupt, "half of the repository is missing", layout.blobs.string(),
                "restore both files from the same backup");
  return {info.st_dev, info.st_ino};
}

bool may_write(const Layout& layout) {
  return ::access(layout.folder.c_str(), W_OK) == 0 && ::access(layout.blobs.c_str(), W_OK) == 0 &&
         ::access(layout.catalogue.c_str(), W_OK) == 0;
}

void require_local(const fs::path& folder) {
  if (is_network_file_system(folder))
    throw Error(Errc::storage, "a repository cannot be written on a network file system", folder.string(),
                "memory maps and locks do not work across machines; keep it on a local disk");
}

/// What an init that was cut off may have left. A blob file that was ever written to is none: somebody lost the
/// catalogue, and these are the meshes.
bool is_leftover_of_create(const fs::path& file) {
  const std::string name = file.filename().string();
  if (name == "data.mdb") return fs::file_size(file) <= 2 * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return name == "data.mdb-lock" || name == "pins" || name.starts_with("catalogue.sqlite.new");
}

void require_empty(const Layout& layout) {
  if (fs::exists(layout.catalogue))
    throw Error(Errc::invalid_argument, "there is a repository already", layout.folder.string(),
                "add meshes to it with `ramcdb import`, or choose another folder");
  for (const auto& entry : fs::directory_iterator(layout.folder))
    if (!is_leftover_of_create(entry.path()))
      throw Error(Errc::invalid_argument, "the folder is not empty", layout.folder.string(), "choose a new folder");
}

void remove_files(const Layout& layout) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(layout.folder, ignored))
    if (is_leftover_of_create(entry.path())) files.push_back(entry.path());
  for (const fs::path& file : files) fs::remove_all(file, ignored);
}

void create_files(const Layout& layout) {
  fs::create_directory(layout.pins);
  Environment(layout.blobs, Environment::Mode::create);
  // The catalogue's name is what makes a folder a repository: it comes last, and at once.
  fs::path unfinished = layout.catalogue;
  unfinished += ".new";
  Catalogue::create(unfinished, random_id());
  sync_folder(layout.folder);
  fs::rename(unfinished, layout.catalogue);
  for (const char* suffix : {"-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(unfinished.string() + suffix, ignored);
  }
  sync_folder(layout.folder);
}

}  // namespace

std::string new_attempt_id() { return random_id(); }

void Store::create(const fs::path& folder) {
  const Layout layout(folder);
  bool made = false;
  try {
    made = fs::create_directories(folder);
    require_local(folder);
    require_empty(layout);
    remove_files(layout);
    try {
      create_files(layout);
    } catch (...) {
      remove_files(layout);
      throw;
    }
  } catch (const fs::filesystem_error& e) {
    throw Error(Errc::storage, "the repository cannot be made: " + e.code().message(), folder.string());
  } catch (...) {
    std::error_code ignored;
    if (made) fs::remove(folder, ignored);
    throw;
  }
}

std::shared_ptr<Store> Store::open(const fs::path& folder, Access access) {
  const Layout layout(folder);
  std::error_code failure;
  if (!fs::is_regular_file(layout.catalogue, failure)) {
    if (failure == std::errc::permission_denied) throw Error(Errc::storage, failure.message(), folder.string());
    throw Error(Errc::not_found, "not a repository", folder.string(),
                fs::is_regular_file(layout.blobs, failure) ? "its catalogue.sqlite is missing: restore it from a backup"
                                                           : "make one with `ramcdb init`");
  }
  Registry& registry = Registry::get();
  const std::lock_guard<std::mutex> alone(registry.mutex);
  std::weak_ptr<StoreImpl>& entry = registry.open[registry_key(layout)];
  auto store = entry.lock();
  // What a forked child inherits open cannot be opened beside it: both stores keep locks by process.
  if (store) store->environment().require_own_process();
  if (!store) {
    store = std::make_shared<StoreImpl>(layout, may_write(layout) ? Environment::Mode::write : Environment::Mode::read);
    entry = store;
  }
  if (access == Access::write) {
    require_local(folder);
    if (!store->writable())
      throw Error(Errc::storage, "the repository is not writable", folder.string(),
                  "check the permissions of the folder and its files");
  }
  return store;
}

StoreImpl::StoreImpl(const Layout& layout, Environment::Mode mode)
    : layout_(layout),
      environment_(layout.blobs, mode),
      catalogue_(layout.catalogue, mode == Environment::Mode::read ? Database::Mode::read : Database::Mode::write) {
  id_ = catalogue_.repository_id();
  if (const std::string other = read_state(*environment_.read()).repository_id; !other.empty() && other != id_)
    throw Error(Errc::corrupt, "data.mdb and catalogue.sqlite belong to different repositories", layout.folder.string(),
                "restore both files from the same backup");
}

VersionId StoreImpl::resolve(std::string_view revision) {
  // A version's blobs are durable before its row is: a transaction that begins after the row was read sees them, unless
  // they are lost. Then reading goes on with what both halves hold.
  const auto has_blobs = [&](VersionId v) { return v <= VersionId(read_state(*environment_.read()).seq); };
  return with_catalogue([&](Catalogue& c) { return resolve_revision(c, revision, has_blobs); });
}

VersionInfo StoreImpl::version(VersionId id) {
  auto info = with_catalogue([&](Catalogue& c) { return c.version(id); });
  if (!info) throw Error(Errc::not_found, fmt::format("there is no version {}", id.value), {}, "see `ramcdb log`");
  return std::move(*info);
}

std::vector<MeshRoot> StoreImpl::roots(VersionId id) {
  if (!id) return {};
  auto roots = with_catalogue([&](Catalogue& c) { return c.roots(id); });
  std::sort(roots.begin(), roots.end(), [](const MeshRoot& a, const MeshRoot& b) { return a.name < b.name; });
  return roots;
}

std::vector<VersionInfo> StoreImpl::history(VersionId from, std::size_t limit) {
  return with_catalogue([&](Catalogue& c) {
    std::vector<VersionInfo> versions;
    std::priority_queue<VersionId> open;
    std::set<VersionId> seen;
    const auto visit = [&](VersionId v) {
      if (v && seen.insert(v).second) open.push(v);
    };
    visit(from);
    while (!open.empty() && versions.size() < limit) {
      auto info = c.version(open.top());
      open.pop();
      if (!info) continue;  // pruned
      for (const VersionId parent : info->parents) visit(parent);
      versions.push_back(std::move(*info));
    }
    return versions;
  });
}

std::vector<VersionId> StoreImpl::all_versions() {
  return with_catalogue([](Catalogue& c) { return c.all_versions(); });
}

std::vector<ChangedCharts> StoreImpl::changed(VersionId id) {
  return with_catalogue([&](Catalogue& c) { return c.changed(id); });
}

std::optional<VersionId> StoreImpl::published_by(std::string_view attempt) {
  return with_catalogue([&](Catalogue& c) { return c.published_by(attempt); });
}

FileLock StoreImpl::take_writer_lock() {
  environment_.require_own_process();
  if (!writable())
    throw Error(Errc::storage, "the repository is not writable", layout_.folder.string(),
                "check the permissions of the folder and its files");
  require_local(layout_.folder);
  FileLock lock = FileLock::take(layout_.lock, kWriterWaitSeconds);
  lock.write_note(fmt::format("process {}\n", ::getpid()));
  fail_point("names.locked");
  return lock;
}

std::unique_ptr<Pin> StoreImpl::pin(VersionId id, std::string_view holder) {
  auto pin = take_pin(layout_.pins, id, holder);
  // It may have gone before the pin stood.
  if (id) (void)version(id);
  return pin;
}

std::unique_ptr<BlobReader> StoreImpl::reader() { return std::make_unique<TransactionReader>(shared_from_this()); }

std::unique_ptr<Writer> StoreImpl::writer(double wait_seconds) {
  environment_.require_own_process();
  return begin_attempt(shared_from_this(), wait_seconds);
}

Store::Usage StoreImpl::usage() {
  Usage usage;
  usage.blob_file = bytes_on_disk(layout_.blobs);
  for (const char* suffix : {"", "-wal"}) usage.catalogue += bytes_on_disk(layout_.catalogue.string() + suffix);
  return usage;
}

std::uint64_t StoreImpl::check(const std::function<void(const Problem&)>& found) {
  return with_catalogue([&](Catalogue& c) { return check_halves(environment_, c, id_, found); });
}

}  // namespace ramcdb::db
