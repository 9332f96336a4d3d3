#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "db/chart_lock.h"
#include "db/ref.h"
#include "ramcdb/bytes.h"
#include "ramcdb/ids.h"

/// The versioned blob store: bytes with keys and versions, history, the commit protocol. Knows nothing of meshes.
namespace ramcdb::db {

/// What a blob is. Numbers are stored, and never reused.
enum class Kind : std::uint8_t {
  page = 1,
  wire = 2,
  chart = 3,
  attribute = 4,
  table = 5,
  commit_record = 6,  ///< written by the store itself
  pending = 7,        ///< written by the store itself
  mesh_record = 8,
  store_state = 9,  ///< written by the store itself, the only one that is ever replaced
};

/// The key of a blob: immutable, written once. `layer` tells attribute blobs of one chart apart and is 0 otherwise.
struct BlobKey {
  Kind kind = Kind::page;
  MeshId mesh;
  std::uint32_t id = 0;
  VersionId version;
  std::uint16_t layer = 0;

  friend auto operator<=>(const BlobKey&, const BlobKey&) = default;
};

/// Where a mesh stands at a version: its root page and its record, each named by the version that wrote it.
struct MeshRoot {
  MeshId mesh;
  std::string name;
  PageId root_page;
  VersionId root_version;
  VersionId record_version;

  friend bool operator==(const MeshRoot&, const MeshRoot&) = default;
};

struct VersionInfo {
  VersionId id;
  std::vector<VersionId> parents;  ///< empty for the first version of a branch without history
  std::string branch;              ///< the branch it was published on
  std::string author;
  std::string message;
  std::int64_t time_us = 0;  ///< UTC, microseconds since 1970
  std::string attempt;       ///< unique id of the attempt that published it
  std::string figures;       ///< what the writer wants shown in logs, opaque here (JSON)
};

/// The charts of one mesh that a version changed, ascending.
struct ChangedCharts {
  MeshId mesh;
  std::vector<ChartId> charts;
};

enum class Access { read, write };

class Pin;
class Writer;
class BlobReader;

/// One open repository. Thread-safe. One Store per process and repository folder, however often it is opened.
class Store {
 public:
  /// Makes an empty repository at `folder`, which must not exist or be an empty folder. All or nothing.
  static void create(const std::filesystem::path& folder);

  /// Throws not_found ("not a repository"), unsupported_version, corrupt (the halves do not belong together), storage.
  static std::shared_ptr<Store> open(const std::filesystem::path& folder, Access access);

  virtual ~Store() = default;

  [[nodiscard]] virtual std::string id() const = 0;  ///< unique id of the repository, 32 hexadecimal digits

  /// Resolves `17`, `v17`, a branch, a tag, `HEAD` (tip of main), each with any number of `~N` behind it.
  /// An empty text is HEAD. Version 0 (none) only for the tip of a branch on which nothing was published yet.
  /// Throws not_found, naming what exists. Where blobs are lost (data.mdb older than the catalogue) a branch goes on
  /// with its newest whole version; a lost version that is asked for by number is corrupt.
  [[nodiscard]] virtual VersionId resolve(std::string_view revision) = 0;
  [[nodiscard]] virtual VersionInfo version(VersionId id) = 0;
  [[nodiscard]] virtual std::vector<MeshRoot> roots(VersionId id) = 0;  ///< by name; empty for version 0
  /// What `from` descends from, itself included, each version once, newest first; at most `limit` of them.
  [[nodiscard]] virtual std::vector<VersionInfo> history(VersionId from, std::size_t limit) = 0;
  /// Every published version of every branch, ascending.
  [[nodiscard]] virtual std::vector<VersionId> all_versions() = 0;
  [[nodiscard]] virtual std::vector<ChangedCharts> changed(VersionId id) = 0;
  /// The version that this attempt published, if it did: the answer to a commit whose answer got lost.
  [[nodiscard]] virtual std::optional<VersionId> published_by(std::string_view attempt) = 0;

  // The version graph. Version 0 stands for an empty history.

