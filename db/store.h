#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  /// Newest first along first parents and merges, from `from`; at most `limit` of them.
  [[nodiscard]] virtual std::vector<VersionInfo> history(VersionId from, std::size_t limit) = 0;
  /// Every published version of every branch, ascending.
  [[nodiscard]] virtual std::vector<VersionId> all_versions() = 0;
  [[nodiscard]] virtual std::vector<ChangedCharts> changed(VersionId id) = 0;
  /// The version that this attempt published, if it did: the answer to a commit whose answer got lost.
  [[nodiscard]] virtual std::optional<VersionId> published_by(std::string_view attempt) = 0;

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
  VersionId expected_tip;          ///< tip of the branch that this commit was decided on (compare-and-swap)
  std::vector<VersionId> parents;  ///< as a rule {expected_tip}; empty on an empty branch
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
  [[nodiscard]] virtual VersionId tip(std::string_view branch) = 0;  ///< version 0: nothing published there yet
  /// A new id for a mesh. Throws limit_exceeded after 65,535 of them.
  [[nodiscard]] virtual MeshId new_mesh_id() = 0;

  /// Adds a blob with this attempt's version (`key.version` is set by the call). Any order; held in memory, sorted,
  /// until flush() or publish(). A key is put once.
  virtual void put(BlobKey key, Buffer blob) = 0;
  /// Writes what was put so far in a transaction of its own, remembered on the pending list: for large imports.
  virtual void flush() = 0;
  [[nodiscard]] virtual std::uint64_t bytes_put() const = 0;  ///< of all blobs of this attempt, checksums included

  /// The commit point. Returns the version. Throws conflict when the branch's tip is not `expected_tip` any more,
  /// disk_full ("need N, have M"), storage. Nothing of a failed publish is ever visible.
  [[nodiscard]] virtual VersionId publish(const CommitInfo& info) = 0;
};

/// A random id for CommitInfo::attempt, 32 hexadecimal digits.
[[nodiscard]] std::string new_attempt_id();

}  // namespace ramcdb::db
