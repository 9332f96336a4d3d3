#include "api/page_index.h"

#include <algorithm>
#include <string>

#include "api/store_format.h"
#include "codec/page_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

template <class Item, class IdType>
const Item* find_by_id(const std::vector<Item>& items, IdType id) {
  const auto it =
      std::lower_bound(items.begin(), items.end(), id, [](const Item& item, IdType i) { return item.id < i; });
  return it != items.end() && it->id == id ? &*it : nullptr;
}

void append_run(std::vector<ChartRun>& runs, ChartRun run) {
  if (!runs.empty() && runs.back().first.value + runs.back().count == run.first.value)
    runs.back().count += run.count;
  else
    runs.push_back(run);
}

PageEntry leaf_entry(const LeafPage& leaf) {
  PageEntry entry;
  for (const PageChart& chart : leaf.charts) {
    entry.box.add(chart.box);
    entry.faces += chart.faces;
    append_run(entry.charts, {chart.id, 1});
  }
  return entry;
}

PageEntry inner_entry(const InnerPage& inner) {
  PageEntry entry;
  std::vector<ChartRun> runs;
  for (const PageEntry& child : inner.pages) {
    entry.box.add(child.box);
    entry.faces += child.faces;
    runs.insert(runs.end(), child.charts.begin(), child.charts.end());
  }
  std::sort(runs.begin(), runs.end(), [](const ChartRun& a, const ChartRun& b) { return a.first < b.first; });
  for (const ChartRun& run : runs) append_run(entry.charts, run);
  return entry;
}

}  // namespace

const PageChart* find_chart(const LeafPage& leaf, ChartId id) { return find_by_id(leaf.charts, id); }
const PageWire* find_wire(const LeafPage& leaf, WireId id) { return find_by_id(leaf.wires, id); }
const PageCorner* find_corner(const LeafPage& leaf, CornerId id) { return find_by_id(leaf.corners, id); }

bool holds(std::span<const ChartRun> runs, ChartId chart) {
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), chart, [](ChartId c, const ChartRun& run) { return c < run.first; });
  return after != runs.begin() && chart.value - std::prev(after)->first.value < std::prev(after)->count;
}

PageEntry entry_for(const Page& page, PageId id, VersionId version) {
  PageEntry entry = std::holds_alternative<LeafPage>(page) ? leaf_entry(std::get<LeafPage>(page))
                                                           : inner_entry(std::get<InnerPage>(page));
  entry.id = id;
  entry.version = version;
  return entry;
}

PageIndex::Loaded PageIndex::page(PageId id, VersionId version, ReadCost* cost) const {
  {
    const std::lock_guard lock(mutex_);
    if (const auto it = cache_.find({id, version}); it != cache_.end()) return it->second;
  }
  const Buffer blob = store_->reader()->get({db::Kind::page, root_.mesh, id.value, version, 0});
  Loaded loaded{std::make_shared<const Page>(codec::decode_page(blob)), blob.size() + kBlobOverhead};
  if (cost) {
    ++cost->blobs;
    ++cost->pages;
    cost->bytes += loaded.bytes;
  }
  const std::lock_guard lock(mutex_);
  return cache_.emplace(std::pair{id, version}, loaded).first->second;
}

std::optional<LeafRef> PageIndex::leaf_of(ChartId chart, ReadCost* cost) const {
  PageId id = root_.root_page;
  VersionId version = root_.root_version;
  for (int depth = 0; depth < kMaxPageDepth; ++depth) {
    const auto loaded = page(id, version, cost);
    if (std::holds_alternative<LeafPage>(*loaded.page)) {
      std::shared_ptr<const LeafPage> leaf(loaded.page, &std::get<LeafPage>(*loaded.page));
      if (!find_chart(*leaf, chart)) return std::nullopt;
      return LeafRef{id, version, std::move(leaf)};
    }
    const auto& children = std::get<InnerPage>(*loaded.page).pages;
    const auto child =
        std::find_if(children.begin(), children.end(), [&](const PageEntry& e) { return holds(e.charts, chart); });
    if (child == children.end()) return std::nullopt;
    id = child->id;
    version = child->version;
  }
  throw Error(Errc::corrupt, "the index pages form a cycle or are too deep", root_.name, "run `ramcdb verify`");
}

void PageIndex::visit(const std::function<bool(const LatticeBox&)>& wanted,
                      const std::function<void(const LeafRef&)>& leaf, ReadCost* cost) const {
  struct Step {
    PageId id;
    VersionId version;
    int depth;
  };
  std::vector<Step> todo{{root_.root_page, root_.root_version, 0}};
  while (!todo.empty()) {
    const Step step = todo.back();
    todo.pop_back();
    if (step.depth >= kMaxPageDepth)
      throw Error(Errc::corrupt, "the index pages form a cycle or are too deep", root_.name, "run `ramcdb verify`");
    const auto loaded = page(step.id, step.version, cost);
    if (const auto* inner = std::get_if<InnerPage>(&*loaded.page)) {
      for (auto child = inner->pages.rbegin(); child != inner->pages.rend(); ++child)
        if (wanted(child->box)) todo.push_back({child->id, child->version, step.depth + 1});
    } else {
      leaf({step.id, step.version, {loaded.page, &std::get<LeafPage>(*loaded.page)}});
    }
  }
}

std::vector<ChartId> PageIndex::all_charts() const {
  std::vector<ChartId> ids;
  visit([](const LatticeBox&) { return true; },
        [&](const LeafRef& ref) {
          for (const PageChart& chart : ref.leaf->charts) ids.push_back(chart.id);
        });
  std::sort(ids.begin(), ids.end());
  return ids;
}

LatticeBox PageIndex::box() const {
  return entry_for(*page(root_.root_page, root_.root_version).page, root_.root_page, root_.root_version).box;
}

ChartState state_of(const PageChart& chart) {
  ChartState state{chart.version};
  for (const LayerRef& layer : chart.layers) state.push_back(layer.version);
  return state;
}

}  // namespace ramcdb::detail
