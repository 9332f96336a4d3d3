#include "api/checkout.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "api/commit.h"
#include "api/heatmap.h"
#include "api/locks.h"
#include "api/progress.h"
#include "api/region_file.h"
#include "api/sidecar.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

CheckoutReport report_for(const Snapshot& snapshot, const RegionMesh& region, const ReadCost& cost,
                          const WrittenRegion& written) {
  CheckoutReport report;
  report.revision = snapshot.version();
  report.charts = region.charts.size();
  report.faces = region.faces.size();
  report.vertices = region.points.size();
  add_costs(report, cost, written);
  return report;
}

/// A file may be replaced when nothing in it can be lost: it is as some checkout wrote it.
bool is_untouched_checkout(const std::filesystem::path& file) {
  try {
    return read_sidecar(file).file_hash == hash_file(file);
  } catch (const Error&) {
    return false;
  }
}

/// A checked-out file as read back: the region it came from and what it moves.
struct EditedFile {
  Sidecar sidecar;
  std::vector<std::unique_ptr<Snapshot::Impl>> snapshots;
  PendingEdit edit;
};

const db::MeshRoot& root_named(const std::vector<db::MeshRoot>& roots, const std::string& name, VersionId version) {
  const auto it = std::find_if(roots.begin(), roots.end(), [&](const db::MeshRoot& r) { return r.name == name; });
  if (it == roots.end()) throw Error(Errc::not_found, fmt::format("version {} has no mesh '{}'", version.value, name));
  return *it;
}

EditedFile read_edited_file(const std::shared_ptr<db::Store>& store, const std::filesystem::path& file,
                            const Progress& progress) {
  begin_stage(progress, "read charts");
  EditedFile edited;
  edited.sidecar = read_sidecar(file);
  if (edited.sidecar.repository_id != store->id())
    throw Error(Errc::invalid_argument, "the file was checked out from another repository", file.string(),
                "use the repository that its sidecar names, or check out again");
  if (edited.sidecar.painted)
    throw Error(Errc::invalid_argument, "the file was coloured to look at", file.string(),
                "check out without --color to edit");
  for (const Sidecar::Part& part : edited.sidecar.parts) {
    const auto roots = store->roots(part.version);
    edited.snapshots.push_back(
        std::make_unique<Snapshot::Impl>(store, part.version, root_named(roots, edited.sidecar.mesh, part.version)));
    edited.edit.parts.push_back({edited.snapshots.back().get(), part.charts});
  }
  PendingEdit& edit = edited.edit;
  edit.region = load_region(edit.parts, 1, nullptr, true);
  const mesh_file::MeshData data = mesh_file::read_mesh(file, stage(progress, "read file"));
  const Snapshot::Impl& at = *edit.parts.front().at;
  const bool trust_ids = edit.parts.size() == 1 && edited.sidecar.ids_version == at.version();
  begin_stage(progress, "match");
  try {
    FileEdit found = edited_in_file(at, edit.region, data, edited.sidecar.local_origin, trust_ids);
    edit.edited = std::move(found.edited);
    edit.notes = std::move(found.notes);
    edit.changes = changes_of(at, edit.region, edit.edited);
  } catch (const Error& e) {
    throw Error(e.code(), fmt::format("{}: {}", file.string(), e.what()));
  }
  return edited;
}

/// The file stays an edit of what it was checked out from.
void keep_sidecar(EditedFile& edited, const std::filesystem::path& file) {
  edited.sidecar.file_hash = hash_file(file);
  edited.sidecar.nonce = db::new_attempt_id();
  write_sidecar(file, edited.sidecar);
}