  /// The best common ancestor: one from which no other common ancestor descends; the newest where several are
  /// (criss-cross merges). A version is its own ancestor. 0 when there is none.
  [[nodiscard]] virtual VersionId merge_base(VersionId a, VersionId b) = 0;
  [[nodiscard]] virtual bool is_ancestor(VersionId old, VersionId version) = 0;
  /// What `from` descends from, itself included, and none of `others` does, ascending.
  [[nodiscard]] virtual std::vector<VersionId> only_in(VersionId from, const std::vector<VersionId>& others) = 0;

  // Names. Changes take the writer lock, so never from a thread that holds a Writer; each is durable when it returns,
  // all or nothing, and touches no blob. They throw invalid_argument for a name that is none (db/ref_name.h), is taken
  // or is of the other kind; not_found; corrupt for a version that has lost its blobs; storage. Where they return
  // versions, these are the ones that no name leads to any more: they can still be had by number.

  /// Branches first, then tags, each by name.
  [[nodiscard]] virtual std::vector<Ref> refs() = 0;
  /// The tip of a branch, 0 when there is no such branch. Throws invalid_argument for a tag.
  [[nodiscard]] virtual VersionId tip(std::string_view branch) = 0;
  /// \param force moves a branch that exists
  /// \param expected compare-and-swap: throws conflict unless the branch is there (0: is not), and moves it
  virtual std::vector<VersionId> create_branch(std::string_view name, VersionId at, bool force,
                                               std::optional<VersionId> expected = {}) = 0;
  /// Versions keep the name of the branch that they were published on. main keeps its name.
  virtual void rename_branch(std::string_view from, std::string_view to) = 0;
  /// Refuses main and, without `force`, a branch whose versions would be left without a name.
  virtual std::vector<VersionId> delete_branch(std::string_view name, bool force) = 0;
  /// \param force has a tag that exists name another version
  virtual std::vector<VersionId> create_tag(std::string_view name, VersionId at, bool force) = 0;
  virtual std::vector<VersionId> delete_tag(std::string_view name) = 0;

  // Advisory locks on charts, by whatever the callers call a time (UTC, microseconds): an expired lock does not count
  // and goes with the next change. Changes are as those of names.

  /// Those that count, by id.
  [[nodiscard]] virtual std::vector<ChartLock> locks(std::int64_t now_us) = 0;
  /// Those of other owners on any of `charts` (ascending), each cut down to them.
  [[nodiscard]] virtual std::vector<ChartLock> locks_against(MeshId mesh, std::span<const ChartId> charts,
                                                             std::string_view owner, std::int64_t now_us) = 0;
  struct LockTaken {
    ChartLock lock;                 ///< with its id
    std::vector<ChartLock> others;  ///< what others hold of these charts: in the way, or stolen from them
    bool done = false;
  };
  /// Takes a lock from its `taken_us` on, unless charts are locked by other owners; `steal` takes these away from them.
  /// An owner may hold a chart twice.
  [[nodiscard]] virtual LockTaken lock(const ChartLock& wanted, bool steal) = 0;
  struct Unlocked {
    std::vector<ChartLock> released;  ///< each with the charts that are free of it now
    std::vector<ChartLock> others;    ///< of other owners, left as they are
  };
  /// Gives back what `owner` holds; with `force` what anybody does. Nothing is released where one lock or some charts
  /// are asked for and others hold them.
  [[nodiscard]] virtual Unlocked unlock(const LockSelection& which, std::string_view owner, bool force,
                                        std::int64_t now_us) = 0;

  /// Keeps a version from being pruned until the pin is destroyed or its process is gone.
  [[nodiscard]] virtual std::unique_ptr<Pin> pin(VersionId id, std::string_view holder) = 0;

  /// A consistent view of the blobs for a short time: some charts, not an export (renew it per batch). Not thread-safe;
  /// any number may be open. Views it hands out live as long as it does.
  [[nodiscard]] virtual std::unique_ptr<BlobReader> reader() = 0;

