#include "codec/page_codec.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "codec/range_coder.h"
#include "ramcdb/error.h"

/// Page blob:
///   u8      format 1 in the upper half; 1 leaf page, 2 inner page in the lower
///   stream  range coder (range_coder.h)
///
/// Leaf page: newest version; number of charts; then chart by chart: id, version, table, loops, faces, inner vertices,
/// pieces, box, layers. Loops are walked: every step is a wire of the page that goes on from the corner reached, by its
/// rank among those (most recently met first), or the next new wire, which brings its id, version, inner points, group
/// and, unless the loop closes with it, its end corner. So a corner's id and position stand where it is first met, and
/// the second chart on a wire mostly costs a fraction of a bit for it. At last, wire by wire, the charts outside the
/// page.
///
/// Inner page: newest version; number of entries; entry by entry: id, version, box, faces, runs of charts.
///
/// Ids count up from the one before of their kind, versions down from the newest, numbers are differences from the
/// chart or entry before; inner vertices differ from Euler's (faces - border) / 2 + 1, boxes from the box of the
/// corners.
namespace ramcdb::codec {
namespace {

constexpr std::uint8_t kPageFormat = 1, kLeaf = 1, kInner = 2;

// What a page may hold at most: far over what any writer makes, and small enough that hostile bytes cost little.
constexpr std::uint32_t kMostCharts = 1 << 13, kMostSteps = 1 << 19, kMostEntries = 1 << 13, kMostRuns = 1 << 18,
                        kMostLayers = 1 << 12;
/// Up to so many wires at a corner are ranked; a crowd is told by position, so that no page takes quadratic time.
constexpr std::size_t kMostRanked = 64;

[[noreturn]] void corrupt(const char* what) {
  throw Error(Errc::corrupt, std::string("page blob: ") + what, {}, "run `ramcdb verify`");
}

/// Numbers that any page needs, with a model for each.
template <class Coder>
class Fields {
 public:
  explicit Fields(Coder& c) : coder(c) {}

  std::uint32_t count(AdaptiveUnsigned& model, std::size_t value, std::uint32_t most) {
    const std::uint32_t n = model.code(coder, static_cast<std::uint32_t>(value));
    if (n > most) corrupt("a count is over its limit");
    return n;
  }

  /// `value` as a difference from `expected`, modulo 2^32.
  std::uint32_t near(AdaptiveSigned& model, std::uint32_t value, std::uint32_t expected) {
    std::uint32_t difference = value - expected;
    // The one difference that AdaptiveSigned does not take goes as zero behind a raw flag: it never happens in
    // practice.
    const bool extreme = difference == 0x80000000U;
    if (coder.code(extreme_, extreme)) return expected + 0x80000000U;
    difference = static_cast<std::uint32_t>(model.code(coder, static_cast<std::int32_t>(difference)));
    return expected + difference;
  }

  std::uint32_t id(std::uint32_t value, std::uint32_t& last, AdaptiveBit& next, AdaptiveSigned& jump) {
    value = coder.code(next, value == last + 1) ? last + 1 : near(jump, value, last + 1);
    return last = value;
  }

  void newest(std::uint32_t version) {
    newest_ = last_version_ = (coder.code_raw(version >> 16, 16) << 16) | coder.code_raw(version & 0xffff, 16);
  }
  VersionId version(VersionId v) {
    if (!coder.code(same_version_, v.value == last_version_))
      last_version_ = newest_ - age_.code(coder, newest_ - v.value);
    return VersionId(last_version_);
  }

  std::int32_t coordinate(AdaptiveSigned& model, std::int32_t value, std::int32_t expected) {
    const auto v =
        static_cast<std::int32_t>(near(model, static_cast<std::uint32_t>(value), static_cast<std::uint32_t>(expected)));
    if (v < -kMaxLatticeCoordinate || v > kMaxLatticeCoordinate) corrupt("a coordinate leaves the lattice");
    return v;
  }
  LatticePoint point(std::array<AdaptiveSigned, 3>& models, LatticePoint value, LatticePoint expected) {
    LatticePoint p;
    for (int a = 0; a < 3; ++a) p[a] = coordinate(models[static_cast<std::size_t>(a)], value[a], expected[a]);
    return p;
  }

