#include "ramcdb/repository.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/checkout.h"
#include "api/diff.h"
#include "api/import.h"
#include "api/import_into.h"
#include "api/locks.h"
#include "api/new_mesh.h"
#include "api/region_log.h"
#include "api/repack.h"
#include "api/repository_impl.h"
#include "api/sidecar.h"
#include "api/snapshot_impl.h"
#include "api/verify.h"
#include "api/version_edit.h"
#include "api/version_figures.h"

namespace ramcdb {
namespace {

const db::MeshRoot& choose_mesh(const std::vector<db::MeshRoot>& roots, std::string_view name, VersionId version) {
  std::string names;
  for (const db::MeshRoot& root : roots) {
    if (root.name == name) return root;
    names += (names.empty() ? "" : ", ") + root.name;
  }
  const std::string where = fmt::format("version {}", version.value);
  if (roots.empty())
    throw Error(Errc::not_found, "the repository holds no mesh yet", where, "add one with `ramcdb import REPO FILE`");
  if (!name.empty())
    throw Error(Errc::not_found, fmt::format("there is no mesh '{}'", name), where, "it holds " + names);
  if (roots.size() > 1)
    throw Error(Errc::invalid_argument, "the repository holds several meshes", where, "choose with --mesh: " + names);
  return roots.front();
}

VersionRecord record_of(db::Store& store, const db::VersionInfo& info, const std::vector<db::Ref>& refs) {
  const detail::VersionFigures figures = detail::decode_figures(info.figures);
  VersionRecord record;
  record.id = info.id;
  record.parents = info.parents;
  record.branch = info.branch;
  record.author = info.author;
  record.message = info.message;
  record.time_us = info.time_us;
  record.operation = figures.operation;
  record.charts_touched = figures.charts_touched;
  record.vertices_moved = figures.vertices_moved;
  record.vertices_added = figures.vertices_added;
  record.vertices_removed = figures.vertices_removed;
  record.max_displacement = figures.max_displacement;
  record.bytes_written = figures.bytes_written;
  for (const db::Ref& ref : refs)
    if (ref.version == info.id) record.refs.push_back({ref.name, ref.is_tag});
  const auto roots = store.roots(info.id);
  for (db::ChangedCharts& change : store.changed(info.id)) {
    const auto root = std::find_if(roots.begin(), roots.end(), [&](const auto& r) { return r.mesh == change.mesh; });
    record.changes.push_back({root == roots.end() ? std::string() : root->name, std::move(change.charts)});
  }
  return record;
}

bool changes_mesh(const VersionRecord& record, std::string_view mesh) {
  return mesh.empty() || std::any_of(record.changes.begin(), record.changes.end(),
                                     [&](const auto& change) { return change.mesh == mesh; });
}

}  // namespace

void Repository::create(const std::filesystem::path& folder) { db::Store::create(folder); }

Repository Repository::open(const std::filesystem::path& folder) {
  return Repository(std::make_shared<Impl>(std::filesystem::absolute(folder)));
}

std::filesystem::path Repository::folder() const { return impl_->folder(); }
std::string Repository::id() const { return impl_->store()->id(); }
VersionId Repository::resolve(std::string_view revision) const { return impl_->store()->resolve(revision); }

std::vector<MeshSummary> Repository::meshes(std::string_view revision) const {
  const auto& store = impl_->store();
  const VersionId version = store->resolve(revision);
  std::vector<MeshSummary> summaries;
  for (const db::MeshRoot& root : store->roots(version)) {
    const Snapshot::Impl at(store, version, root);
    const detail::MeshRecord& record = at.record();
    summaries.push_back({root.name, root.mesh, record.vertices, record.faces, record.charts, at.bytes().payload});
  }
  return summaries;
}

Snapshot Repository::snapshot(std::string_view mesh, std::string_view revision) const {
  const auto& store = impl_->store();
  const VersionId version = store->resolve(revision);
  const auto roots = store->roots(version);
  return Snapshot(std::make_shared<Snapshot::Impl>(store, version, choose_mesh(roots, mesh, version)));
}

std::vector<VersionRecord> Repository::log(std::string_view revision, std::size_t limit, std::string_view mesh) const {
  const auto& store = impl_->store();
  const VersionId from = store->resolve(revision);
  std::vector<VersionRecord> records;
  if (!from) return records;
  const std::vector<db::Ref> refs = store->refs();
  const std::size_t most = mesh.empty() ? limit : ~std::size_t{0};
  for (const db::VersionInfo& info : store->history(from, most)) {
    VersionRecord record = record_of(*store, info, refs);
    if (changes_mesh(record, mesh)) records.push_back(std::move(record));
    if (records.size() == limit) break;
  }
  return records;
}

std::vector<VersionRecord> Repository::log_of_region(const Region& region, std::string_view revision, std::size_t limit,
                                                     std::string_view mesh) const {
  const auto& store = impl_->store();
  const Snapshot from = snapshot(mesh, revision);
  const std::vector<db::Ref> refs = store->refs();
  detail::RegionLog touches(from.impl(), region);
  std::vector<VersionRecord> records;
  for (const db::VersionInfo& info : store->history(from.version(), ~std::size_t{0})) {
    if (records.size() == limit) break;
    if (touches.touched_by(info)) records.push_back(record_of(*store, info, refs));
  }
  return records;
}

VersionRecord Repository::show(std::string_view revision) const {
  const auto& store = impl_->store();
  const VersionId version = store->resolve(revision);
  if (!version)
    throw Error(Errc::not_found, "the repository has no version yet", folder().string(),
                "add a mesh with `ramcdb import REPO FILE`");
  return record_of(*store, store->version(version), store->refs());
}

namespace {

/// A folder that is gone with the object.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / ("ramcdb-" + db::new_attempt_id())) {}
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The import into a repository that nobody keeps.
ImportReport try_import(const std::filesystem::path& file, ImportOptions options) {
  options.dry_run = false;
  const ScratchFolder scratch;
  Repository::create(scratch.path());
  ImportReport report = Repository::open(scratch.path()).import(file, options);
  report.info.revision = VersionId();
  return report;
}

}  // namespace

ImportReport Repository::import(const std::filesystem::path& file, const ImportOptions& options) {
  if (options.dry_run) {
    detail::refuse_taken_name(*impl_->store(), options, file);
    return try_import(file, options);
  }
  const auto store = impl_->store_for_writing();
  std::string name;
  ImportReport report = detail::import_mesh(*store, folder(), file, options, name);
  report.info = snapshot(name, options.branch).info();
  return report;
}

ImportIntoReport Repository::import_into(std::string_view mesh, const std::filesystem::path& file,
                                         const ImportIntoOptions& options) {
  if (!options.dry_run) (void)impl_->store_for_writing();
  return detail::import_into(snapshot(mesh, options.commit.branch), file, options);
}

CheckoutReport Repository::export_mesh(const Snapshot& snapshot, const std::filesystem::path& file,
                                       const FileOptions& options) const {
  return detail::export_mesh(snapshot, file, options);
}

CheckoutReport Repository::checkout_file(const Snapshot& snapshot, const std::vector<ChartId>& charts,
                                         const std::filesystem::path& file, const FileOptions& options) const {
  if (!options.lock) return detail::checkout_region(*impl_->store(), folder(), snapshot, charts, file, options, 0);
  const auto store = impl_->store_for_writing();
  const LockReport taken = detail::lock_charts(store, snapshot.impl(), charts, *options.lock);
  try {
    CheckoutReport report = detail::checkout_region(*store, folder(), snapshot, charts, file, options, taken.lock.id);
    report.lock = taken;
    return report;
  } catch (...) {
    detail::release_lock(*store, taken.lock.id);
    throw;
  }
}

ChangeReport Repository::status_file(const std::filesystem::path& file, const std::filesystem::path& heatmap) const {
  const auto& store = impl_->store();
  ChangeReport report = detail::status_of_file(store, file, heatmap);
  const detail::Sidecar sidecar = detail::read_sidecar(file);
  std::vector<ChartId> charts;
  for (const auto& part : sidecar.parts) charts.insert(charts.end(), part.charts.begin(), part.charts.end());
  std::sort(charts.begin(), charts.end());
  const auto roots = store->roots(sidecar.parts.front().version);
  report.locks = detail::locks_on(store, choose_mesh(roots, sidecar.mesh, sidecar.parts.front().version).mesh, charts);
  return report;
}

CommitReport Repository::commit_file(const std::filesystem::path& file, const CommitOptions& options) {
  return detail::commit_file(impl_->store_for_writing(), file, options);
}

MergeReport Repository::merge(std::string_view revision, const CommitOptions& options) {
  const auto store = impl_->store_for_writing();
  return detail::merge_version(store, store->resolve(revision), options);
}

CommitReport Repository::revert(std::string_view revision, std::string_view mesh, const CommitOptions& options,
                                const std::optional<Region>& within) {
  const auto store = impl_->store_for_writing();
  return detail::revert_version(store, store->resolve(revision), mesh, within, options);
}

RepackReport Repository::repack(std::string_view mesh, const RepackOptions& options) {
  (void)impl_->store_for_writing();
  const Snapshot before = snapshot(mesh, options.branch);
  RepackReport report = detail::repack_mesh(before.impl(), options);
  report.before = before.info().bytes;
  const MeshInfo after = snapshot(before.info().mesh, options.branch).info();
  report.after = after.bytes;
  report.profile = after.profile;
  return report;
}

DiffReport Repository::diff(const Snapshot& from, const Snapshot& to, const DiffOptions& options) const {
  return detail::diff_versions(from.impl(), to.impl(), options);
}

VerifyReport Repository::verify(const VerifyOptions& options) const {
  return detail::verify_repository(impl_->store(), options);
}

Repository open_for_file(const std::filesystem::path& file) {
  const detail::Sidecar sidecar = detail::read_sidecar(file);
  Repository repository = Repository::open(sidecar.repository);
  if (repository.id() != sidecar.repository_id)
    throw Error(Errc::invalid_argument, "the sidecar belongs to another repository than the one at its path",
                sidecar.repository.string(), "check out again");
  return repository;
}

}  // namespace ramcdb