  /// Takes the writer lock (waits for it up to `wait_seconds`), finishes what a crash left and reads the tip.
  [[nodiscard]] virtual std::unique_ptr<Writer> writer(double wait_seconds = 600) = 0;

  struct Usage {
    std::uint64_t blob_file = 0;  ///< bytes that the LMDB data file occupies on disk
    std::uint64_t catalogue = 0;  ///< bytes that the SQLite files occupy on disk
  };
  [[nodiscard]] virtual Usage usage() = 0;

  struct Problem {
    std::string kind;  ///< "checksum", "missing", "orphan", "catalogue", ...
    std::optional<BlobKey> key;
    std::string text;
  };
  /// Checks what the store itself can: catalogue integrity, commit records against catalogue rows, every blob's
  /// checksum, leftovers. Calls `found` for each problem and returns the number of blobs looked at.
  virtual std::uint64_t check(const std::function<void(const Problem&)>& found) = 0;
};

class Pin {
 public:
  virtual ~Pin() = default;
};

/// Reads blobs within one LMDB read transaction.
class BlobReader {
 public:
  virtual ~BlobReader() = default;

  /// The blob's bytes, checksum verified. Throws corrupt (names kind, mesh, id, version) when it is missing or damaged.
  [[nodiscard]] virtual Buffer get(const BlobKey& key) = 0;
  /// The same, without complaint when it does not exist.
  [[nodiscard]] virtual std::optional<Buffer> find(const BlobKey& key) = 0;
  /// Ends the transaction and begins a new one, so that a long job neither bloats the file nor blocks pruning.
  virtual void renew() = 0;
  [[nodiscard]] virtual std::uint64_t blobs_read() const = 0;
  [[nodiscard]] virtual std::uint64_t bytes_read() const = 0;
};

struct CommitInfo {
  std::string branch = "main";
  bool nameless = false;   ///< instead: a version on no branch, to be had by its number only
  VersionId expected_tip;  ///< tip of the branch that this commit was decided on (compare-and-swap)
  std::vector<VersionId>
      parents;  ///< as a rule {expected_tip}; any others make a new branch (expected_tip 0) from them
  std::string author;
  std::string message;
  std::string attempt;  ///< from new_attempt_id(), unique
  std::string figures;
  std::vector<MeshRoot> roots;         ///< of all meshes of the version, unchanged ones included
  std::vector<ChangedCharts> changed;  ///< for logs, conflicts and diffs
};

/// Holds the writer lock and one attempt at a version. Destroying it without publish() takes everything back.
class Writer {
 public:
  virtual ~Writer() = default;

  [[nodiscard]] virtual VersionId version() const = 0;  ///< the number this attempt gets, never used before
  /// Version 0: there is no such branch yet. Throws invalid_argument for a tag.
  [[nodiscard]] virtual VersionId tip(std::string_view branch) = 0;
  /// A new id for a mesh. Throws limit_exceeded after 65,535 of them.
  [[nodiscard]] virtual MeshId new_mesh_id() = 0;

  /// Adds a blob with this attempt's version (`key.version` is set by the call). Any order; held in memory, sorted,
  /// until flush() or publish(). A key is put once.
  virtual void put(BlobKey key, Buffer blob) = 0;
  /// Writes what was put so far in a transaction of its own, remembered on the pending list: for large imports.
  virtual void flush() = 0;
  [[nodiscard]] virtual std::uint64_t bytes_put() const = 0;  ///< of all blobs of this attempt, checksums included

  /// The commit point. Returns the version. A branch that is not there yet is made, from whatever parents. Throws
  /// conflict when the branch's tip is not `expected_tip` any more, invalid_argument for a name that no branch may
  /// have, disk_full ("need N, have M"), storage. Nothing of a failed publish is ever visible.
  [[nodiscard]] virtual VersionId publish(const CommitInfo& info) = 0;
};

/// A random id for CommitInfo::attempt, 32 hexadecimal digits.
[[nodiscard]] std::string new_attempt_id();

}  // namespace ramcdb::db