  Coder& coder;

 private:
  std::uint32_t newest_ = 0, last_version_ = 0;
  AdaptiveBit same_version_, extreme_;
  AdaptiveUnsigned age_;
};

/// How many units `v` lies beyond `edge`, never negative for a legal page.
std::uint32_t excess(std::int32_t outer, std::int32_t inner) {
  return static_cast<std::uint32_t>(outer) - static_cast<std::uint32_t>(inner);
}

template <class Coder>
class LeafCoder {
 public:
  LeafCoder(Coder& coder, LeafPage& page) : f_(coder), coder_(coder), page_(page) {
    if (!Coder::kEncodes) return;
    for (const PageWire& w : page.wires) source_wires_.emplace(w.id, &w);
    for (const PageCorner& c : page.corners) source_corners_.emplace(c.id, &c);
  }

  void run() {
    f_.newest(Coder::kEncodes ? newest_version() : 0);
    const std::uint32_t charts = f_.count(counts_, page_.charts.size(), kMostCharts);
    if (!Coder::kEncodes) page_.charts.resize(charts);
    for (PageChart& chart : page_.charts) code_chart(chart);
    code_outside_charts();
    if (!Coder::kEncodes) hand_over();
  }

 private:
  struct MetWire {
    PageWire wire;
    std::uint32_t met = 0;  ///< when it was passed last: larger is more recent
    std::vector<ChartId> inside;
  };

  std::uint32_t newest_version() const {
    std::uint32_t newest = 0;
    for (const PageChart& c : page_.charts) {
      newest = std::max(newest, c.version.value);
      for (const LayerRef l : c.layers) newest = std::max(newest, l.version.value);
    }
    for (const PageWire& w : page_.wires) newest = std::max(newest, w.version.value);
    return newest;
  }

  void code_chart(PageChart& chart) {
    chart.id = ChartId(f_.id(chart.id.value, last_chart_, next_chart_, chart_jump_));
    chart.version = f_.version(chart.version);
    chart.table = TableId(f_.near(table_, chart.table.value, last_table_));
    last_table_ = chart.table.value;
    std::uint32_t border = 0;
    LatticeBox corners;
    const std::uint32_t loops = f_.count(loop_count_, chart.loops.size(), kMostSteps);
    if (!Coder::kEncodes) chart.loops.resize(loops);
    for (WireLoop& loop : chart.loops) code_loop(chart.id, loop, border, corners);
    chart.faces = f_.near(faces_, chart.faces, last_faces_);
    last_faces_ = chart.faces;
    // Euler: a disk of F faces with B border vertices has (F - B) / 2 + 1 inner ones.
    const std::uint32_t expected = chart.faces >= border ? (chart.faces - border) / 2 + 1 : 0;
    chart.inner_vertices = f_.near(inner_, chart.inner_vertices, expected);
    code_pieces(chart);
    code_box(chart.box, corners);
    code_layers(chart);
  }

  void code_loop(ChartId chart, WireLoop& loop, std::uint32_t& border, LatticeBox& corners) {
    const std::uint32_t steps = f_.count(step_count_, loop.size(), kMostSteps - steps_);
    if (steps == 0) corrupt("a loop passes no wire");
    steps_ += steps;
    if (!Coder::kEncodes) loop.resize(steps);
    CornerId at, start;
    for (std::uint32_t s = 0; s < steps; ++s) {
      const bool closes = s + 1 == steps;
      const bool is_new = coder_.code(new_wire_, Coder::kEncodes && !met_.contains(loop[s].wire));
      if (is_new)
        code_new_wire(loop[s], at, closes ? start : CornerId(), s == 0, closes && s == 0);
      else
        code_known_wire(loop[s], at);
      MetWire& wire = met_.at(loop[s].wire);
      wire.met = ++clock_;
      wire.inside.push_back(chart);
      const CornerId begin = loop[s].reversed ? wire.wire.end : wire.wire.begin;
      at = loop[s].reversed ? wire.wire.begin : wire.wire.end;
      if (s == 0) start = begin;
      border += wire.wire.inner_points + 1;
      corners.add(corner_at_.at(begin));
    }
    if (at != start) corrupt("a loop does not close");
  }

