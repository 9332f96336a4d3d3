#include "api/page_rewriter.h"

#include <algorithm>
#include <unordered_map>

#include "api/store_format.h"
#include "codec/page_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// All wires and corners of the leaves that a delta touches, as they will be.
class Members {
 public:
  Members(const PageIndex& tip, const PageDelta& delta, const std::set<ChartId>& touched, VersionId version) {
    for (const ChartId id : touched) add(*tip.leaf_of(id)->leaf);
    for (const auto& [id, wire] : delta.wires) {
      PageWire& put = wires_[id] = wire;
      if (!put.version) put.version = version;
    }
    for (const auto& [id, position] : delta.corners) corners_[id] = position;
  }

  [[nodiscard]] const PageWire& wire(WireId id) const {
    const auto it = wires_.find(id);
    if (it == wires_.end()) throw Error(Errc::corrupt, "a chart passes a wire that no index page holds");
    return it->second;
  }
  [[nodiscard]] PageCorner corner(CornerId id) const {
    const auto it = corners_.find(id);
    if (it == corners_.end()) throw Error(Errc::corrupt, "a wire ends in a corner that no index page holds");
    return {id, it->second};
  }

 private:
  void add(const LeafPage& leaf) {
    for (const PageWire& wire : leaf.wires) wires_.try_emplace(wire.id, wire);
    for (const PageCorner& corner : leaf.corners) corners_.try_emplace(corner.id, corner.position);
  }

  std::unordered_map<WireId, PageWire> wires_;
  std::unordered_map<CornerId, LatticePoint> corners_;
};

std::set<ChartId> touched_by(const PageDelta& delta) {
  std::set<ChartId> touched = delta.removed;
  touched.insert(delta.neighbours.begin(), delta.neighbours.end());
  for (const auto& [id, chart] : delta.charts)
    if (!delta.beside.contains(id)) touched.insert(id);
  for (const auto& [id, other] : delta.beside) touched.insert(other);
  return touched;
}

/// A page with its key; pages that are made new have no id yet.
struct NewPage {
  PageId id;
  Page page;
};

std::size_t size_of(const Page& page) {
  if (const auto* leaf = std::get_if<LeafPage>(&page)) return leaf->charts.size();
  return std::get<InnerPage>(page).pages.size();
}

std::size_t fill_of(const Page& page) { return std::holds_alternative<LeafPage>(page) ? kLeafCharts : kInnerPages; }

/// Twice the middle of a box along an axis.
std::int64_t middle(const LatticeBox& box, int axis) { return std::int64_t{box.lo[axis]} + std::int64_t{box.hi[axis]}; }

/// Puts items in order along the axis along which their boxes spread most.
template <class Item>
void sort_along(std::vector<Item>& items) {
  LatticeBox all;
  for (const Item& item : items) all.add(item.box);
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::int64_t{all.hi[axis]} - all.lo[axis] > std::int64_t{all.hi[longest]} - all.lo[longest]) longest = axis;
  std::sort(items.begin(), items.end(), [longest](const Item& a, const Item& b) {
    return std::pair(middle(a.box, longest), a.id) < std::pair(middle(b.box, longest), b.id);
  });
}

class Rewriter {
 public:
  Rewriter(const PageIndex& tip, const PageDelta& delta, db::Writer& writer, MeshRecord& record)
      : tip_(tip),
        delta_(delta),
        writer_(writer),
        record_(record),
        touched_(touched_by(delta)),
        members_(tip, delta, touched_, writer.version()) {
    for (const auto& [id, other] : delta.beside) new_at_[other].push_back(id);
  }

  PageEntry run() {
    const db::MeshRoot& before = tip_.root();
    if (delta_.empty()) return {before.root_page, before.root_version, {}, 0, {}};
    std::vector<NewPage> pages = rewrite(tip_.root().root_page, tip_.root().root_version, 0);
    if (pages.size() == 1 && std::holds_alternative<InnerPage>(pages.front().page) && size_of(pages.front().page) == 1)
      return std::get<InnerPage>(pages.front().page).pages.front();  // the tree gets lower
    while (pages.size() > 1) {
      InnerPage above;
      for (NewPage& page : pages) above.pages.push_back(put(std::move(page)));
      pages = split({PageId(), std::move(above)});
    }
    if (pages.empty()) throw Error(Errc::invalid_argument, "the edit would leave no chart of the mesh");
    return put(std::move(pages.front()));
  }

