#include "api/chart_difference.h"

#include <algorithm>
#include <set>

namespace ramcdb::detail {
namespace {

using PageKey = std::pair<PageId, VersionId>;

/// Pages of one level of a tree, and the leaves found on the way.
struct PageFront {
  const PageIndex& index;
  std::set<PageKey> pages = {};
  std::map<ChartId, ChartState> charts = {};  ///< of leaves that the other version does not share

  ReadCost* cost;

  PageFront(const PageIndex& tree, ReadCost* read) : index(tree), cost(read) {
    pages.insert({tree.root().root_page, tree.root().root_version});
  }

  void open_all() {
    std::set<PageKey> below;
    for (const auto& [id, version] : pages) {
      const auto loaded = index.page(id, version, cost);
      if (const auto* inner = std::get_if<InnerPage>(&*loaded.page))
        for (const PageEntry& e : inner->pages) below.insert({e.id, e.version});
      else
        for (const PageChart& c : std::get<LeafPage>(*loaded.page).charts) charts.emplace(c.id, state_of(c));
    }
    pages = std::move(below);
  }
};

void drop_shared(PageFront& a, PageFront& b) {
  std::set<PageKey> only_a, only_b;
  std::ranges::set_difference(a.pages, b.pages, std::inserter(only_a, only_a.end()));
  std::ranges::set_difference(b.pages, a.pages, std::inserter(only_b, only_b.end()));
  a.pages = std::move(only_a);
  b.pages = std::move(only_b);
}

}  // namespace

ChartDifference chart_difference(const PageIndex& from, const PageIndex& to, ReadCost* cost) {
  PageFront a(from, cost), b(to, cost);
  for (drop_shared(a, b); !a.pages.empty() || !b.pages.empty(); drop_shared(a, b)) {
    a.open_all();
    b.open_all();
  }
  // Trees of different heights meet shared leaves on different levels: a chart that one side alone has opened is asked
  // for on the other.
  const auto state_at = [](const PageFront& front, ChartId id) {
    if (const auto it = front.charts.find(id); it != front.charts.end()) return it->second;
    const auto ref = front.index.leaf_of(id);
    return ref ? state_of(*find_chart(*ref->leaf, id)) : ChartState{};
  };
  ChartDifference changes;
  for (const auto& [id, state] : a.charts) {
    const ChartState now = state_at(b, id);
    if (now.empty()) changes.removed.push_back(id);
    if (!now.empty() && now != state) changes.changed.push_back(id);
  }
  for (const auto& [id, state] : b.charts)
    if (!a.charts.contains(id) && state_at(a, id).empty()) changes.added.push_back(id);
  return changes;
}

}  // namespace ramcdb::detail
