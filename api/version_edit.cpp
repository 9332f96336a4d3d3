#include "api/version_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>

#include "api/chart_difference.h"
#include "api/edited_region_builder.h"
#include "api/limited_edit.h"
#include "api/region_match.h"
#include "api/region_mesh.h"
#include "api/region_query.h"
#include "api/version_figures.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// A mesh as an edit of another one.
class MeshAsEdit {
 public:
  MeshAsEdit(const Snapshot::Impl& at, const RegionMesh& region, const RegionMesh& mesh, std::span<const ChartId> equal)
      : at_(at),
        region_(region),
        mesh_(mesh),
        values_(region.attributes),
        match_(match_region(region, mesh, at.record().lattice, equal)),
        builder_(at, region) {}

  EditedRegion run() {
    std::vector<std::uint32_t> new_vertices, new_faces;
    for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
      const std::uint32_t source = match_.vertices[match_.vertex[v]].region;
      new_vertices.push_back(source == kNew ? v : kNew);
      (void)builder_.add_vertex(source, position_in(mesh_, at_.record().lattice, v));
      take_value(AttributeOf::vertex, v, source);
    }
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      add_face(f);
      new_faces.push_back(match_.faces[f].face == kNew ? f : kNew);
    }
    builder_.take_new(mesh_, std::move(new_vertices), std::move(new_faces));
    return builder_.finish(values_);
  }

 private:
  void add_face(std::uint32_t f) {
    const FaceMatch found = match_.faces[f];
    Triangle vertices = mesh_.faces[f];
    if (found.face != kNew)
      for (std::uint32_t i = 0; i < 3; ++i) vertices[(i + found.turn) % 3] = mesh_.faces[f][i];
    (void)builder_.add_face(vertices, found.face);
    if (found.face == kNew) return;
    take_value(AttributeOf::face, f, found.face);
    for (std::uint32_t i = 0; i < 3; ++i)
      take_value(AttributeOf::corner, 3 * f + i, 3 * found.face + (i + found.turn) % 3);
  }

  /// Of what stays, the mesh's value.
  void take_value(AttributeOf of, std::size_t from, std::uint32_t to) {
    if (to == kNew) return;
    for (std::size_t a = 0; a < values_.size(); ++a) {
      if (values_[a].info.of != of) continue;
      const std::size_t components = values_[a].info.components;
      std::copy_n(mesh_.attributes[a].values.begin() + static_cast<std::ptrdiff_t>(components * from), components,
                  values_[a].values.begin() + static_cast<std::ptrdiff_t>(components * to));
    }
  }

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  const RegionMesh& mesh_;
  std::vector<Attribute> values_;
  RegionMatch match_;
  EditedRegionBuilder builder_;
};

/// Charts of a version, and those that share a wire or a corner with them.
std::set<ChartId> with_neighbours(const Snapshot::Impl& at, std::vector<ChartId> charts,
                                  const std::vector<ChartId>& more) {
  charts.insert(charts.end(), more.begin(), more.end());
  if (charts.empty()) return {};
  const std::vector<ChartId> grown = find_charts(at, {{OfCharts{std::move(charts)}}, 1}, nullptr);
  return {grown.begin(), grown.end()};
}

const db::MeshRoot* root_with_id(const std::vector<db::MeshRoot>& roots, MeshId mesh) {
  const auto it = std::ranges::find(roots, mesh, &db::MeshRoot::mesh);
  return it == roots.end() ? nullptr : &*it;
}

/// The meshes of a merge that only one side changed, and those that both did.
struct MergedRoots {
  std::vector<db::MeshRoot> roots;       ///< of the branch, with what the other side alone changed
  std::vector<db::MeshRoot> both;        ///< as the branch has them
  std::vector<db::ChangedCharts> taken;  ///< charts of the meshes that were taken over
};

