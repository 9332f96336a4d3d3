#include "api/commit.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <set>

#include "api/chart_difference.h"
#include "api/locks.h"
#include "api/page_rewriter.h"
#include "api/store_format.h"
#include "api/three_way.h"
#include "api/version_figures.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

const db::MeshRoot* root_of(const std::vector<db::MeshRoot>& roots, MeshId mesh) {
  const auto it = std::find_if(roots.begin(), roots.end(), [&](const db::MeshRoot& r) { return r.mesh == mesh; });
  return it == roots.end() ? nullptr : &*it;
}

/// Whether only `mine` wrote what a chart now has other than before.
bool is_work_of(VersionId mine, const ChartState& was, const ChartState& is) {
  if (was.size() != is.size()) return false;
  for (std::size_t i = 0; i < is.size(); ++i)
    if (is[i] != was[i] && is[i] != mine) return false;
  return true;
}

ChartState state_in(const PageIndex& pages, ChartId id) {
  const auto ref = pages.leaf_of(id);
  return ref ? state_of(*find_chart(*ref->leaf, id)) : ChartState{};
}

/// The charts that an index holds in a state other than the region's, or than the one that `mine` wrote.
std::vector<ChartId> charts_other_than(std::span<const RegionPart> parts, const PageIndex& there, VersionId mine) {
  std::vector<ChartId> others;
  for (const RegionPart& part : parts) {
    if (there.root() == part.at->root()) continue;
    for (const ChartId id : part.charts) {
      const ChartState was = state_in(part.at->pages(), id), is = state_in(there, id);
      if (is != was && !(mine && is_work_of(mine, was, is))) others.push_back(id);
    }
  }
  std::sort(others.begin(), others.end());
  return others;
}

/// The charts that an index holds in the region's state.
std::vector<ChartId> charts_as_in(std::span<const RegionPart> parts, const PageIndex& there) {
  std::vector<ChartId> equal;
  for (const RegionPart& part : parts)
    for (const ChartId id : part.charts)
      if (state_in(part.at->pages(), id) == state_in(there, id)) equal.push_back(id);
  std::sort(equal.begin(), equal.end());
  return equal;
}

const Snapshot::Impl& newest(std::span<const RegionPart> parts) {
  return *std::max_element(parts.begin(), parts.end(), [](const RegionPart& a, const RegionPart& b) {
            return a.at->version() < b.at->version();
          })->at;
}

PageIndex index_at(const Snapshot::Impl& base, VersionId version) {
  const auto roots = base.store().roots(version);
  const db::MeshRoot* root = root_of(roots, base.root().mesh);
  if (!root)
    throw Error(Errc::conflict, fmt::format("version {} does not hold mesh {}", version.value, base.root().name));
  return {base.store_handle(), *root};
}

std::vector<ChartId> common(const std::vector<ChartId>& charts, const std::set<ChartId>& others) {
  std::vector<ChartId> both;
  std::ranges::set_intersection(charts, others, std::back_inserter(both));
  return both;
}

std::string figures_of(const CommitReport& report, std::string_view operation, std::size_t charts) {
  VersionFigures figures;
  figures.operation = operation;
  figures.charts_touched = charts;
  figures.vertices_moved = report.vertices_moved;
  figures.vertices_added = report.vertices_added;
  figures.vertices_removed = report.vertices_removed;
  figures.max_displacement = report.max_displacement;
  figures.bytes_written = report.bytes_written;
  return encode_figures(figures);
}

void count_changes(const PendingEdit& edit, CommitReport& report) {
  const ChangeReport change = describe_edit(edit);
  report.notes = edit.notes;
  report.charts_touched = change.charts_touched.size();
  report.vertices_moved = change.vertices_moved;
  report.vertices_added = change.vertices_added;
  report.vertices_removed = change.vertices_removed;
  report.faces_added = change.faces_added;
  report.faces_removed = change.faces_removed;
  report.values_changed = change.values_changed;
  report.max_displacement = change.max_displacement;
}

