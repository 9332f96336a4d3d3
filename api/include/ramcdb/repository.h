#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/error.h"
#include "ramcdb/figures.h"
#include "ramcdb/names.h"
#include "ramcdb/snapshot.h"

namespace ramcdb {

class EditTransaction;
struct SmoothOptions;
struct TransformOptions;
struct DecimateOptions;

/// Called now and then with the stage and the share of it that is done (0..1), from the calling thread. It may throw
/// to cancel: the repository stays as it was.
using Progress = std::function<void(std::string_view stage, double done)>;

/// How the charts of a mesh are coded, those of later commits, too: smallest, or larger by a tenth or two and decoded
/// several times faster.
enum class ChartProfile { dense, fast };

struct ImportOptions {
  std::string name;    ///< of the mesh; the file's stem when empty
  unsigned bits = 16;  ///< step = largest extent / (2^bits - 1); 1..30
  /// Not 0: the largest coordinate error in model units, instead of `bits`. The step is twice this, or the next smaller
  /// round number (1, 2, 5 x 10^k or 2^k) if the file's numbers are all multiples of that, so that none is changed, or
  /// if it is less than a tenth smaller.
  double precision = 0;
  /// Instead of both: positions are kept to the last bit, as float32 when all coordinates are such numbers, else as
  /// float64; and attributes as with `lossless_attributes`.
  bool lossless = false;
  std::optional<Lattice> lattice;  ///< this very lattice
  /// Join vertices at equal positions? When not said, soups of triangles (STL) are welded, other meshes are not.
  std::optional<bool> weld;
  bool dry_run = false;              ///< do everything but write: the report says what would be
  bool lossless_attributes = false;  ///< keep colours, normals and texture coordinates that are floats bit by bit
  std::uint32_t chart_faces = 5000;
  bool paper_chartify = false;  ///< the paper's own Lloyd, for comparison
  ChartProfile profile = ChartProfile::dense;
  std::string message;  ///< "import FILE" when empty
  std::string author;
  std::string branch = "main";  ///< one that is not there yet begins from main
  unsigned threads = 1;         ///< changes the time, never the bytes
  /// Bytes to work in. A mesh that needs more is imported piece by piece, with temporary files in the repository's
  /// folder; its charts then are cut elsewhere, but the same for the same memory. That takes triangles without
  /// attributes from PLY, OBJ and STL; other meshes are refused (limit_exceeded). When not said: 1 GiB, and whatever it
  /// takes for those others.
  std::optional<std::uint64_t> memory;
  Progress progress;
};

struct CommitOptions {
  std::string message;
  std::string author;
  std::string branch = "main";
  unsigned threads = 1;
  Progress progress;
  bool ignore_locks = false;  ///< change charts that others than `author` have locked
  /// Where others changed the same charts meanwhile, merge three ways, vertex by vertex and value by value. Without it
  /// such edits are conflicts, unless one is of geometry and the other of attributes, or of other attributes.
  bool merge = false;
  /// A branch for this commit instead of `branch`: one that is not there yet begins at the version that the edit was
  /// made on, so that work that meets conflicts is never lost.
  std::string onto = {};
};

struct ImportIntoOptions {
  std::optional<bool> weld;  ///< as ImportOptions::weld
  bool dry_run = false;      ///< do everything but code and write: the report says what would be added
  CommitOptions commit;      ///< `message`: "import FILE" when empty
};

enum class Paint { none, chart, bits, version };

struct FileOptions {
  Paint paint = Paint::none;  ///< colour the faces (PLY, OFF); such a file is to look at and cannot be committed
  bool ascii = false;         ///< PLY as text
  bool overwrite = true;
  /// Checkout: write coordinates relative to a point near the region, which the sidecar keeps and commit adds again?
  /// When not said: where float32 (or in text formats six digits) cannot hold the coordinates, but can so.
  std::optional<bool> local_origin;
  std::optional<LockOptions> lock;  ///< checkout: lock the charts first; the file's commit gives the lock back
  unsigned threads = 1;
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< export: bytes for charts that are held at a time
  Progress progress;
};

struct DiffOptions {
  unsigned threads = 1;
  /// Not empty: a mesh to look at, .ply or .glb, coloured by how far vertices were moved: from dark blue for none to
  /// yellow for `max_displacement`; faces that were added are magenta. PLY has the displacement (model units, 0 for
  /// added vertices) as a number of each vertex, too. The charts that differ, as the newer version has them.
  std::filesystem::path heatmap;
  bool heatmap_of_all = false;  ///< of all charts
};

struct RepackOptions {
  std::optional<ChartProfile> profile;  ///< the mesh's own, with tables trained anew, when not said
  std::string message;                  ///< "repack as PROFILE" when empty
  std::string author;
  std::string branch = "main";
  unsigned threads = 1;
  Progress progress;
  bool ignore_locks = false;  ///< change charts that others than `author` have locked
};

/// A repository of meshes with their history: a folder. Cheap to copy; copies are the same repository. Thread-safe.
class Repository {
 public:
  class Impl;