MergedRoots merge_roots(const std::shared_ptr<db::Store>& store, VersionId base, VersionId ours, VersionId theirs) {
  const auto base_roots = store->roots(base), their_roots = store->roots(theirs);
  MergedRoots merged{store->roots(ours), {}, {}};
  for (const db::MeshRoot& their_root : their_roots) {
    const db::MeshRoot* before = root_with_id(base_roots, their_root.mesh);
    if (before && *before == their_root) continue;
    const auto mine = std::ranges::find(merged.roots, their_root.mesh, &db::MeshRoot::mesh);
    if (mine == merged.roots.end()) {
      if (before)
        throw Error(Errc::conflict,
                    fmt::format("mesh {} was changed on one side and is gone on the other", their_root.name));
      const auto same_name = std::ranges::find(merged.roots, their_root.name, &db::MeshRoot::name);
      if (same_name != merged.roots.end())
        throw Error(Errc::conflict, fmt::format("both sides added a mesh '{}'", their_root.name));
      merged.roots.push_back(their_root);
      merged.taken.push_back({their_root.mesh, PageIndex(store, their_root).all_charts()});
    } else if (before && *mine == *before) {
      const ChartDifference difference = chart_difference(PageIndex(store, *before), PageIndex(store, their_root));
      db::ChangedCharts taken{their_root.mesh, difference.changed};
      taken.charts.insert(taken.charts.end(), difference.added.begin(), difference.added.end());
      taken.charts.insert(taken.charts.end(), difference.removed.begin(), difference.removed.end());
      std::ranges::sort(taken.charts);
      merged.taken.push_back(std::move(taken));
      *mine = their_root;
    } else if (!(*mine == their_root)) {
      merged.both.push_back(*mine);
    }
  }
  std::ranges::sort(merged.roots, {}, &db::MeshRoot::name);
  return merged;
}

/// Edits of meshes that two versions both hold, each with the other version's state as its goal.
class EditsBetween {
 public:
  EditsBetween(const std::shared_ptr<db::Store>& store, VersionId from, VersionId to,
               std::span<const db::MeshRoot> meshes, std::string_view operation, unsigned threads,
               const std::optional<Region>& within = {}) {
    const auto before = store->roots(from), after = store->roots(to);
    for (const db::MeshRoot& mesh : meshes) {
      snapshots_.push_back(std::make_unique<Snapshot::Impl>(store, from, *root_with_id(before, mesh.mesh)));
      snapshots_.push_back(std::make_unique<Snapshot::Impl>(store, to, *root_with_id(after, mesh.mesh)));
      edits_.push_back(edit_between(*snapshots_.end()[-2], *snapshots_.back(), threads, within));
      edits_.back().operation = operation;
    }
  }
  [[nodiscard]] std::span<const PendingEdit> edits() const { return edits_; }

 private:
  std::vector<std::unique_ptr<Snapshot::Impl>> snapshots_;
  std::vector<PendingEdit> edits_;
};

}  // namespace

EditedRegion mesh_as_edit(const Snapshot::Impl& at, const RegionMesh& region, const RegionMesh& mesh,
                          std::span<const ChartId> equal) {
  return MeshAsEdit(at, region, mesh, equal).run();
}

PendingEdit edit_between(const Snapshot::Impl& from, const Snapshot::Impl& to, unsigned threads,
                         const std::optional<Region>& within) {
  if (from.root().mesh != to.root().mesh || !(from.record().lattice == to.record().lattice))
    throw Error(Errc::invalid_argument, "these versions do not hold the same mesh",
                fmt::format("{} and {}", from.root().name, to.root().name), "name one mesh with --mesh");
  const ChartDifference difference = chart_difference(from.pages(), to.pages());
  PendingEdit edit;
  edit.may_recut_outside = true;
  if (difference.empty()) return edit;
  const std::set<ChartId> removed(difference.removed.begin(), difference.removed.end()),
      added(difference.added.begin(), difference.added.end());
  const std::set<ChartId> near_from = with_neighbours(from, difference.changed, difference.removed),
                          near_to = with_neighbours(to, difference.changed, difference.added);
  std::vector<ChartId> before, after, equal;
  std::ranges::set_union(near_from, near_to, std::back_inserter(before));
  std::erase_if(before, [&](ChartId id) { return added.contains(id); });
  if (before.empty()) before.push_back(from.pages().all_charts().front());
  std::ranges::set_difference(before, removed, std::back_inserter(after));
  std::ranges::set_difference(after, difference.changed, std::back_inserter(equal));
  after.insert(after.end(), added.begin(), added.end());
  std::ranges::sort(after);
  edit.parts = {{&from, before}};
  const RegionPart part{&to, after};
  edit.region = load_region(edit.parts, threads, nullptr, true);
  const RegionMesh mesh = load_region(std::span(&part, 1), threads, nullptr, true);
  edit.edited = mesh_as_edit(from, edit.region, mesh, equal);
  if (within) edit.edited = limited(from, edit.region, edit.edited, mesh, limits_of(*within, from, to));
  const auto& own = difference.changed.empty() ? difference.removed : difference.changed;
  if (!own.empty()) edit.edited.home = own.front();  // rather than a neighbour
  edit.changes = changes_of(from, edit.region, edit.edited);
  return edit;
}