 private:
  [[nodiscard]] bool touches(const PageEntry& entry) const {
    return std::any_of(entry.charts.begin(), entry.charts.end(), [&](const ChartRun& run) {
      const auto first = touched_.lower_bound(run.first);
      return first != touched_.end() && first->value - run.first.value < run.count;
    });
  }

  /// What takes the place of a page: nothing, one or several pages, not put yet. Recursion is as deep as the tree: a
  /// few levels, bounded by PageIndex.
  std::vector<NewPage> rewrite(PageId id, VersionId version, int depth) {
    const auto loaded = tip_.page(id, version);
    record_.page_bytes -= loaded.bytes;
    if (const auto* leaf = std::get_if<LeafPage>(&*loaded.page)) return split({id, updated(*leaf)});
    if (depth >= kMaxPageDepth) throw Error(Errc::corrupt, "the index pages form a cycle or are too deep");
    InnerPage inner;
    std::vector<NewPage> small;
    for (const PageEntry& child : std::get<InnerPage>(*loaded.page).pages) {
      if (!touches(child)) {
        inner.pages.push_back(child);
        continue;
      }
      for (NewPage& page : rewrite(child.id, child.version, depth + 1))
        if (is_small(page.page))
          small.push_back(std::move(page));
        else
          inner.pages.push_back(put(std::move(page)));
    }
    for (NewPage& page : small) join(std::move(page), inner);
    return split({id, std::move(inner)});
  }

  static bool is_small(const Page& page) { return size_of(page) < fill_of(page) / 4; }

  /// Gives what a small page holds to a page near it that has room, or puts it as it is.
  void join(NewPage page, InnerPage& inner) {
    const std::size_t room = 2 * fill_of(page.page) - size_of(page.page);
    for (PageEntry* host : nearest_old(inner, entry_for(page.page, {}, {}).box)) {
      const auto loaded = tip_.page(host->id, host->version);
      if (size_of(*loaded.page) > room) continue;
      record_.page_bytes -= loaded.bytes;
      *host = put({host->id, joined(*loaded.page, std::move(page.page))});
      return;
    }
    inner.pages.push_back(put(std::move(page)));
  }

  /// The pages of the tip that lie closest to a box.
  std::vector<PageEntry*> nearest_old(InnerPage& inner, const LatticeBox& box) const {
    constexpr std::size_t kMost = 4;
    std::vector<std::pair<double, PageEntry*>> found;
    for (PageEntry& entry : inner.pages) {
      if (entry.version == writer_.version()) continue;
      double distance = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto apart = static_cast<double>(middle(entry.box, axis) - middle(box, axis));
        distance += apart * apart;
      }
      found.emplace_back(distance, &entry);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<PageEntry*> nearest;
    for (std::size_t i = 0; i < std::min(kMost, found.size()); ++i) nearest.push_back(found[i].second);
    return nearest;
  }

  Page joined(const Page& host, Page page) const {
    if (const auto* leaf = std::get_if<LeafPage>(&host)) {
      std::vector<PageChart> charts = leaf->charts;
      const LeafPage& more = std::get<LeafPage>(page);
      charts.insert(charts.end(), more.charts.begin(), more.charts.end());
      return leaf_of(std::move(charts), leaf);
    }
    InnerPage all = std::get<InnerPage>(host);
    const InnerPage& more = std::get<InnerPage>(page);
    all.pages.insert(all.pages.end(), more.pages.begin(), more.pages.end());
    return all;
  }

