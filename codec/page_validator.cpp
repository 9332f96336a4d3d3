#include <algorithm>
#include <map>
#include <string>

#include "codec/page_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::codec {
namespace {

class Validator {
 public:
  explicit Validator(std::string_view where) : where_(where) {}

  void check(const LeafPage& leaf) {
    check_ids(leaf.charts, "charts");
    check_ids(leaf.wires, "wires");
    check_ids(leaf.corners, "corners");
    for (const PageCorner& corner : leaf.corners) {
      require(on_lattice(corner.position), "a corner leaves the lattice");
      corners_.emplace(corner.id, &corner);
    }
    for (const PageWire& wire : leaf.wires) {
      require(corners_.contains(wire.begin) && corners_.contains(wire.end),
              "a wire ends in a corner that is not there");
      require(wire.group && (wire.inner_points || wire.group == wire.id), "a wire belongs to no group");
      require(std::is_sorted(wire.charts.begin(), wire.charts.end()), "the charts of a wire are out of order");
      corner_used_[wire.begin] = corner_used_[wire.end] = true;
      wires_.emplace(wire.id, &wire);
    }
    for (const PageChart& chart : leaf.charts) check(chart);
    check_passes(leaf);
    require(corner_used_.size() == corners_.size(), "a corner ends no wire");
  }

  void check(const InnerPage& inner) {
    for (const PageEntry& entry : inner.pages) {
      require(static_cast<bool>(entry.id), "an entry names no page");
      check(entry.box);
      std::uint64_t free_from = 1;
      for (const ChartRun run : entry.charts) {
        require(run.count > 0 && run.first.value >= free_from, "runs of charts are empty, out of order or touch");
        free_from = std::uint64_t{run.first.value} + run.count + 1;
        require(free_from <= (std::uint64_t{1} << 32) + 1, "a run of charts leaves the range of ids");
      }
    }
  }

 private:
  void require(bool holds, const char* what) const {
    if (!holds) throw Error(Errc::corrupt, std::string("index page: ") + what, where_, "run `ramcdb verify`");
  }

  template <class Items>
  void check_ids(const Items& items, const char* what) const {
    for (std::size_t i = 0; i < items.size(); ++i)
      require(items[i].id && (i == 0 || items[i - 1].id < items[i].id),
              (std::string(what) + " are out of order").c_str());
  }

  static bool on_lattice(LatticePoint p) {
    for (int a = 0; a < 3; ++a)
      if (p[a] < -kMaxLatticeCoordinate || p[a] > kMaxLatticeCoordinate) return false;
    return true;
  }

  /// A box is empty in one way only.
  void check(const LatticeBox& box) const {
    require(on_lattice(box.lo) && on_lattice(box.hi), "a box leaves the lattice");
    require(box == LatticeBox{} || (box.contains(box.lo) && box.contains(box.hi)), "a box is inside out");
  }

  void check(const PageChart& chart) {
    check(chart.box);
    for (std::size_t i = 1; i < chart.layers.size(); ++i)
      require(chart.layers[i - 1].layer < chart.layers[i].layer, "layers are out of order");
    for (const WireLoop& loop : chart.loops) {
      require(!loop.empty(), "a loop passes no wire");
      CornerId at = start_of(loop.front());
      for (const DirectedWire step : loop) {
        require(start_of(step) == at, "a loop has a gap");
        require(chart.box.contains(corners_.at(at)->position), "a box does not hold a corner of its chart");
        passes_[step.wire][chart.id] += 1;
        at = end_of(step);
      }
      require(at == start_of(loop.front()), "a loop does not close");
    }
    check_pieces(chart);
  }

  void check_pieces(const PageChart& chart) const {
    require(chart.pieces.of_loop.size() == chart.loops.size(), "a loop is of no piece");
    std::uint32_t pieces = 0;
    for (const std::uint32_t piece : chart.pieces.of_loop) {
      require(piece <= pieces, "pieces are not numbered by their loops");
      pieces += piece == pieces;
    }
    const std::uint64_t all = std::uint64_t{pieces} + chart.pieces.closed;
    require(all <= chart.faces && (all > 0) == (chart.faces > 0), "a chart has other faces than its pieces");
  }

  const PageWire& wire(WireId id) const {
    const auto it = wires_.find(id);
    require(it != wires_.end(), "a loop names a wire that is not there");
    return *it->second;
  }
  CornerId start_of(DirectedWire step) const { return step.reversed ? wire(step.wire).end : wire(step.wire).begin; }
  CornerId end_of(DirectedWire step) const { return step.reversed ? wire(step.wire).begin : wire(step.wire).end; }

  /// A wire names each chart of the page once per pass, and no other chart of the page.
  void check_passes(const LeafPage& leaf) const {
    for (const PageWire& wire : leaf.wires) {
      const auto passes = passes_.find(wire.id);
      require(passes != passes_.end(), "a wire borders no chart of the page");
      std::map<ChartId, std::size_t> named;
      for (const ChartId chart : wire.charts) {
        require(static_cast<bool>(chart), "a wire names no chart");
        if (has_chart(leaf, chart)) named[chart] += 1;
      }
      require(named == passes->second, "a wire and the loops do not agree on its charts");
    }
  }

  static bool has_chart(const LeafPage& leaf, ChartId id) {
    const auto it = std::lower_bound(leaf.charts.begin(), leaf.charts.end(), id,
                                     [](const PageChart& c, ChartId i) { return c.id < i; });
    return it != leaf.charts.end() && it->id == id;
  }

  std::string_view where_;
  std::map<CornerId, const PageCorner*> corners_;
  std::map<CornerId, bool> corner_used_;
  std::map<WireId, const PageWire*> wires_;
  std::map<WireId, std::map<ChartId, std::size_t>> passes_;
};

}  // namespace

void validate_page(const Page& page, std::string_view where) {
  Validator validator(where);
  std::visit([&](const auto& p) { validator.check(p); }, page);
}

}  // namespace ramcdb::codec