MergeReport merge_version(const std::shared_ptr<db::Store>& store, VersionId theirs, const CommitOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  MergeReport report;
  report.theirs = theirs;
  CommitOptions merging = options;
  merging.merge = true;
  if (merging.message.empty()) merging.message = fmt::format("merge v{}", theirs.value);
  if (!store->tip(options.branch)) throw Error(Errc::not_found, fmt::format("there is no branch '{}'", options.branch));
  const auto make = [&](VersionId tip) -> std::optional<VersionDraft> {
    report.base = store->merge_base(tip, theirs);
    report.revision = report.parent = report.commit.parent = tip;
    report.nothing_changed = report.base == theirs;
    if (report.nothing_changed) return std::nullopt;
    MergedRoots merged = merge_roots(store, report.base, tip, theirs);
    VersionDraft draft;
    if (!merged.both.empty()) {
      const EditsBetween between(store, report.base, theirs, merged.both, "merge", options.threads);
      std::vector<CommitReport> reports = reports_of(between.edits());
      auto drawn = draft_of(between.edits(), tip, merging, reports);
      report.commit = added_up(reports);
      if (!drawn) return drawn;
      draft = *std::move(drawn);
    }
    draft.roots = std::move(merged.roots);
    draft.taken = std::move(merged.taken);
    draft.second_parent = theirs;
    report.charts_taken = 0;
    for (const db::ChangedCharts& taken : draft.taken) report.charts_taken += taken.charts.size();
    return draft;
  };
  publish_on_tip(store, {}, merging, "merge", db::new_attempt_id(), make, report.commit);
  if (report.commit.conflicts.empty() && !report.nothing_changed) report.revision = report.commit.revision;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

CommitReport revert_version(const std::shared_ptr<db::Store>& store, VersionId version, std::string_view mesh,
                            const std::optional<Region>& within, const CommitOptions& options) {
  const db::VersionInfo info = store->version(version);
  if (info.parents.empty())
    throw Error(Errc::invalid_argument, fmt::format("version {} has no version before it", version.value), {},
                "choose a later one");
  const VersionId parent = info.parents.front();
  std::vector<db::MeshRoot> changed = store->roots(version);
  const auto before = store->roots(parent);
  std::erase_if(changed, [&](const db::MeshRoot& root) {
    const db::MeshRoot* old = root_with_id(before, root.mesh);
    return !old || *old == root || !(mesh.empty() || root.name == mesh);
  });
  if (changed.empty())
    throw Error(Errc::invalid_argument, fmt::format("version {} changed no mesh that was there before", version.value));
  if (changed.size() > 1 && within)
    throw Error(Errc::invalid_argument,
                fmt::format("version {} changed several meshes, a region is of one", version.value), {},
                "name it with --mesh");
  CommitOptions reverting = options;
  reverting.merge = true;
  if (reverting.message.empty()) reverting.message = fmt::format("revert v{}: {}", version.value, info.message);
  const EditsBetween between(store, version, parent, changed, "revert", options.threads, within);
  return commit_edits(between.edits(), reverting, db::new_attempt_id());
}

}  // namespace ramcdb::detail