  /// A wire that no loop passed yet. Its near end is the corner reached, its far end the loop's start where it closes,
  /// and the near end again where it is the loop's only wire.
  void code_new_wire(DirectedWire& step, CornerId at, CornerId start, bool first, bool only) {
    PageWire wire = Coder::kEncodes ? *source_wires_.at(step.wire) : PageWire{};
    wire.id = step.wire = WireId(f_.id(wire.id.value, last_wire_, next_wire_, wire_jump_));
    if (met_.contains(wire.id)) corrupt("a wire is met twice");
    wire.version = f_.version(wire.version);
    step.reversed = coder_.code(new_reversed_, step.reversed);
    wire.inner_points = inner_points_.code(coder_, wire.inner_points);
    code_group(wire);
    CornerId& near_end = step.reversed ? wire.end : wire.begin;
    CornerId& far_end = step.reversed ? wire.begin : wire.end;
    near_end = first ? code_corner(near_end, CornerId()) : at;
    if (only)
      far_end = near_end;
    else
      far_end = start ? start : code_corner(far_end, near_end);
    wire.charts.clear();
    wires_met_.push_back(wire.id);
    wires_at_[wire.begin].push_back(wire.id);
    if (wire.end != wire.begin) wires_at_[wire.end].push_back(wire.id);
    met_.emplace(wire.id, MetWire{std::move(wire), 0, {}});
  }

  /// Mostly that of the wire before; a new one begins with the wire itself.
  void code_group(PageWire& wire) {
    if (!Coder::kEncodes) wire.group = wire.id;
    if (wire.inner_points == 0) return;
    if (coder_.code(same_group_, wire.group.value == last_group_))
      wire.group = WireId(last_group_);
    else
      wire.group = WireId(f_.near(group_, wire.group.value, wire.id.value));
    last_group_ = wire.group.value;
  }

  /// One of the wires met before: at the start of a loop any, by how long ago it was first met; later on one that ends
  /// where the loop is, by its rank among those.
  void code_known_wire(DirectedWire& step, CornerId at) {
    if (!at) return code_by_position(step, wires_met_, start_position_);
    const std::vector<WireId>& here = wires_at_[at];
    if (here.size() > kMostRanked) return code_by_position(step, here, crowd_position_);
    rank_candidates(here, at);
    std::uint32_t rank = 0;
    if (Coder::kEncodes)
      while (rank < candidates_.size() &&
             !(candidates_[rank].wire == step.wire && candidates_[rank].reversed == step.reversed))
        ++rank;
    rank = rank_.code(coder_, rank);
    if (rank >= candidates_.size()) corrupt("a loop goes on along no wire");
    step = {candidates_[rank].wire, candidates_[rank].reversed};
  }

  void code_by_position(DirectedWire& step, const std::vector<WireId>& wires, AdaptiveUnsigned& model) {
    std::uint32_t back = 0;
    if (Coder::kEncodes)
      back = static_cast<std::uint32_t>(std::find(wires.rbegin(), wires.rend(), step.wire) - wires.rbegin());
    back = model.code(coder_, back);
    if (back >= wires.size()) corrupt("a loop goes on along no wire");
    step.wire = wires[wires.size() - 1 - back];
    step.reversed = coder_.code(known_reversed_, step.reversed);
  }