  /// Makes an empty one. `folder` must not exist or be an empty folder.
  static void create(const std::filesystem::path& folder);
  /// Throws not_found, unsupported_version, corrupt, storage.
  static Repository open(const std::filesystem::path& folder);

  [[nodiscard]] std::filesystem::path folder() const;
  [[nodiscard]] std::string id() const;

  /// Revisions are `17`, `v17`, a branch, a tag, `HEAD`, each with `~N` behind it; empty is HEAD.
  [[nodiscard]] VersionId resolve(std::string_view revision) const;
  [[nodiscard]] std::vector<MeshSummary> meshes(std::string_view revision = {}) const;
  /// `mesh` may be empty where the version holds just one.
  [[nodiscard]] Snapshot snapshot(std::string_view mesh = {}, std::string_view revision = {}) const;
  /// Newest first, at most `limit`, those that changed `mesh` when it is not empty.
  [[nodiscard]] std::vector<VersionRecord> log(std::string_view revision = {}, std::size_t limit = ~std::size_t{0},
                                               std::string_view mesh = {}) const;
  /// Of these, the versions of a mesh (may be empty where `revision` holds just one) that touched a region: that
  /// changed a chart whose bounding box, before or after, meets one of the region's shapes, or one of the charts that
  /// it names. NearestTo and `grow` stand for charts as of `revision`. Reads index pages above changed charts only.
  [[nodiscard]] std::vector<VersionRecord> log_of_region(const Region& region, std::string_view revision = {},
                                                         std::size_t limit = ~std::size_t{0},
                                                         std::string_view mesh = {}) const;
  [[nodiscard]] VersionRecord show(std::string_view revision) const;

  // Branches and tags: names for versions. A branch moves with what is committed on it, a tag stays. Names are as
  // git's: at most 200 bytes, no spaces, control characters, `~^:?*[\`, `..`; not HEAD, 17 or v17; and no branch and
  // tag share one. Changes wait for the writer at work, are durable when they return, all or nothing, and cost no
  // blob. They throw invalid_argument for a name that is none, is taken or is of the other kind, not_found, corrupt
  // for a version that has lost its blobs, storage. Where they return versions, these are the ones that no name leads
  // to any more, ascending: they stay, and can be had by number.

  /// By name.
  [[nodiscard]] std::vector<Branch> branches() const;
  [[nodiscard]] std::vector<Tag> tags() const;
  /// At a revision (empty: HEAD). `force` moves a branch that is there.
  std::vector<VersionId> create_branch(std::string_view name, std::string_view at = {}, bool force = false);
  /// Throws invalid_argument for main and, unless `force`, where versions would be left without a name.
  std::vector<VersionId> delete_branch(std::string_view name, bool force = false);
  /// Versions keep the name of the branch that they were published on. Throws invalid_argument for main.
  void rename_branch(std::string_view from, std::string_view to);
  /// `force` has a tag that is there name another version.
  std::vector<VersionId> create_tag(std::string_view name, std::string_view at = {}, bool force = false);
  std::vector<VersionId> delete_tag(std::string_view name);

  // Advisory locks on charts. A commit that changes charts which others than its author have locked is refused
  // (conflict), unless it ignores locks. They name charts by id, on all branches: charts that a later edit makes of a
  // locked one are not locked. They end by the wall clock (UTC).

  /// Locks charts of a snapshot's mesh. Throws conflict, naming owners, where others hold one of them and not
  /// `options.steal`; invalid_argument without owner, or for more than ten years.
  LockReport lock(const Snapshot& snapshot, const std::vector<ChartId>& charts, const LockOptions& options);
  /// Gives back what `owner` holds of these charts, or one lock; with `force` what anybody does. Returns what was
  /// locked and is free of that lock now. Throws not_found when nothing was, conflict when others hold some of it.
  std::vector<LockInfo> unlock(const Snapshot& snapshot, const std::vector<ChartId>& charts, const std::string& owner,
                               bool force = false);
  std::vector<LockInfo> unlock(std::uint32_t id, const std::string& owner, bool force = false);
  /// All of `owner`; with `force` everybody's.
  std::vector<LockInfo> unlock_all(const std::string& owner, bool force = false);
  /// Those that count now, by id.
  [[nodiscard]] std::vector<LockInfo> locks() const;

  /// Adds the mesh of a file as one version. Throws invalid_argument for a file that cannot be taken whole.
  ImportReport import(const std::filesystem::path& file, const ImportOptions& options);
  /// Adds the mesh of a file to a mesh at the tip of a branch, as new components on its lattice, and commits that as
  /// one version; `mesh` may be empty where there is just one. Charts of small components may go into a chart nearby,
  /// which is then coded anew; conflicts over that one come back in the report, with nothing written. Throws
  /// limit_exceeded where the mesh's lattice does not reach, invalid_argument for a file that cannot be taken whole.
  ImportIntoReport import_into(std::string_view mesh, const std::filesystem::path& file,
                               const ImportIntoOptions& options);

