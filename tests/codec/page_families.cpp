#include "tests/codec/page_families.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>

namespace ramcdb::codec::testing {

namespace {

constexpr std::uint32_t kLargest = std::numeric_limits<std::uint32_t>::max();
constexpr std::int32_t kFar = kMaxLatticeCoordinate;

/// Collects charts; wires and corners come along as loops name them.
class PageMaker {
 public:
  void corner(std::uint32_t id, LatticePoint p) { corners_[CornerId(id)] = p; }
  void wire(std::uint32_t id, std::uint32_t begin, std::uint32_t end, std::uint32_t inner, std::uint32_t version = 1) {
    const WireId group(inner ? std::max<std::uint32_t>(1, id - id % 5) : id);
    wires_[WireId(id)] = {WireId(id), VersionId(version), group, CornerId(begin), CornerId(end), inner, {}};
  }
  /// Loops as wire ids, negative when passed backwards.
  PageChart& chart(std::uint32_t id, const std::vector<std::vector<std::int64_t>>& loops) {
    PageChart chart;
    chart.id = ChartId(id);
    chart.version = VersionId(1);
    chart.faces = 100;
    for (const auto& loop : loops) {
      chart.loops.emplace_back();
      for (const std::int64_t step : loop) {
        PageWire& wire = wires_.at(WireId(static_cast<std::uint32_t>(std::abs(step))));
        chart.loops.back().push_back({wire.id, step < 0});
        wire.charts.push_back(chart.id);
        chart.box.add(corners_.at(wire.begin));
        chart.box.add(corners_.at(wire.end));
      }
    }
    chart.pieces = {std::vector<std::uint32_t>(loops.size(), 0), loops.empty()};
    page_.charts.push_back(chart);
    return page_.charts.back();
  }
  void also_passed_by(std::uint32_t wire, std::uint32_t chart) {
    wires_.at(WireId(wire)).charts.push_back(ChartId(chart));
  }