void count_coded(const EncodedEdit& edit, CommitReport& report) {
  report.charts_reencoded = edit.charts_reencoded;
  report.added = edit.added;
  report.removed.assign(edit.pages.removed.begin(), edit.pages.removed.end());
  report.charts_added = report.added.size();
  report.charts_removed = report.removed.size();
  report.wires_reencoded = edit.wires_reencoded;
  report.layers_reencoded = edit.layers_reencoded;
  report.ranges_expanded = edit.ranges_expanded;
}

/// What a commit that went in before, and whose answer was lost, did.
void repeat_report(const PendingEdit& edit, VersionId published, CommitReport& report) {
  const Snapshot::Impl& base = edit.base();
  report.revision = published;
  report.parent = base.store().version(published).parents.front();
  const PageIndex now = index_at(base, published), before = index_at(base, report.parent);
  for (const db::ChangedCharts& changed : base.store().changed(published))
    for (const ChartId id : changed.charts) {
      if (changed.mesh != base.root().mesh) continue;
      if (!now.leaf_of(id)) report.removed.push_back(id);
      if (!before.leaf_of(id)) report.added.push_back(id);
    }
  report.charts_added = report.added.size();
  report.charts_removed = report.removed.size();
}

/// Puts all that a version writes, and says where the mesh then stands.
db::MeshRoot put_edit(const Snapshot::Impl& tip, EncodedEdit& edit, db::Writer& writer) {
  MeshRecord& record = edit.record;
  if (record.table && !record.table_version) record.table_version = writer.version();
  if (edit.new_layer_table) record.layers = writer.version();
  for (EncodedEdit::Blob& blob : edit.blobs) writer.put(blob.key, std::move(blob.bytes));
  const db::MeshRoot root = rewrite_pages(tip.pages(), edit.pages, writer, record);
  writer.put({db::Kind::mesh_record, root.mesh, 1, {}, 0}, encode_record(record));
  return root;
}

/// One version of one mesh on the tip of a branch.
class TipPublisher {
 public:
  TipPublisher(const Snapshot::Impl& base, const CommitOptions& options, std::string_view operation,
               const std::string& attempt,
               const std::function<std::optional<EncodedEdit>(const Snapshot::Impl&)>& encode, CommitReport& report)
      : base_(base),
        store_(base.store_handle()),
        mesh_(base.root().mesh),
        options_(options),
        branch_(options.onto.empty() ? options.branch : options.onto),
        operation_(operation),
        attempt_(attempt),
        encode_(encode),
        report_(report) {}

  void run() {
    constexpr int kTriesWithoutLock = 2;
    for (int tries = 0;; ++tries) {
      const auto lock = tries < kTriesWithoutLock ? nullptr : store_->writer();
      const VersionId tip = lock ? lock->tip(branch_) : store_->tip(branch_);
      const Snapshot::Impl at = snapshot_of(tip || options_.onto.empty() ? tip : base_.version());
      std::optional<EncodedEdit> edit = encode_(at);
      if (!edit) return;
      count_coded(*edit, report_);
      if (publish(tip, at, *edit, lock ? *lock : *store_->writer())) return;
    }
  }

 private:
  [[nodiscard]] Snapshot::Impl snapshot_of(VersionId version) const {
    const auto roots = store_->roots(version);
    if (const db::MeshRoot* root = root_of(roots, mesh_)) return {store_, version, *root};
    throw Error(Errc::conflict, fmt::format("mesh {} is not on branch {}", base_.root().name, branch_),
                version ? fmt::format("version {}", version.value) : "there is no such branch",
                "commit to the branch that you checked out from, or with --onto to a new one");
  }

