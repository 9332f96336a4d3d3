#include "api/edit_on_tip.h"

#include <algorithm>
#include <functional>

#include "api/chart_difference.h"
#include "api/locks.h"
#include "api/region_query.h"
#include "api/same_values.h"
#include "api/three_way.h"

namespace ramcdb::detail {
namespace {

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
  return mesh.points[v] == region.points[source] &&
         (region.exact.empty() || same_bits(mesh.exact[v], region.exact[source])) &&
         same_values(AttributeOf::vertex, mesh.attributes, v, region.attributes, source);
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

}  // namespace

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

std::optional<EncodedEdit> encode_or_merge(const Snapshot::Impl& tip, const PendingEdit& edit,
                                           const CommitOptions& options, CommitReport& report) {
  report.conflict_places.clear();
  report.merged = false;
  report.conflicts = common(charts_other_than(edit.parts, tip.pages()), edit.changes.touched);
  if (report.conflicts.empty()) return encode_on(tip, edit, options);
  return merge_on(tip, edit, options, report);
}

}  // namespace ramcdb::detail