  /// Wires with one pass so far first, the most recent first, the direction not passed yet first.
  void rank_candidates(const std::vector<WireId>& here, CornerId at) {
    candidates_.clear();
    for (const WireId id : here) {
      const MetWire& met = met_.at(id);
      if (met.wire.begin == at) candidates_.push_back({met.met, id, false, is_open(id)});
      if (met.wire.end == at) candidates_.push_back({met.met, id, true, is_open(id)});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return std::tuple(!a.open, ~a.met, a.wire, !a.reversed) < std::tuple(!b.open, ~b.met, b.wire, !b.reversed);
    });
  }

  bool is_open(WireId id) const { return met_.at(id).inside.size() == 1; }

  /// A corner: met before, by recency, or new with its position.
  CornerId code_corner(CornerId corner, CornerId neighbour) {
    const bool is_new = coder_.code(new_corner_, Coder::kEncodes && !corner_at_.contains(corner));
    if (!is_new) {
      std::uint32_t back = 0;
      if (Coder::kEncodes)
        back = static_cast<std::uint32_t>(std::find(corners_met_.rbegin(), corners_met_.rend(), corner) -
                                          corners_met_.rbegin());
      back = corner_back_.code(coder_, back);
      if (back >= corners_met_.size()) corrupt("a wire ends in no corner");
      return corners_met_[corners_met_.size() - 1 - back];
    }
    const CornerId id(f_.id(corner.value, last_corner_, next_corner_, corner_jump_));
    if (corner_at_.contains(id)) corrupt("a corner is met twice");
    const LatticePoint expected = neighbour ? corner_at_.at(neighbour) : last_position_;
    const LatticePoint value = Coder::kEncodes ? source_corners_.at(corner)->position : LatticePoint{};
    last_position_ = f_.point(corner_, value, expected);
    corner_at_.emplace(id, last_position_);
    corners_met_.push_back(id);
    return id;
  }

  /// Mostly a chart is one piece.
  void code_pieces(PageChart& chart) {
    ChartPieces one{std::vector<std::uint32_t>(chart.loops.size(), 0), chart.loops.empty() && chart.faces > 0};
    if (coder_.code(one_piece_, chart.pieces == one)) {
      chart.pieces = std::move(one);
      return;
    }
    last_closed_ = chart.pieces.closed = f_.near(closed_, chart.pieces.closed, last_closed_);
    chart.pieces.of_loop.resize(chart.loops.size());
    std::uint32_t pieces = 0;
    for (std::uint32_t& piece : chart.pieces.of_loop) {
      piece = pieces - loop_piece_.code(coder_, pieces - piece);
      pieces += piece == pieces;
    }
  }

  void code_box(LatticeBox& box, const LatticeBox& corners) {
    if (coder_.code(empty_box_, box.empty())) {
      box = {};
      return;
    }
    if (corners.empty()) {
      box.lo = f_.point(free_lo_, box.lo, last_position_);
      box.hi = f_.point(free_hi_, box.hi, box.lo);
    } else {
      for (int a = 0; a < 3; ++a) {
        const std::uint32_t below = beyond_.code(coder_, excess(corners.lo[a], box.lo[a]));
        const std::uint32_t above = beyond_.code(coder_, excess(box.hi[a], corners.hi[a]));
        const std::int64_t lo = std::int64_t{corners.lo[a]} - below, hi = std::int64_t{corners.hi[a]} + above;
        if (lo < -kMaxLatticeCoordinate || hi > kMaxLatticeCoordinate) corrupt("a box leaves the lattice");
        box.lo[a] = static_cast<std::int32_t>(lo);
        box.hi[a] = static_cast<std::int32_t>(hi);
      }
    }
    for (int a = 0; a < 3; ++a)
      if (box.lo[a] > box.hi[a]) corrupt("a box is inside out");
  }

  void code_layers(PageChart& chart) {
    const std::uint32_t layers = f_.count(layer_count_, chart.layers.size(), kMostLayers);
    if (!Coder::kEncodes) chart.layers.resize(layers);
    std::uint32_t last = 0;
    for (LayerRef& layer : chart.layers) {
      layer.layer = static_cast<std::uint16_t>(f_.near(layer_, layer.layer, last));
      last = layer.layer;
      layer.version = f_.version(layer.version);
    }
  }

