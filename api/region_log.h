#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "api/snapshot_impl.h"
#include "ramcdb/region.h"
#include "ramcdb/wire_net.h"

namespace ramcdb::detail {

/// Tells which versions of a mesh touched a place. Reads index pages only, and of them only those that hold changed
/// charts and meet the region. To be asked from new to old: pages that versions share are read once, and are kept only
/// as long as an older version may hold them.
class RegionLog {
 public:
  /// A changed chart counts when its box before or after meets a shape of the region, or when it is one of the charts
  /// that the region names: by --charts, and as of `at` those nearest to a point and within --grow.
  RegionLog(const Snapshot::Impl& at, const Region& region);

  [[nodiscard]] bool touched_by(const db::VersionInfo& version);

 private:
  /// Whether one of `changed` (ascending) meets the region as `version` holds it.
  [[nodiscard]] bool meets_at(VersionId version, const std::vector<ChartId>& changed);
  [[nodiscard]] bool meets_below(PageId id, VersionId version, const std::vector<ChartId>& changed, int depth);
  [[nodiscard]] bool meets_region(const LatticeBox& box) const;
  [[nodiscard]] std::shared_ptr<const Page> page(PageId id, VersionId version);
  /// Nothing where the version does not hold the mesh.
  [[nodiscard]] const std::optional<db::MeshRoot>& root_at(VersionId version);

  const Snapshot::Impl& at_;
  std::unique_ptr<db::BlobReader> reader_;
  std::vector<RegionShape> boxes_;  ///< the shapes that charts may meet
  std::set<ChartId> named_;
  bool everything_ = false;
  std::map<VersionId, std::optional<db::MeshRoot>> roots_;
  std::map<std::pair<VersionId, PageId>, std::shared_ptr<const Page>> pages_;
};

}  // namespace ramcdb::detail