  /// False when the tip moved.
  /// \param expected the branch's tip; 0 for a branch that begins with this version
  bool publish(VersionId expected, const Snapshot::Impl& tip, EncodedEdit& edit, db::Writer& writer) const {
    if (writer.tip(branch_) != expected) return false;
    if (!options_.ignore_locks) refuse_locked(*store_, mesh_, edit.changed, options_.author);
    db::CommitInfo info;
    info.roots = store_->roots(tip.version());
    const db::MeshRoot moved = put_edit(tip, edit, writer);
    for (db::MeshRoot& root : info.roots)
      if (root.mesh == moved.mesh) root = moved;
    info.branch = branch_;
    info.expected_tip = expected;
    info.parents = {tip.version()};
    if (edit.merged_version) info.parents.push_back(edit.merged_version);
    info.author = options_.author;
    info.message = options_.message;
    info.attempt = attempt_;
    info.changed = {{mesh_, edit.changed}};
    report_.parent = tip.version();
    report_.bytes_written = writer.bytes_put();
    info.figures = figures_of(report_, operation_, edit.changed.size());
    report_.revision = writer.publish(info);
    return true;
  }

  const Snapshot::Impl& base_;
  const std::shared_ptr<db::Store>& store_;
  MeshId mesh_;
  const CommitOptions& options_;
  const std::string& branch_;
  std::string_view operation_;
  const std::string& attempt_;
  const std::function<std::optional<EncodedEdit>(const Snapshot::Impl&)>& encode_;
  CommitReport& report_;
};

/// Whether a chart may be cut anew because of a small one beside it: those that others have locked stay.
std::function<bool(ChartId)> recut_rule(const PendingEdit& edit, const CommitOptions& options, bool outside) {
  return [&edit, &options, outside](ChartId id) {
    if (std::ranges::binary_search(edit.region.charts, id)) return true;
    const Snapshot::Impl& base = edit.base();
    return outside && (options.ignore_locks || !is_locked(*base.store_handle(), base.root().mesh, id, options.author));
  };
}

/// The charts that an edit touches, as a tip has them, and the edit of these.
EncodedEdit encode_on(const Snapshot::Impl& tip, const PendingEdit& edit, const CommitOptions& options) {
  const unsigned threads = options.threads;
  const RegionPart part{&tip, {edit.changes.touched.begin(), edit.changes.touched.end()}};
  RegionMesh region = load_region(std::span(&part, 1), threads, nullptr, true);
  EditedRegion edited = transferred(edit.edited, edit.region, region);
  return encode_edit(tip, std::move(region), std::move(edited), recut_rule(edit, options, edit.may_recut_outside),
                     threads);
}

/// Which charts' layers others changed, of those that an edit changes as well.
bool layers_overlap(const PendingEdit& edit, const Snapshot::Impl& tip, const std::vector<ChartId>& charts) {
  const auto version_of = [](const PageChart& chart, std::uint16_t layer) {
    const auto ref = std::ranges::find(chart.layers, layer, &LayerRef::layer);
    return ref == chart.layers.end() ? VersionId() : ref->version;
  };
  for (const ChartId id : charts) {
    const auto before = edit.base().pages().leaf_of(id), now = tip.pages().leaf_of(id);
    if (!before || !now) return true;
    for (const LayerEdit& layer : edit.changes.layers)
      if (version_of(*find_chart(*before->leaf, id), layer.layer.id) !=
          version_of(*find_chart(*now->leaf, id), layer.layer.id))
        return true;
  }
  return false;
}