  LeafPage updated(const LeafPage& before) const {
    std::vector<PageChart> charts;
    for (const PageChart& chart : before.charts) {
      if (const auto put = delta_.charts.find(chart.id); put != delta_.charts.end())
        charts.push_back(versioned(put->second));
      else if (!delta_.removed.contains(chart.id))
        charts.push_back(chart);
      if (const auto added = new_at_.find(chart.id); added != new_at_.end())
        for (const ChartId id : added->second) charts.push_back(versioned(delta_.charts.at(id)));
    }
    return leaf_of(std::move(charts), nullptr);
  }

  [[nodiscard]] PageChart versioned(PageChart chart) const {
    if (!chart.version) chart.version = writer_.version();
    for (LayerRef& layer : chart.layers)
      if (!layer.version) layer.version = writer_.version();
    return chart;
  }

  /// A leaf of these charts, with the wires that they pass and their corners.
  /// \param before a leaf that holds wires which the delta does not know; may be null
  LeafPage leaf_of(std::vector<PageChart> charts, const LeafPage* before) const {
    LeafPage leaf;
    std::set<WireId> wires;
    std::set<CornerId> corners;
    std::sort(charts.begin(), charts.end(), [](const PageChart& a, const PageChart& b) { return a.id < b.id; });
    for (const PageChart& chart : charts)
      for (const WireLoop& loop : chart.loops)
        for (const DirectedWire step : loop) wires.insert(step.wire);
    for (const WireId id : wires) {
      const PageWire* known = before ? find_wire(*before, id) : nullptr;
      leaf.wires.push_back(known ? *known : members_.wire(id));
      corners.insert({leaf.wires.back().begin, leaf.wires.back().end});
    }
    for (const CornerId id : corners) {
      const PageCorner* known = before ? find_corner(*before, id) : nullptr;
      leaf.corners.push_back(known ? *known : members_.corner(id));
    }
    leaf.charts = std::move(charts);
    return leaf;
  }

  /// Cuts a page that holds too much into parts that lie apart; nothing is left of an empty one.
  std::vector<NewPage> split(NewPage page) const {
    const std::size_t size = size_of(page.page), fill = fill_of(page.page);
    std::vector<NewPage> parts;
    if (size == 0) return parts;
    if (size <= 2 * fill) {
      parts.push_back(std::move(page));
      return parts;
    }
    const std::size_t count = (size + fill - 1) / fill;
    const auto cut = [&](auto& items, auto&& make) {
      sort_along(items);
      for (std::size_t i = 0; i < count; ++i) {
        const auto first = items.begin() + static_cast<std::ptrdiff_t>(i * size / count);
        const auto last = items.begin() + static_cast<std::ptrdiff_t>((i + 1) * size / count);
        parts.push_back({i ? PageId() : page.id, make(std::vector(first, last))});
      }
    };
    if (auto* leaf = std::get_if<LeafPage>(&page.page))
      cut(leaf->charts, [&](std::vector<PageChart> charts) -> Page { return leaf_of(std::move(charts), leaf); });
    else
      cut(std::get<InnerPage>(page.page).pages,
          [](std::vector<PageEntry> pages) -> Page { return InnerPage{std::move(pages)}; });
    return parts;
  }

  PageEntry put(NewPage page) {
    if (!page.id) {
      page.id = record_.next_page;
      record_.next_page = PageId(record_.next_page.value + 1);
    }
    Buffer blob = codec::encode_page(page.page);
    record_.page_bytes += blob.size() + kBlobOverhead;
    writer_.put({db::Kind::page, tip_.root().mesh, page.id.value, {}, 0}, std::move(blob));
    return entry_for(page.page, page.id, writer_.version());
  }

  const PageIndex& tip_;
  const PageDelta& delta_;
  db::Writer& writer_;
  MeshRecord& record_;
  std::set<ChartId> touched_;
  Members members_;
  std::map<ChartId, std::vector<ChartId>> new_at_;
};

}  // namespace

db::MeshRoot rewrite_pages(const PageIndex& tip, const PageDelta& delta, db::Writer& writer, MeshRecord& record) {
  const PageEntry root = Rewriter(tip, delta, writer, record).run();
  db::MeshRoot moved = tip.root();
  moved.root_page = root.id;
  moved.root_version = root.version;
  moved.record_version = writer.version();
  return moved;
}

}  // namespace ramcdb::detail