  /// The page, with the wires that its charts pass and the corners that those end in.
  LeafPage page() {
    std::map<CornerId, LatticePoint> used;
    for (auto& [id, wire] : wires_) {
      const bool passed = std::any_of(wire.charts.begin(), wire.charts.end(), [&](ChartId c) {
        return std::any_of(page_.charts.begin(), page_.charts.end(), [&](const PageChart& p) { return p.id == c; });
      });
      if (!passed) continue;
      std::sort(wire.charts.begin(), wire.charts.end());
      page_.wires.push_back(wire);
      for (const CornerId c : {wire.begin, wire.end}) used[c] = corners_.at(c);
    }
    for (const auto& [id, p] : used) page_.corners.push_back({id, p});
    std::sort(page_.charts.begin(), page_.charts.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return page_;
  }

 private:
  LeafPage page_;
  std::map<CornerId, LatticePoint> corners_;
  std::map<WireId, PageWire> wires_;
};

/// Closed wires, wires passed twice, several loops, a chart without any.
LeafPage odd_page() {
  PageMaker maker;
  maker.corner(1, {5, 5, 5});
  maker.corner(2, {9, -5, 0});
  maker.corner(70, {0, 0, 0});
  maker.wire(1, 1, 1, 12, 3);
  maker.wire(2, 1, 2, 0, 900);
  maker.wire(3, 1, 2, 7);
  maker.wire(9, 70, 70, 2);
  maker.wire(kLargest, 70, 2, 4);
  maker.chart(4, {{1}, {9}}).layers = {{0, VersionId(2)}, {7, VersionId(1)}, {65535, VersionId(800)}};
  maker.chart(5, {{2, -3}, {-1}, {-9}}).pieces = {{0, 1, 0}, 3};
  maker.chart(6, {{2, -2}});  // a slit
  maker.chart(7, {{2, -3, 2, -std::int64_t{kLargest}, 9, kLargest, -3}}).inner_vertices = 3;
  maker.chart(8, {}).box = {{-1, -2, -3}, {4, 5, 6}};
  PageChart& hollow = maker.chart(9, {});
  hollow.faces = hollow.pieces.closed = 0;
  maker.also_passed_by(3, 1);
  maker.also_passed_by(3, 1);
  maker.also_passed_by(3, kLargest);
  return maker.page();
}

LeafPage extreme_page() {
  PageMaker maker;
  maker.corner(1, {kFar, kFar, kFar});
  maker.corner(kLargest, {-kFar, -kFar, -kFar});
  maker.wire(kLargest, 1, kLargest, kLargest, kLargest);
  maker.wire(kLargest - 1, kLargest, 1, 0, 0);
  PageChart& chart =
      maker.chart(kLargest, {{kLargest, kLargest - 1}, {-(std::int64_t{kLargest} - 1), -std::int64_t{kLargest}}});
  chart.version = VersionId(kLargest);
  chart.table = TableId(kLargest);
  chart.faces = kLargest;
  chart.inner_vertices = kLargest;
  chart.layers = {{65535, VersionId(0)}};
  chart.pieces = {{0, 1}, kLargest - 2};
  PageChart& small = maker.chart(1, {});
  small.version = VersionId(0);
  small.faces = 1u << 31;
  small.box = {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  return maker.page();
}

/// A corner with more wires than are ranked.
LeafPage crowded_page(std::uint32_t petals) {
  PageMaker maker;
  maker.corner(1, {0, 0, 0});
  for (std::uint32_t i = 0; i < petals; ++i) {
    maker.corner(i + 2, {static_cast<std::int32_t>(i), 3, 4});
    maker.wire(i + 1, 1, i + 2, 0);
  }
  for (std::uint32_t i = 0; i < petals; ++i)
    maker.chart(i + 1, {{i + 1, -std::int64_t{i + 1}, (i + 1) % petals + 1, -std::int64_t{(i + 1) % petals + 1}}});
  return maker.page();
}

InnerPage inner_page(std::uint32_t seed, int entries) {
  std::mt19937 random(seed);
  const auto number = [&](std::uint32_t below) { return static_cast<std::uint32_t>(random() % below); };
  InnerPage page;
  for (int i = 0; i < entries; ++i) {
    PageEntry entry;
    entry.id = PageId(seed % 2 ? static_cast<std::uint32_t>(i) + 1 : number(kLargest) + 1);
    entry.version = VersionId(number(30));
    entry.faces = std::uint64_t{number(5)} << (number(2) * 31) | number(200000);
    if (number(9) > 0) {
      entry.box.add(LatticePoint{static_cast<std::int32_t>(number(5000)), -7, static_cast<std::int32_t>(number(5000))});
      entry.box.add(LatticePoint{-static_cast<std::int32_t>(number(5000)), 9, 0});
    }
    std::uint64_t first = 1;
    for (std::uint32_t runs = number(4); runs > 0; --runs) {
      first += number(1000);
      const std::uint32_t count = 1 + number(40);
      entry.charts.push_back({ChartId(static_cast<std::uint32_t>(first)), count});
      first += count + 1;
    }
    page.pages.push_back(entry);
  }
  return page;
}

InnerPage extreme_inner_page() {
  InnerPage page;
  page.pages.push_back({PageId(kLargest),
                        VersionId(kLargest),
                        {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}},
                        std::numeric_limits<std::uint64_t>::max(),
                        {{ChartId(1), kLargest}}});
  page.pages.push_back(
      {PageId(1), VersionId(0), {{kFar, kFar, kFar}, {kFar, kFar, kFar}}, 0, {{ChartId(kLargest), 1}}});
  page.pages.push_back({PageId(kLargest / 2), VersionId(5), {}, 1, {}});
  return page;
}

}  // namespace

LeafPage quad_page(int side, int charts, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&](std::uint32_t below) { return static_cast<std::uint32_t>(random() % below); };
  const auto cell = [&](int x, int y) {
    return static_cast<std::uint32_t>((y + side) % side * side + (x + side) % side);
  };
  // Ids count up along the rows, with a gap now and then.
  std::vector<std::uint32_t> chart_ids, wire_ids;
  for (int i = 0; i < side * side; ++i)
    chart_ids.push_back((chart_ids.empty() ? 0 : chart_ids.back()) + 1 + (number(8) == 0 ? number(100) : 0));
  for (int i = 0; i < 2 * side * side; ++i)
    wire_ids.push_back((wire_ids.empty() ? 0 : wire_ids.back()) + 1 + (number(8) == 0 ? number(100) : 0));
  PageMaker maker;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto jitter = [&] { return static_cast<std::int32_t>(number(300)); };
      maker.corner(1 + cell(x, y), {1000 * x + jitter(), 1000 * y + jitter(), jitter()});
    }
  const auto along = [&](int x, int y) { return wire_ids[2 * cell(x, y)]; };       // to (x + 1, y)
  const auto across = [&](int x, int y) { return wire_ids[2 * cell(x, y) + 1]; };  // to (x, y + 1)
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      maker.wire(along(x, y), 1 + cell(x, y), 1 + cell(x + 1, y), number(40), 1 + number(3));
      maker.wire(across(x, y), 1 + cell(x, y), 1 + cell(x, y + 1), number(40), 1 + number(3));
    }
  const std::uint32_t first = number(static_cast<std::uint32_t>(side * side - charts + 1));
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(side * side); ++i) {
    const int x = static_cast<int>(i) % side, y = static_cast<int>(i) / side;
    if (i >= first && i < first + static_cast<std::uint32_t>(charts)) {
      PageChart& chart = maker.chart(
          chart_ids[i], {{along(x, y), across(x + 1, y), -std::int64_t{along(x, y + 1)}, -std::int64_t{across(x, y)}}});
      chart.version = VersionId(1 + number(3));
      chart.faces = 4000 + number(2000);
      chart.inner_vertices = chart.faces / 2 - number(100);
      chart.box.hi.z += static_cast<std::int32_t>(number(200));
      chart.box.lo.x -= static_cast<std::int32_t>(number(50));
      if (number(3) == 0) chart.layers.push_back({static_cast<std::uint16_t>(number(3)), VersionId(number(4))});
    } else {
      for (const std::uint32_t w : {along(x, y), across(x + 1, y), along(x, y + 1), across(x, y)})
        maker.also_passed_by(w, chart_ids[i]);
    }
  }
  return maker.page();
}

std::vector<NamedPage> pages() {
  std::vector<NamedPage> all{
      {"empty leaf", LeafPage{}},
      {"empty inner page", InnerPage{}},
      {"odd leaf", odd_page()},
      {"extreme leaf", extreme_page()},
      {"10 petals", crowded_page(10)},
      {"100 petals", crowded_page(100)},
      {"extreme inner page", extreme_inner_page()},
      {"whole torus", quad_page(6, 36, 3)},
  };
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    all.push_back({"leaf " + std::to_string(seed), quad_page(8, static_cast<int>(1 + seed % 32), seed)});
    all.push_back({"inner page " + std::to_string(seed), inner_page(seed, static_cast<int>(seed))});
  }
  return all;
}

}  // namespace ramcdb::codec::testing