/// After a commit the file holds the new version's charts, except those that others changed meanwhile: these it still
/// holds as they were.
/// \param published the version that has what the file holds
void move_sidecar_on(EditedFile& edited, const std::filesystem::path& file, VersionId published,
                     const CommitReport& report) {
  const std::vector<ChartId> others = changed_by_others(edited.edit.parts, published);
  std::map<VersionId, std::vector<ChartId>> charts_at;
  for (const Sidecar::Part& part : edited.sidecar.parts)
    for (const ChartId id : part.charts) {
      if (std::ranges::binary_search(report.removed, id)) continue;
      charts_at[std::binary_search(others.begin(), others.end(), id) ? part.version : published].push_back(id);
    }
  for (const ChartId id : report.added) charts_at[published].push_back(id);
  edited.sidecar.parts.clear();
  for (auto& [version, charts] : charts_at) {
    std::sort(charts.begin(), charts.end());
    edited.sidecar.parts.push_back({version, std::move(charts)});
  }
  edited.sidecar.ids_version = VersionId();
  edited.sidecar.file_hash = hash_file(file);
  edited.sidecar.nonce = db::new_attempt_id();
  write_sidecar(file, edited.sidecar);
}

}  // namespace

void add_costs(CheckoutReport& report, const ReadCost& cost, const WrittenRegion& written) {
  report.bytes_read = cost.bytes;
  report.blobs_read = cost.blobs;
  report.pages_read = cost.pages;
  report.local_origin = written.local_origin;
  for (const auto& dropped : written.left_out) report.left_out.push_back({dropped.what, dropped.count});
}

void refuse_to_overwrite(const std::filesystem::path& file, const FileOptions& options) {
  if (!options.overwrite && std::filesystem::exists(file) && !is_untouched_checkout(file))
    throw Error(Errc::invalid_argument, "the file exists and is no unedited checkout", file.string(),
                "choose another name, or --force to replace it");
}

CheckoutReport checkout_region(db::Store& store, const std::filesystem::path& repository, const Snapshot& snapshot,
                               const std::vector<ChartId>& charts, const std::filesystem::path& file,
                               const FileOptions& options, std::uint32_t lock) {
  const auto start = Clock::now();
  refuse_to_overwrite(file, options);
  ReadCost cost;
  const RegionMesh region = snapshot.read_with_attributes(charts, options.threads, &cost);
  std::error_code ignored;
  std::filesystem::remove(sidecar_path(file), ignored);
  Sidecar sidecar;
  const WrittenRegion written = write_region(snapshot, region, file, options);
  sidecar.local_origin = written.local_origin;
  sidecar.repository_id = store.id();
  sidecar.repository = repository;
  sidecar.mesh = snapshot.impl().root().name;
  sidecar.parts = {{snapshot.version(), region.charts}};
  sidecar.ids_version = snapshot.version();
  sidecar.file_hash = hash_file(file);
  sidecar.nonce = db::new_attempt_id();
  sidecar.lock = lock;
  sidecar.painted = options.paint != Paint::none;
  write_sidecar(file, sidecar);
  CheckoutReport report = report_for(snapshot, region, cost, written);
  report.seconds = seconds_since(start);
  return report;
}

ChangeReport status_of_file(const std::shared_ptr<db::Store>& store, const std::filesystem::path& file,
                            const std::filesystem::path& heatmap) {
  if (!heatmap.empty()) require_heatmap_file(heatmap);
  const EditedFile edited = read_edited_file(store, file, {});
  ChangeReport report = describe_edit(edited.edit);
  if (!heatmap.empty()) write_heatmap(edited.edit.base(), heat_of_edit(edited.edit), report.max_displacement, heatmap);
  compare_with_tip(report, edited.edit.parts, "main");
  return report;
}

CommitReport commit_file(const std::shared_ptr<db::Store>& store, const std::filesystem::path& file,
                         const CommitOptions& options) {
  const auto start = Clock::now();
  EditedFile edited = read_edited_file(store, file, options.progress);
  CommitReport report =
      commit_edit(edited.edit, options, attempt_name(edited.sidecar.nonce, options.branch, edited.edit));
  if (report.conflicts.empty() && !report.nothing_changed) {
    release_lock(*store, std::exchange(edited.sidecar.lock, 0));
    if (!report.merged)
      move_sidecar_on(edited, file, report.revision, report);
    else if (const auto unmerged = publish_unmerged(edited.edit, report.revision, options))
      move_sidecar_on(edited, file, *unmerged, {});  // the file does not hold what others did
    else
      keep_sidecar(edited, file);
  }
  report.seconds = seconds_since(start);
  return report;
}

}  // namespace ramcdb::detail