/// Merges an edit with what became of its charts, and of all others that changed since: faces may have gone from one to
/// the other. None, with the conflicts in the report, where that cannot be or was not asked for.
std::optional<EncodedEdit> merge_on(const Snapshot::Impl& tip, const PendingEdit& edit, const CommitOptions& options,
                                    CommitReport& report) {
  const ChartDifference since = chart_difference(edit.base().pages(), tip.pages());
  std::set<ChartId> before(edit.region.charts.begin(), edit.region.charts.end()),
      now(since.added.begin(), since.added.end());
  before.insert(since.changed.begin(), since.changed.end());
  before.insert(since.removed.begin(), since.removed.end());
  for (const ChartId id : before)
    if (!std::ranges::binary_search(since.removed, id)) now.insert(id);

  std::vector<RegionPart> parts = edit.parts;
  for (const ChartId id : before)
    if (!std::ranges::binary_search(edit.region.charts, id)) parts.push_back({&edit.base(), {id}});
  const RegionPart tip_part{&tip, {now.begin(), now.end()}};
  const RegionMesh base = load_region(parts, options.threads, nullptr, true);
  RegionMesh theirs = load_region(std::span(&tip_part, 1), options.threads, nullptr, true);
  MergedEdit merged =
      merge_edits(tip, base, transferred(edit.edited, edit.region, base), theirs, charts_as_in(parts, tip.pages()));

  const bool geometry = !edit.changes.moves.empty() || edit.changes.connectivity();
  const bool other_kinds = !(geometry && merged.theirs_moved) && !layers_overlap(edit, tip, report.conflicts);
  if (!merged.conflicts.empty() || !(options.merge || other_kinds)) {
    report.conflict_places = std::move(merged.conflicts);
    return std::nullopt;
  }
  report.conflicts.clear();
  report.merged = true;
  return encode_edit(tip, std::move(theirs), std::move(merged.edited), recut_rule(edit, options, true),
                     options.threads);
}

}  // namespace

const Snapshot::Impl& PendingEdit::base() const { return newest(parts); }

void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch) {
  const Snapshot::Impl& base = newest(parts);
  report.base = base.version();
  report.tip = base.store().tip(branch);
  report.changed_by_others = charts_other_than(parts, index_at(base, report.tip), {});
  report.conflicts = common(report.changed_by_others, {report.charts_touched.begin(), report.charts_touched.end()});
}

std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version) {
  return charts_other_than(parts, index_at(newest(parts), version), version);
}

std::string attempt_name(std::string_view nonce, std::string_view branch, const PendingEdit& edit) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  const auto add_bytes = [&](const void* data, std::size_t size) { XXH3_128bits_update(&state, data, size); };
  const auto add = [&](std::uint64_t number) { add_bytes(&number, sizeof number); };
  const auto add_all = [&](const auto& items) {
    add(items.size());
    add_bytes(items.data(), items.size() * sizeof items[0]);
  };
  add_bytes(nonce.data(), nonce.size());
  add_bytes(branch.data(), branch.size());
  const RegionMesh& mesh = edit.edited.mesh;
  add_all(edit.edited.vertex_source);
  add_all(edit.edited.face_source);
  add_all(mesh.points);
  add_all(mesh.exact);
  add_all(mesh.faces);
  add_all(mesh.polygon_corners);
  for (const Attribute& attribute : mesh.attributes) add_all(attribute.values);
  const XXH128_hash_t hash = XXH3_128bits_digest(&state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

void publish_on_tip(const Snapshot::Impl& base, const CommitOptions& options, std::string_view operation,
                    const std::string& attempt,
                    const std::function<std::optional<EncodedEdit>(const Snapshot::Impl& tip)>& encode,
                    CommitReport& report) {
  TipPublisher(base, options, operation, attempt, encode, report).run();
}

CommitReport commit_edit(const PendingEdit& edit, const CommitOptions& options, const std::string& attempt,
                         VersionId second_parent) {
  const auto start = std::chrono::steady_clock::now();
  const Snapshot::Impl& base = edit.base();
  CommitReport report;
  count_changes(edit, report);
  if (edit.changes.empty()) {
    report.nothing_changed = true;
    report.revision = report.parent = base.version();
  } else if (const auto published = base.store().published_by(attempt)) {
    repeat_report(edit, *published, report);
  } else {
    publish_on_tip(
        base, options, edit.operation, attempt,
        [&](const Snapshot::Impl& tip) -> std::optional<EncodedEdit> {
          report.conflicts = common(charts_other_than(edit.parts, tip.pages(), {}), edit.changes.touched);
          auto encoded =
              report.conflicts.empty() ? encode_on(tip, edit, options) : merge_on(tip, edit, options, report);
          if (!encoded) return encoded;
          encoded->merged_version = second_parent;
          report.nothing_changed = encoded->pages.empty() && !second_parent;
          report.revision = report.parent = tip.version();
          return report.nothing_changed ? std::nullopt : std::move(encoded);
        },
        report);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
