#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "db/store.h"
#include "ramcdb/snapshot.h"
#include "ramcdb/wire_net.h"

namespace ramcdb::detail {

/// Charts per leaf page at import, and pages per inner page: four levels hold 8 million charts, 42 G faces.
inline constexpr std::size_t kLeafCharts = 32;
inline constexpr std::size_t kInnerPages = 64;

/// A page by its key, decoded.
struct LeafRef {
  PageId id;
  VersionId version;
  std::shared_ptr<const LeafPage> leaf;
};

/// The tree of index pages of one mesh at one version, read as needed and kept. Thread-safe.
class PageIndex {
 public:
  PageIndex(std::shared_ptr<db::Store> store, db::MeshRoot root) : store_(std::move(store)), root_(std::move(root)) {}

  [[nodiscard]] const db::MeshRoot& root() const { return root_; }

  struct Loaded {
    std::shared_ptr<const Page> page;
    std::uint64_t bytes = 0;  ///< of its blob, checksum included
  };
  [[nodiscard]] Loaded page(PageId id, VersionId version, ReadCost* cost = nullptr) const;

  /// The leaf that holds a chart; empty when no page does.
  [[nodiscard]] std::optional<LeafRef> leaf_of(ChartId chart, ReadCost* cost = nullptr) const;

  /// Calls `leaf` for every leaf that is reached through boxes which `wanted` accepts, in tree order.
  void visit(const std::function<bool(const LatticeBox&)>& wanted, const std::function<void(const LeafRef&)>& leaf,
             ReadCost* cost = nullptr) const;

  /// The ids of all charts, ascending.
  [[nodiscard]] std::vector<ChartId> all_charts() const;

  /// The exact box of the whole mesh.
  [[nodiscard]] LatticeBox box() const;

 private:
  std::shared_ptr<db::Store> store_;
  db::MeshRoot root_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<PageId, VersionId>, Loaded> cache_;
};

/// The versions of all blobs of a chart: equal when nothing of it differs.
using ChartState = std::vector<VersionId>;
[[nodiscard]] ChartState state_of(const PageChart& chart);

/// Members of a leaf by id; null when it has none of that id.
[[nodiscard]] const PageChart* find_chart(const LeafPage& leaf, ChartId id);
[[nodiscard]] const PageWire* find_wire(const LeafPage& leaf, WireId id);
[[nodiscard]] const PageCorner* find_corner(const LeafPage& leaf, CornerId id);

/// Whether any of `runs` holds `chart`.
[[nodiscard]] bool holds(std::span<const ChartRun> runs, ChartId chart);

/// What an inner page says of the page below it.
[[nodiscard]] PageEntry entry_for(const Page& page, PageId id, VersionId version);

}  // namespace ramcdb::detail
