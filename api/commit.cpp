#include "api/commit.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <chrono>

#include "api/edit_on_tip.h"

namespace ramcdb::detail {
namespace {

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
  if (!common(charts_other_than(edit.parts, base.pages()), edit.changes.touched).empty()) return std::nullopt;
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
