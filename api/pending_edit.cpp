#include "api/pending_edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/chart_difference.h"
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

const Snapshot::Impl& newest(std::span<const RegionPart> parts) {
  return *std::max_element(parts.begin(), parts.end(), [](const RegionPart& a, const RegionPart& b) {
            return a.at->version() < b.at->version();
          })->at;
}

}  // namespace

std::vector<ChartId> charts_other_than(std::span<const RegionPart> parts, const PageIndex& there) {
  return charts_other_than(parts, there, {});
}

std::vector<ChartId> charts_as_in(std::span<const RegionPart> parts, const PageIndex& there) {
  std::vector<ChartId> equal;
  for (const RegionPart& part : parts)
    for (const ChartId id : part.charts)
      if (state_in(part.at->pages(), id) == state_in(there, id)) equal.push_back(id);
  std::sort(equal.begin(), equal.end());
  return equal;
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

const Snapshot::Impl& PendingEdit::base() const { return newest(parts); }

void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch) {
  const Snapshot::Impl& base = newest(parts);
  report.base = base.version();
  report.tip = base.store().tip(branch);
  report.changed_by_others = charts_other_than(parts, index_at(base, report.tip));
  report.conflicts = common(report.changed_by_others, {report.charts_touched.begin(), report.charts_touched.end()});
}

std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version) {
  return charts_other_than(parts, index_at(newest(parts), version), version);
}

}  // namespace ramcdb::detail
