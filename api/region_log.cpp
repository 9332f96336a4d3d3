#include "api/region_log.h"

#include <algorithm>

#include "api/region_query.h"

namespace ramcdb::detail {

RegionLog::RegionLog(const Snapshot::Impl& at, const Region& region) : at_(at), region_(region) {
  const auto add_charts_of = [&](const Region& part) {
    for (const ChartId id : find_charts(at, part, nullptr)) named_.insert(id);
  };
  for (const RegionShape& shape : region.shapes) {
    if (const auto* charts = std::get_if<OfCharts>(&shape))
      named_.insert(charts->charts.begin(), charts->charts.end());  // those that are gone, too
    else if (std::holds_alternative<NearestTo>(shape))
      add_charts_of({{shape}, 0});
    else if (std::holds_alternative<WholeMesh>(shape))
      everything_ = true;
    else
      any_box_ = true;
  }
  if (region.grow > 0 && !everything_) add_charts_of(region);
}

bool RegionLog::touched_by(const db::VersionInfo& version) {
  const MeshId mesh = at_.root().mesh;
  bool touched = false;
  for (const db::ChangedCharts& changed : at_.store().changed(version.id)) {
    if (changed.mesh != mesh || touched) continue;
    touched = everything_ || std::any_of(changed.charts.begin(), changed.charts.end(),
                                         [&](ChartId id) { return named_.contains(id); });
    if (touched || !any_box_ || changed.charts.empty()) continue;
    std::vector<const PageIndex*> states{pages_of(version.id)};
    for (const VersionId parent : version.parents) states.push_back(pages_of(parent));
    for (const PageIndex* pages : states)
      touched = touched || std::any_of(changed.charts.begin(), changed.charts.end(),
                                       [&](ChartId id) { return meets_region(pages, id); });
  }
  pages_.erase(pages_.lower_bound(version.id), pages_.end());
  return touched;
}

bool RegionLog::meets_region(const PageIndex* pages, ChartId chart) const {
  const auto leaf = pages ? pages->leaf_of(chart) : std::nullopt;
  if (!leaf) return false;
  const LatticeBox& box = find_chart(*leaf->leaf, chart)->box;
  return std::any_of(region_.shapes.begin(), region_.shapes.end(),
                     [&](const RegionShape& shape) { return meets_shape(at_.record(), box, shape); });
}

const PageIndex* RegionLog::pages_of(VersionId version) {
  std::unique_ptr<PageIndex>& pages = pages_[version];
  if (!pages)
    for (const db::MeshRoot& root : at_.store().roots(version))
      if (root.mesh == at_.root().mesh) pages = std::make_unique<PageIndex>(at_.store_handle(), root);
  return pages.get();
}

}  // namespace ramcdb::detail