  /// Wire by wire: the charts that are not in this page, ascending from the page's first chart.
  void code_outside_charts() {
    for (auto& [id, met] : met_) {
      std::vector<ChartId> outside;
      if (Coder::kEncodes) outside = outside_of(source_wires_.at(id)->charts);
      auto& model = outside_count_[std::min<std::size_t>(met.inside.size(), 2)];
      const std::uint32_t count = f_.count(model, outside.size(), kMostSteps - steps_);
      steps_ += count;
      outside.resize(count);
      std::uint32_t expected = page_.charts.empty() ? 0 : page_.charts.front().id.value;
      for (ChartId& chart : outside) {
        chart = ChartId(f_.near(outside_, chart.value, expected));
        expected = chart.value;
      }
      met.wire.charts = met.inside;
      met.wire.charts.insert(met.wire.charts.end(), outside.begin(), outside.end());
      std::sort(met.wire.charts.begin(), met.wire.charts.end());
    }
  }

  std::vector<ChartId> outside_of(const std::vector<ChartId>& charts) const {
    std::vector<ChartId> outside;
    for (const ChartId c : charts)
      if (!std::binary_search(page_.charts.begin(), page_.charts.end(), c,
                              [](const auto& a, const auto& b) { return chart_id(a) < chart_id(b); }))
        outside.push_back(c);
    return outside;
  }
  static ChartId chart_id(const PageChart& chart) { return chart.id; }
  static ChartId chart_id(ChartId id) { return id; }

  void hand_over() {
    for (auto& [id, met] : met_) page_.wires.push_back(std::move(met.wire));
    for (const auto& [id, position] : corner_at_) page_.corners.push_back({id, position});
  }

  struct Candidate {
    std::uint32_t met;
    WireId wire;
    bool reversed, open;
  };

  Fields<Coder> f_;
  Coder& coder_;
  LeafPage& page_;
  std::map<WireId, const PageWire*> source_wires_;
  std::map<CornerId, const PageCorner*> source_corners_;

  std::map<WireId, MetWire> met_;
  std::map<CornerId, LatticePoint> corner_at_;
  std::vector<CornerId> corners_met_;
  std::vector<WireId> wires_met_;
  std::map<CornerId, std::vector<WireId>> wires_at_;
  std::vector<Candidate> candidates_;
  std::uint32_t clock_ = 0, steps_ = 0;
  LatticePoint last_position_;
  std::uint32_t last_chart_ = 0, last_wire_ = 0, last_corner_ = 0, last_table_ = 0, last_faces_ = 0, last_group_ = 0,
                last_closed_ = 0;

  AdaptiveUnsigned counts_, loop_count_, step_count_, rank_, start_position_, crowd_position_, corner_back_,
      inner_points_, beyond_, layer_count_, loop_piece_;
  std::array<AdaptiveUnsigned, 3> outside_count_;
  AdaptiveBit next_chart_, next_wire_, next_corner_, new_wire_, new_reversed_, known_reversed_, new_corner_, empty_box_,
      same_group_, one_piece_;
  AdaptiveSigned chart_jump_, wire_jump_, group_, corner_jump_, table_, faces_, inner_, layer_, outside_, closed_;
  std::array<AdaptiveSigned, 3> corner_, free_lo_, free_hi_;
};

template <class Coder>
class InnerCoder {
 public:
  InnerCoder(Coder& coder, InnerPage& page) : f_(coder), coder_(coder), page_(page) {}

  void run() {
    std::uint32_t newest = 0;
    for (const PageEntry& e : page_.pages) newest = std::max(newest, e.version.value);
    f_.newest(newest);
    const std::uint32_t entries = f_.count(counts_, page_.pages.size(), kMostEntries);
    if (!Coder::kEncodes) page_.pages.resize(entries);
    for (PageEntry& entry : page_.pages) code_entry(entry);
  }

