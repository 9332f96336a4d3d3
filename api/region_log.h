#pragma once

#include <map>
#include <memory>
#include <set>

#include "api/page_index.h"
#include "api/snapshot_impl.h"
#include "ramcdb/region.h"

namespace ramcdb::detail {

/// Tells which versions of a mesh touched a place, reading index pages only, and of them only those above charts that a
/// version changed. To be asked from new to old, so that pages that neighbouring versions share are read once.
class RegionLog {
 public:
  /// A changed chart counts when its box before or after meets a shape of the region, or when it is one of the charts
  /// that the region names: by --charts, and as of `at` those nearest to a point and within --grow.
  RegionLog(const Snapshot::Impl& at, const Region& region);

  [[nodiscard]] bool touched_by(const db::VersionInfo& version);

 private:
  [[nodiscard]] bool meets_region(const PageIndex* pages, ChartId chart) const;
  /// Null where the version does not hold the mesh.
  [[nodiscard]] const PageIndex* pages_of(VersionId version);

  const Snapshot::Impl& at_;
  Region region_;
  std::set<ChartId> named_;
  bool everything_ = false, any_box_ = false;
  std::map<VersionId, std::unique_ptr<PageIndex>> pages_;
};

}  // namespace ramcdb::detail
