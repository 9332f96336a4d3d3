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
#include "api/region_query.h"
#include "api/three_way.h"
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

CommitReport counted(const PendingEdit& edit) {
  const ChangeReport change = describe_edit(edit);
  CommitReport report;
  report.mesh = edit.base().root().name;
  report.notes = edit.notes;
  report.charts_touched = change.charts_touched.size();
  report.vertices_moved = change.vertices_moved;
  report.vertices_added = change.vertices_added;
  report.vertices_removed = change.vertices_removed;
  report.faces_added = change.faces_added;
  report.faces_removed = change.faces_removed;
  report.values_changed = change.values_changed;
  report.max_displacement = change.max_displacement;
  return report;
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

/// Whether a chart may be cut anew because of a small one beside it: those that others have locked stay.
std::function<bool(ChartId)> recut_rule(const PendingEdit& edit, const CommitOptions& options, bool outside) {
  return [&edit, &options, outside](ChartId id) {
    if (std::ranges::binary_search(edit.region.charts, id)) return true;
    const Snapshot::Impl& base = edit.base();
    return outside && (options.ignore_locks || !is_locked(*base.store_handle(), base.root().mesh, id, options.author));
  };
}

/// The chart, of those that are there, that takes what an edit adds apart from everything: not one that only others
/// changed.
ChartId home_in(const PendingEdit& edit, const std::vector<ChartId>& charts) {
  const auto is_there = [&](ChartId id) { return std::ranges::binary_search(charts, id); };
  if (edit.edited.home && is_there(edit.edited.home)) return edit.edited.home;
  const auto first = std::ranges::find_if(edit.region.charts, is_there);
  return first == edit.region.charts.end() ? ChartId() : *first;
}

/// Whether an edit left a vertex of its region where it was, with the values that it had.
bool is_as_before(const EditedRegion& edited, const RegionMesh& region, std::uint32_t v) {
  const std::uint32_t source = edited.vertex_source[v];
  const RegionMesh& mesh = edited.mesh;
  if (mesh.points[v] != region.points[source]) return false;
  if (!region.exact.empty() && mesh.exact[v] != region.exact[source]) return false;
  for (std::size_t a = 0; a < region.attributes.size(); ++a) {
    const std::size_t n = region.attributes[a].info.components;
    if (region.attributes[a].info.of == AttributeOf::vertex &&
        !std::equal(mesh.attributes[a].values.begin() + static_cast<std::ptrdiff_t>(v * n),
                    mesh.attributes[a].values.begin() + static_cast<std::ptrdiff_t>((v + 1) * n),
                    region.attributes[a].values.begin() + static_cast<std::ptrdiff_t>(source * n)))
      return false;
  }
  return true;
}

/// Per vertex of an edit whether it lost its faces there and nothing else happened to it, while charts outside had it
/// in theirs: it is for those to say whether it stays.
std::vector<bool> left_to_others(const PendingEdit& edit) {
  const EditedRegion& edited = edit.edited;
  std::vector<bool> left(edited.mesh.points.size(), true);
  for (const Triangle& t : edited.mesh.faces)
    for (const std::uint32_t v : t) left[v] = false;
  const auto key_of = [&](std::uint32_t v) { return edit.region.keys[edited.vertex_source[v]]; };
  CornerPlaces corners;
  for (std::uint32_t v = 0; v < left.size(); ++v) {
    left[v] = left[v] && edited.vertex_source[v] != kNew && key_of(v).where == VertexKey::Where::corner &&
              is_as_before(edited, edit.region, v);
    if (left[v]) corners.emplace(key_of(v).id, edit.region.points[edited.vertex_source[v]]);
  }
  if (corners.empty()) return left;
  const auto around = charts_at_corners(edit.base(), corners);
  for (std::uint32_t v = 0; v < left.size(); ++v)
    left[v] = left[v] && !std::ranges::includes(edit.region.charts, around.at(CornerId(key_of(v).id)));
  return left;
}

/// The charts that an edit touches, as a tip has them, and the edit of these: all that it holds, as a rule, of the very
/// tip.
EncodedEdit encode_on(const Snapshot::Impl& tip, const PendingEdit& edit, const CommitOptions& options) {
  const auto may_recut = recut_rule(edit, options, edit.may_recut_outside);
  const bool touches_all = std::ranges::equal(edit.changes.touched, edit.region.charts);
  if (touches_all && edit.parts.size() == 1 && edit.parts.front().at->root() == tip.root())
    return encode_edit(tip, edit.region, edit.edited, may_recut, options.threads);
  const RegionPart part{&tip, {edit.changes.touched.begin(), edit.changes.touched.end()}};
  RegionMesh region = load_region(std::span(&part, 1), options.threads, nullptr, true);
  EditedRegion edited = transferred(edit.edited, edit.region, region, left_to_others(edit));
  edited.home = home_in(edit, region.charts);
  return encode_edit(tip, std::move(region), std::move(edited), may_recut, options.threads);
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

  // Vertices of one version are told apart by who they are, those of several only by their places.
  std::vector<RegionPart> parts = edit.parts;
  RegionPart& of_base = *std::ranges::find(parts, &edit.base(), &RegionPart::at);
  for (const ChartId id : before)
    if (!std::ranges::binary_search(edit.region.charts, id)) of_base.charts.push_back(id);
  std::ranges::sort(of_base.charts);
  const RegionPart tip_part{&tip, {now.begin(), now.end()}};
  const RegionMesh base = load_region(parts, options.threads, nullptr, true);
  RegionMesh theirs = load_region(std::span(&tip_part, 1), options.threads, nullptr, true);
  MergedEdit merged =
      merge_edits(tip, base, transferred(edit.edited, edit.region, base), theirs, charts_as_in(parts, tip.pages()));

  const bool geometry = !edit.changes.moves.empty() || edit.changes.connectivity();
  const bool other_kinds = !(geometry && merged.theirs_moved) && !layers_overlap(edit, tip, report.conflicts);
  if (!merged.conflicts.empty() || !(options.merge || other_kinds)) {
    report.conflict_places = std::move(merged.conflicts);
    for (MergeConflict& conflict : report.conflict_places) conflict.mesh = report.mesh;
    return std::nullopt;
  }
  merged.edited.home = home_in(edit, theirs.charts);
  report.conflicts.clear();
  report.merged = true;
  return encode_edit(tip, std::move(theirs), std::move(merged.edited), recut_rule(edit, options, true),
                     options.threads);
}

/// An edit on a tip, merged where others changed the same charts. None, with the conflicts in the report, where that
/// cannot be or was not asked for.
std::optional<EncodedEdit> encode_or_merge(const Snapshot::Impl& tip, const PendingEdit& edit,
                                           const CommitOptions& options, CommitReport& report) {
  report.conflict_places.clear();
  report.merged = false;
  report.conflicts = common(charts_other_than(edit.parts, tip.pages(), {}), edit.changes.touched);
  if (report.conflicts.empty()) return encode_on(tip, edit, options);
  return merge_on(tip, edit, options, report);
}

/// Refers to blobs that another version wrote alike instead of writing them again.
void share_blobs(EncodedEdit& edit, const Snapshot::Impl& at, VersionId other) {
  const auto reader = at.store().reader();
  std::erase_if(edit.blobs, [&](const EncodedEdit::Blob& blob) {
    db::BlobKey key = blob.key;
    key.version = other;
    if (reader->find(key) != blob.bytes) return false;
    if (key.kind == db::Kind::wire) {
      for (auto& [id, wire] : edit.pages.wires)
        if (wire.group.value == key.id && !wire.version) wire.version = other;
      return true;
    }
    PageChart& chart = edit.pages.charts.at(ChartId(key.id));
    if (key.kind == db::Kind::chart)
      chart.version = other;
    else
      std::ranges::find(chart.layers, key.layer, &LayerRef::layer)->version = other;
    return true;
  });
}

bool has_new_ids(const MeshRecord& before, const MeshRecord& after) {
  return before.next_chart != after.next_chart || before.next_wire != after.next_wire ||
         before.next_corner != after.next_corner;
}

template <class Item>
void append(const std::vector<Item>& items, std::vector<Item>& to) {
  to.insert(to.end(), items.begin(), items.end());
}

/// Adds the report of one mesh to that of several.
void add(const CommitReport& report, CommitReport& sum) {
  sum.merged = sum.merged || report.merged;
  for (const auto count : {&CommitReport::charts_touched, &CommitReport::charts_reencoded, &CommitReport::charts_added,
                           &CommitReport::charts_removed, &CommitReport::wires_reencoded,
                           &CommitReport::ranges_expanded, &CommitReport::vertices_moved, &CommitReport::vertices_added,
                           &CommitReport::vertices_removed, &CommitReport::faces_added, &CommitReport::faces_removed,
                           &CommitReport::values_changed, &CommitReport::layers_reencoded})
    sum.*count += report.*count;
  sum.max_displacement = std::max(sum.max_displacement, report.max_displacement);
  append(report.conflict_places, sum.conflict_places);
  append(report.conflicts, sum.conflicts);
  append(report.added, sum.added);
  append(report.removed, sum.removed);
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

std::vector<CommitReport> reports_of(std::span<const PendingEdit> edits) {
  std::vector<CommitReport> reports;
  for (const PendingEdit& edit : edits) reports.push_back(counted(edit));
  return reports;
}

CommitReport added_up(const std::vector<CommitReport>& reports) {
  if (reports.size() == 1) return reports.front();
  CommitReport sum;
  for (const CommitReport& report : reports) add(report, sum);
  sum.per_mesh = reports;
  return sum;
}

std::optional<VersionDraft> draft_of(std::span<const PendingEdit> edits, VersionId tip, const CommitOptions& options,
                                     std::vector<CommitReport>& reports) {
  VersionDraft draft;
  bool refused = false;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const auto at = mesh_on_branch(edits[i].base(), tip, options.onto.empty() ? options.branch : options.onto);
    reports[i].revision = reports[i].parent = tip;
    reports[i].nothing_changed = edits[i].changes.empty();
    if (reports[i].nothing_changed) continue;
    auto encoded = encode_or_merge(*at, edits[i], options, reports[i]);
    reports[i].nothing_changed = encoded && encoded->pages.empty();
    refused = refused || !encoded;
    if (!encoded) continue;
    count_coded(*encoded, reports[i]);
    if (!reports[i].nothing_changed) draft.edits.push_back({at, *std::move(encoded)});
  }
  if (refused) return std::nullopt;
  draft.roots = edits.front().base().store().roots(tip);
  return draft;
}

std::optional<VersionId> publish_unmerged(const PendingEdit& edit, VersionId merged, const CommitOptions& options) {
  const Snapshot::Impl& base = edit.base();
  if (!common(charts_other_than(edit.parts, base.pages(), {}), edit.changes.touched).empty()) return std::nullopt;
  EncodedEdit encoded = encode_on(base, edit, options);
  if (encoded.pages.empty() || !encoded.pages.removed.empty() || has_new_ids(base.record(), encoded.record))
    return std::nullopt;
  share_blobs(encoded, base, merged);
  return publish_nameless(base, std::move(encoded), options);
}

void publish_on_tip(const Snapshot::Impl& base, const CommitOptions& options, std::string_view operation,
                    const std::string& attempt,
                    const std::function<std::optional<EncodedEdit>(const Snapshot::Impl& tip)>& encode,
                    CommitReport& report) {
  const auto make = [&](VersionId tip) -> std::optional<VersionDraft> {
    const auto at = mesh_on_branch(base, tip, options.branch);
    auto encoded = encode(*at);
    if (!encoded) return std::nullopt;
    count_coded(*encoded, report);
    VersionDraft draft;
    draft.edits.push_back({at, *std::move(encoded)});
    draft.roots = base.store().roots(tip);
    return draft;
  };
  publish_on_tip(base.store_handle(), base.version(), options, operation, attempt, make, report);
}

CommitReport commit_edits(std::span<const PendingEdit> edits, const CommitOptions& options,
                          const std::string& attempt) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<CommitReport> reports = reports_of(edits);
  CommitReport report = added_up(reports);
  const Snapshot::Impl& base = edits.front().base();
  const auto make = [&](VersionId tip) -> std::optional<VersionDraft> {
    auto draft = draft_of(edits, tip, options, reports);
    report = added_up(reports);
    if (!draft) return draft;
    report.nothing_changed = draft->edits.empty();
    report.revision = report.parent = tip;
    return report.nothing_changed ? std::nullopt : std::move(draft);
  };
  if (std::ranges::all_of(edits, [](const PendingEdit& edit) { return edit.changes.empty(); })) {
    report.nothing_changed = true;
    report.revision = report.parent = base.version();
  } else if (const auto published = base.store().published_by(attempt)) {
    repeat_report(edits.front(), *published, report);
  } else {
    publish_on_tip(base.store_handle(), base.version(), options, edits.front().operation, attempt, make, report);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

CommitReport commit_edit(const PendingEdit& edit, const CommitOptions& options, const std::string& attempt) {
  return commit_edits(std::span(&edit, 1), options, attempt);
}

}  // namespace ramcdb::detail