 private:
  void code_entry(PageEntry& entry) {
    entry.id = PageId(f_.id(entry.id.value, last_page_, next_page_, page_jump_));
    entry.version = f_.version(entry.version);
    if (coder_.code(empty_box_, entry.box.empty())) {
      entry.box = {};
    } else {
      entry.box.lo = f_.point(lo_, entry.box.lo, last_lo_);
      entry.box.hi = f_.point(hi_, entry.box.hi, entry.box.lo);
      for (int a = 0; a < 3; ++a)
        if (entry.box.lo[a] > entry.box.hi[a]) corrupt("a box is inside out");
      last_lo_ = entry.box.lo;
    }
    const std::uint32_t high = faces_high_.code(coder_, static_cast<std::uint32_t>(entry.faces >> 32));
    const std::uint32_t low = f_.near(faces_, static_cast<std::uint32_t>(entry.faces), last_faces_);
    last_faces_ = low;
    entry.faces = std::uint64_t{high} << 32 | low;
    code_runs(entry.charts);
  }

  void code_runs(std::vector<ChartRun>& runs) {
    const std::uint32_t count = f_.count(run_count_, runs.size(), kMostRuns - runs_);
    runs_ += count;
    if (!Coder::kEncodes) runs.resize(count);
    for (ChartRun& run : runs) {
      run.first = ChartId(f_.near(first_, run.first.value, next_chart_));
      run.count = f_.near(length_, run.count, last_length_);
      last_length_ = run.count;
      next_chart_ = run.first.value + run.count;
    }
  }

  Fields<Coder> f_;
  Coder& coder_;
  InnerPage& page_;
  LatticePoint last_lo_;
  std::uint32_t last_page_ = 0, last_faces_ = 0, next_chart_ = 1, last_length_ = 0, runs_ = 0;
  AdaptiveUnsigned counts_, run_count_, faces_high_;
  AdaptiveBit next_page_, empty_box_;
  AdaptiveSigned page_jump_, faces_, first_, length_;
  std::array<AdaptiveSigned, 3> lo_, hi_;
};

template <class Coder>
void code_page(Coder& coder, Page& page) {
  if (auto* leaf = std::get_if<LeafPage>(&page))
    LeafCoder<Coder>(coder, *leaf).run();
  else
    InnerCoder<Coder>(coder, std::get<InnerPage>(page)).run();
}

}  // namespace

Buffer encode_page(const Page& page) {
  const std::uint8_t kind = std::holds_alternative<LeafPage>(page) ? kLeaf : kInner;
  RangeEncoder encoder;
  try {
    validate_page(page, "to be written");
    Page copy = page;
    code_page(encoder, copy);
  } catch (const Error& e) {
    throw Error(Errc::invalid_argument, e.what());
  }
  const Buffer stream = encoder.finish();
  Buffer blob;
  blob.reserve(1 + stream.size());
  blob.push_back(static_cast<std::uint8_t>(kPageFormat << 4 | kind));
  blob.insert(blob.end(), stream.begin(), stream.end());
  return blob;
}

Page decode_page(Bytes blob) {
  if (blob.empty()) corrupt("no bytes");
  if (blob[0] >> 4 == 0) corrupt("no known format");
  if (blob[0] >> 4 != kPageFormat)
    throw Error(Errc::unsupported_version, "page blob: unknown format", {}, "use a newer ramcdb");
  const unsigned kind = blob[0] & 15;
  if (kind != kLeaf && kind != kInner) corrupt("neither leaf nor inner page");
  Page page = kind == kLeaf ? Page(LeafPage{}) : Page(InnerPage{});
  RangeDecoder decoder(blob.subspan(1));
  code_page(decoder, page);
  decoder.finish();
  validate_page(page, "as read");
  return page;
}

}  // namespace ramcdb::codec
