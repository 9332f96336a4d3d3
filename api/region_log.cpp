#include "api/region_log.h"

#include <algorithm>

#include "api/page_index.h"
#include "api/region_query.h"
#include "api/store_format.h"
#include "codec/page_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {

RegionLog::RegionLog(const Snapshot::Impl& at, const Region& region) : at_(at), reader_(at.store().reader()) {
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
      boxes_.push_back(shape);
  }
  if (region.grow > 0 && !everything_) add_charts_of(region);
}

bool RegionLog::touched_by(const db::VersionInfo& version) {
  reader_->renew();
  bool touched = false;
  for (const db::ChangedCharts& changed : at_.store().changed(version.id)) {
    if (changed.mesh != at_.root().mesh) continue;
    const std::vector<ChartId>& charts = changed.charts;
    touched = touched || everything_ ||
              std::any_of(charts.begin(), charts.end(), [&](ChartId id) { return named_.contains(id); }) ||
              meets_at(version.id, charts) ||
              std::any_of(version.parents.begin(), version.parents.end(),
                          [&](VersionId parent) { return meets_at(parent, charts); });
  }
  roots_.erase(roots_.lower_bound(version.id), roots_.end());
  pages_.erase(pages_.lower_bound({version.id, PageId()}), pages_.end());
  return touched;
}

bool RegionLog::meets_at(VersionId version, const std::vector<ChartId>& changed) {
  if (boxes_.empty() || changed.empty()) return false;
  const auto& root = root_at(version);
  return root && meets_below(root->root_page, root->root_version, changed, 0);
}

bool RegionLog::meets_below(PageId id, VersionId version, const std::vector<ChartId>& changed, int depth) {
  if (depth >= kMaxPageDepth)
    throw Error(Errc::corrupt, "the index pages form a cycle or are too deep", at_.root().name, "run `ramcdb verify`");
  const auto loaded = page(id, version);
  if (const auto* leaf = std::get_if<LeafPage>(&*loaded))
    return std::any_of(leaf->charts.begin(), leaf->charts.end(), [&](const PageChart& chart) {
      return std::binary_search(changed.begin(), changed.end(), chart.id) && meets_region(chart.box);
    });
  const std::vector<PageEntry>& children = std::get<InnerPage>(*loaded).pages;
  return std::any_of(children.begin(), children.end(), [&](const PageEntry& child) {
    return meets_region(child.box) &&
           std::any_of(changed.begin(), changed.end(), [&](ChartId chart) { return holds(child.charts, chart); }) &&
           meets_below(child.id, child.version, changed, depth + 1);
  });
}

bool RegionLog::meets_region(const LatticeBox& box) const {
  return std::any_of(boxes_.begin(), boxes_.end(),
                     [&](const RegionShape& shape) { return meets_shape(at_.record(), box, shape); });
}

std::shared_ptr<const Page> RegionLog::page(PageId id, VersionId version) {
  auto& kept = pages_[{version, id}];
  if (!kept)
    kept = std::make_shared<const Page>(
        codec::decode_page(reader_->get({db::Kind::page, at_.root().mesh, id.value, version, 0})));
  return kept;
}

const std::optional<db::MeshRoot>& RegionLog::root_at(VersionId version) {
  const auto [kept, is_new] = roots_.try_emplace(version);
  if (is_new)
    for (const db::MeshRoot& root : at_.store().roots(version))
      if (root.mesh == at_.root().mesh) kept->second = root;
  return kept->second;
}

}  // namespace ramcdb::detail