  /// Writes a whole mesh, the format follows from the extension, a few charts of `options.memory` bytes at a time: the
  /// rest lies in temporary files beside the new one.
  CheckoutReport export_mesh(const Snapshot& snapshot, const std::filesystem::path& file,
                             const FileOptions& options) const;

  /// Writes a region as an ordinary mesh file and its sidecar `FILE.ramcdb.json` beside it, from which commit_file
  /// and status_file know where it came from. `options.lock` locks the charts, as lock() does, before anything is
  /// written.
  CheckoutReport checkout_file(const Snapshot& snapshot, const std::vector<ChartId>& charts,
                               const std::filesystem::path& file, const FileOptions& options) const;

  /// What a checked-out file would change. Throws invalid_argument where its edges at charts outside the region are
  /// not as they were. \param heatmap not empty: a mesh to look at, as DiffOptions::heatmap, of the file's region
  [[nodiscard]] ChangeReport status_file(const std::filesystem::path& file,
                                         const std::filesystem::path& heatmap = {}) const;
  /// Commits it. Conflicts come back in the report, with nothing written. Updates the sidecar to the new version.
  CommitReport commit_file(const std::filesystem::path& file, const CommitOptions& options);

  /// Starts an edit of one mesh on the tip of a branch.
  [[nodiscard]] EditTransaction begin_edit(std::string_view mesh = {}, std::string_view branch = "main");

  /// Smooths a region of a mesh at the tip of a branch and commits that as one version; see ramcdb/built_in_edits.h.
  /// With nothing moved, writes nothing and says so. Conflicts with what others published meanwhile come back in the
  /// report, with nothing written. Throws invalid_argument for options out of range, not_found for an empty region.
  CommitReport smooth(std::string_view mesh, const Region& region, const SmoothOptions& options);
  /// Moves a region by an affine map and commits, likewise. Charts outside that share vertices with it follow with
  /// these. Throws limit_exceeded where vertices would leave the lattice.
  CommitReport transform(std::string_view mesh, const Region& region, const TransformOptions& options);
  /// Takes faces out of a region where that changes the surface least, and commits, likewise.
  CommitReport decimate(std::string_view mesh, const Region& region, const DecimateOptions& options);

  /// How two versions of a mesh differ: reads the charts that do, and the index pages above them. Vertices and faces
  /// are recognized whatever charts they are in. Throws invalid_argument for snapshots of different meshes, and for a
  /// heat map in another format, or where a checked-out file is.
  [[nodiscard]] DiffReport diff(const Snapshot& from, const Snapshot& to, const DiffOptions& options = {}) const;

  /// Codes all charts of a mesh of a branch anew, as a new version that holds the very same mesh: in another profile,
  /// or with tables that suit it better after many edits. In the profile that the mesh has, a version is written only
  /// if it gets smaller. Commits that go in meanwhile are kept. Files checked out before count as of an older state:
  /// they commit only where no chart of theirs was coded anew, so check out again.
  RepackReport repack(std::string_view mesh, const RepackOptions& options);

  /// Merges a branch or another revision into `options.branch`, all meshes in one version. What one side alone changed
  /// is taken as it is; where both changed a mesh, charts are merged three ways as with CommitOptions::merge. Conflicts
  /// of all meshes come back in the report, with nothing written. Throws not_found, and conflict where a mesh was
  /// changed on one side and is gone on the other, or both sides added one of the same name.
  MergeReport merge(std::string_view revision, const CommitOptions& options);

  /// Takes back what a version did to a mesh, or when `mesh` is empty to all that it changed and that were there before
  /// it, on top of what came later, as one new version. Conflicts with later edits of the same vertices come back in
  /// the report, with nothing written. \param within take back only what the version changed in this region. Boxes,
  /// balls and frusta without `grow` cut through charts: vertices inside, before or after the version, go back to where
  /// they were, and so do the values of vertices inside and of faces whose bounding box is met. Where the version
  /// replaced faces, each island of such faces (connected by vertices) that is met goes back whole. All other regions
  /// are whole charts, as the version has them, or of those that it removed, as they were. Throws not_found as
  /// Snapshot::find.
  CommitReport revert(std::string_view revision, std::string_view mesh, const CommitOptions& options,
                      const std::optional<Region>& within = {});

  struct VerifyOptions {
    bool quick = false;  ///< checksums and references only, no decoding
    unsigned threads = 1;
    Progress progress;
  };
  [[nodiscard]] VerifyReport verify(const VerifyOptions& options) const;

  [[nodiscard]] Impl& impl() const { return *impl_; }

 private:
  explicit Repository(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

/// The repository that a checked-out file came from, opened. Throws not_found when the sidecar or the repository is
/// missing, invalid_argument when the sidecar belongs to another repository.
[[nodiscard]] Repository open_for_file(const std::filesystem::path& file);

}  // namespace ramcdb
