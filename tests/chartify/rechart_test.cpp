#include "chartify/rechart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "ramcdb/error.h"
#include "tests/chartify/chart_checks.h"
#include "tests/chartify/edited_mesh.h"
#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"
#include "tests/chartify/region_edits.h"
#include "tests/chartify/wire_net_checks.h"

namespace ramcdb::chartify::test {
namespace {

constexpr std::uint32_t kTarget = 120;

Options options_of(std::uint32_t target = kTarget) {
  Options options;
  options.target_faces = target;
  return options;
}

/// Numbers are dense, none is empty, and old charts go on where most of their faces are, each once.
void check_continuation(const Region& region, const Recharted& out) {
  const Rechart in = region.rechart_input();
  ASSERT_EQ(out.continues.size(), out.charts.chart_count);
  ASSERT_EQ(out.charts.chart_of_face.size(), region.mesh.faces.size());
  ASSERT_EQ(out.charts.chart_of_isolated_vertex.size(), region.chart_of_isolated.size());
  std::set<std::uint32_t> used(out.charts.chart_of_face.begin(), out.charts.chart_of_face.end());
  used.insert(out.charts.chart_of_isolated_vertex.begin(), out.charts.chart_of_isolated_vertex.end());
  ASSERT_EQ(used.size(), out.charts.chart_count);
  ASSERT_TRUE(used.empty() || *used.rbegin() + 1 == out.charts.chart_count);
  ASSERT_TRUE(std::ranges::is_sorted(out.continues)) << "charts that go on come first, by old number";
  std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> shares;
  for (std::size_t f = 0; f < in.chart_of_face.size(); ++f)
    if (in.chart_of_face[f] != kNone) ++shares[in.chart_of_face[f]][out.charts.chart_of_face[f]];
  std::set<std::uint32_t> seen;
  for (std::uint32_t c = 0; c < out.continues.size(); ++c) {
    const std::uint32_t old = out.continues[c];
    if (old == kNone) continue;
    ASSERT_TRUE(seen.insert(old).second) << "an old chart goes on twice";
    for (const auto& [chart, faces] : shares[old]) ASSERT_LE(faces, shares[old][c]);
  }
}

/// One piece and whole small components.
void check_connected(const Region& region, const Recharted& out) {
  const std::vector<std::uint32_t> pieces_of = pieces(region.mesh, out.charts.chart_of_face);
  const std::vector<std::uint32_t> component = pieces(region.mesh, std::vector<std::uint32_t>(pieces_of.size(), 0));
  std::map<std::uint32_t, std::size_t> piece_sizes, component_sizes;
  for (const std::uint32_t p : pieces_of) ++piece_sizes[p];
  for (const std::uint32_t c : component) ++component_sizes[c];
  std::map<std::uint32_t, std::set<std::uint32_t>> parts;
  for (std::size_t f = 0; f < pieces_of.size(); ++f)
    if (piece_sizes[pieces_of[f]] != component_sizes[component[f]])
      parts[out.charts.chart_of_face[f]].insert(pieces_of[f]);
  if (!region.fixed.empty()) return;  // pieces that look like parts may be whole between fixed wires
  for (const auto& [chart, own] : parts) ASSERT_EQ(own.size(), 1U) << "chart " << chart << " is torn";
}

void check_sizes(const Region& region, const Recharted& out, std::uint32_t target) {
  if (4 * region.mesh.faces.size() < target) return;
  std::vector<std::uint32_t> sizes = faces_of_charts(out.charts);
  for (const std::uint32_t size : sizes) {
    ASSERT_LE(size, 2 * target);
    ASSERT_TRUE(size == 0 || 4 * size >= target) << size << " faces";
  }
}

struct Outcome {
  Recharted out;
  WireNet net;
  StoredMesh stored;
};

/// Cuts an edited region anew, puts it back and checks all there is to check.
void commit(const StoredMesh& stored, const Region& region, std::uint32_t target, Outcome& outcome) {
  outcome.out = rechart(region.rechart_input(), options_of(target));
  ASSERT_NO_FATAL_FAILURE(check_continuation(region, outcome.out));
  ASSERT_NO_FATAL_FAILURE(check_connected(region, outcome.out));
  ASSERT_NO_FATAL_FAILURE(check_sizes(region, outcome.out, target));
  outcome.net = build_wire_net(region.mesh, outcome.out.charts, region.fixed, region.corners);
  ASSERT_NO_FATAL_FAILURE(check_edited_net(region.mesh, outcome.out.charts, outcome.net));
  ASSERT_NO_FATAL_FAILURE(check_origins(outcome.net, region.fixed));
  outcome.stored = put_back(stored, region, outcome.out.charts, outcome.net);
  ASSERT_NO_FATAL_FAILURE(check_edited_net(outcome.stored.mesh, outcome.stored.charts, outcome.stored.net));
}

std::vector<std::uint32_t> first_charts(const StoredMesh& stored, std::uint32_t count) {
  std::vector<std::uint32_t> charts(std::min(count, stored.charts.chart_count));
  std::iota(charts.begin(), charts.end(), 0U);
  return charts;
}

StoredMesh stored_sphere(std::size_t faces = 3000, std::uint32_t target = kTarget) {
  return store(canonical(ramcdb::test::sphere(faces)), options_of(target));
}

bool sizes_are_kept(const Charts& charts, std::uint32_t target) {
  return std::ranges::all_of(faces_of_charts(charts), [&](std::uint32_t size) {
    return size == 0 || (4 * size >= target && size <= 2 * target);
  });
}

class RechartOf : public testing::TestWithParam<Family> {
 protected:
  RechartOf() : mesh_(canonical_order(on_lattice(GetParam().make())).mesh) {}
  IndexedMesh mesh_;
};

TEST_P(RechartOf, NothingChangesNothing) {
  for (const std::uint32_t target : {1U, 7U, 50U, 120U, 300U, 5000U})
    for (const std::uint32_t count : {1U, 3U, 1000U}) {
      SCOPED_TRACE(testing::Message() << "target " << target << ", charts " << count);
      const StoredMesh stored = store(mesh_, options_of(target));
      const Region region = take_out(stored, first_charts(stored, count));
      Outcome outcome;
      ASSERT_NO_FATAL_FAILURE(commit(stored, region, target, outcome));
      Charts before;
      before.chart_count = static_cast<std::uint32_t>(region.charts.size());
      before.chart_of_face = region.chart_of_face;
      before.chart_of_isolated_vertex = region.chart_of_isolated;
      if (!sizes_are_kept(before, target)) continue;
      ASSERT_EQ(outcome.out.charts.chart_of_face, before.chart_of_face);
      ASSERT_EQ(outcome.out.charts.chart_of_isolated_vertex, before.chart_of_isolated_vertex);
      ASSERT_EQ(outcome.out.continues, first_charts(stored, count));
      ASSERT_EQ(std::ranges::count_if(outcome.net.origin, [](WireOrigin o) { return o.fixed != kNone; }),
                static_cast<std::ptrdiff_t>(region.fixed.size()))
          << "a fixed wire was cut";
      ASSERT_EQ(outcome.stored.net.wires.size(), stored.net.wires.size());
    }
}

/// Random edits of random regions, one after the other; each finds what the one before left.
TEST_P(RechartOf, EditsWithoutEnd) {
  for (const unsigned seed : {1U, 2U}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    StoredMesh stored = store(mesh_, options_of());
    for (int step = 0; step < 25; ++step) {
      SCOPED_TRACE(testing::Message() << "step " << step);
      std::set<std::uint32_t> charts;
      for (std::uint32_t i = 0; stored.charts.chart_count > 0 && i < 1 + random() % 4; ++i)
        charts.insert(static_cast<std::uint32_t>(random() % stored.charts.chart_count));
      Region region = take_out(stored, {charts.begin(), charts.end()});
      for (unsigned edits = 1 + random() % 4; edits > 0; --edits) edit_at_random(region, random);
      Outcome outcome;
      ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
      stored = std::move(outcome.stored);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RechartOf, testing::ValuesIn(all_families()),
                         [](const auto& family) { return std::string(family.param.name); });

/// Some charts that hang together.
std::vector<std::uint32_t> charts_around(const StoredMesh& stored, std::uint32_t chart) {
  std::set<std::uint32_t> around{chart};
  for (const NetWire& wire : stored.net.wires)
    if (std::ranges::find(wire.charts, chart) != wire.charts.end())
      around.insert(wire.charts.begin(), wire.charts.end());
  return {around.begin(), around.end()};
}

std::uint32_t inner_face(const Region& region, std::uint32_t chart) {
  const auto stays = faces_that_stay(region);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < stays.size(); ++f)
    if (!stays[f] && region.chart_of_face[f] == chart) faces.push_back(f);
  return faces.at(faces.size() / 2);
}

/// A face of a chart with as many faces around it in the chart.
std::uint32_t deep_face(const Region& region, std::uint32_t chart, std::size_t count) {
  for (std::uint32_t f = 0; f < region.mesh.faces.size(); ++f) {
    const auto disk = disk_around(region, f, count);
    bool inside = disk[f];
    for (std::size_t g = 0; g < disk.size(); ++g) inside = inside && (!disk[g] || region.chart_of_face[g] == chart);
    if (inside) return f;
  }
  ADD_FAILURE() << "no such face";
  return 0;
}

TEST(Rechart, AHoleLeavesOtherChartsAlone) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, charts_around(stored, 5));
  const auto place = static_cast<std::uint32_t>(std::ranges::find(region.charts, 5U) - region.charts.begin());
  const auto charts = static_cast<std::uint32_t>(region.charts.size());
  const std::vector<std::uint32_t> before = faces_of_charts({charts, region.chart_of_face, {}});
  delete_disk(region, deep_face(region, place, 40), 10);
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
  EXPECT_EQ(outcome.out.charts.chart_of_face, region.chart_of_face);
  std::vector<std::uint32_t> expected = before;
  expected[place] -= 10;
  EXPECT_EQ(faces_kept(region.rechart_input(), outcome.out), expected);
}

/// All faces of a chart four and sixteen times: parts, the one with most old faces keeps the number, and the wires
/// around are cut but stay.
TEST(Rechart, ADenserChartIsSplit) {
  for (const int rounds : {2, 3}) {
    const StoredMesh stored = stored_sphere();
    Region region = take_out(stored, {7});
    std::vector<std::uint8_t> marked = faces_that_stay(region);
    for (int i = 0; i < rounds; ++i) {
      for (std::size_t f = 0; f < marked.size(); ++f) marked[f] = !faces_that_stay(region)[f];
      subdivide(region, marked);
      marked.resize(region.mesh.faces.size());
    }
    const std::size_t faces = region.mesh.faces.size();
    Outcome outcome;
    ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
    EXPECT_GE(outcome.out.charts.chart_count, faces / kTarget * 2 / 3);
    EXPECT_LE(outcome.out.charts.chart_count, faces / kTarget * 3 / 2);
    EXPECT_EQ(outcome.out.continues[0], 0U);
    EXPECT_EQ(std::ranges::count(outcome.out.continues, kNone), outcome.out.charts.chart_count - 1);
    EXPECT_GT(std::ranges::count_if(outcome.net.origin, [](WireOrigin o) { return o.fixed != kNone; }),
              static_cast<std::ptrdiff_t>(region.fixed.size()))
        << "no fixed wire was cut";
  }
}

TEST(Rechart, ACoarserChartJoinsANeighbour) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, charts_around(stored, 7));
  const auto place = static_cast<std::uint32_t>(std::ranges::find(region.charts, 7U) - region.charts.begin());
  std::vector<std::uint8_t> marked(region.mesh.faces.size());
  delete_chart(region, place);
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
  EXPECT_EQ(outcome.out.charts.chart_count, region.charts.size() - 1);
  EXPECT_EQ(std::ranges::count(outcome.out.continues, place), 0);
  EXPECT_EQ(std::ranges::count(outcome.out.continues, kNone), 0);
}

TEST(Rechart, NothingButNewFacesIsCutAsAMeshOfItsOwn) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, first_charts(stored, stored.charts.chart_count));
  std::ranges::fill(region.chart_of_face, kNone);
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
  EXPECT_NEAR(outcome.out.charts.chart_count, stored.charts.chart_count, 3);
  EXPECT_EQ(std::ranges::count(outcome.out.continues, kNone), outcome.out.charts.chart_count);
  for (const std::uint32_t size : faces_of_charts(outcome.out.charts)) EXPECT_LE(size, kTarget + kTarget / 10);
}

/// Half the faces of a region are new: charts grow into them, the others stay.
TEST(Rechart, ChartsGrowIntoNewFaces) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, charts_around(stored, 7));
  const auto place = static_cast<std::uint32_t>(std::ranges::find(region.charts, 7U) - region.charts.begin());
  const std::vector<std::uint32_t> before = region.chart_of_face;
  std::ranges::replace(region.chart_of_face, place, kNone);
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
  for (std::size_t f = 0; f < before.size(); ++f)
    if (before[f] != place) {
      ASSERT_EQ(outcome.out.continues[outcome.out.charts.chart_of_face[f]], before[f]);
    }
  EXPECT_EQ(outcome.out.charts.chart_count, region.charts.size() - 1);
}

TEST(Rechart, NewComponentsShareChartsOrGetTheirOwn) {
  const StoredMesh stored = stored_sphere();
  Region small = take_out(stored, {3, 9});
  add_component(small, ramcdb::test::boxes(1), {100, 100, 100});
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, small, kTarget, outcome));
  EXPECT_EQ(outcome.out.charts.chart_count, 2U);

  Region many = take_out(stored, {3, 9});
  add_component(many, ramcdb::test::boxes(50), {100, 100, 100});
  ASSERT_NO_FATAL_FAILURE(commit(stored, many, kTarget, outcome));
  EXPECT_EQ(outcome.out.charts.chart_count, 2U + 5U);

  Region large = take_out(stored, {3, 9});
  add_component(large, ramcdb::test::sphere(1000), {100, 100, 100});
  ASSERT_NO_FATAL_FAILURE(commit(stored, large, kTarget, outcome));
  EXPECT_NEAR(outcome.out.charts.chart_count, 2 + 1000 / kTarget, 2);
}

/// A chart that an edit cuts through: the larger part keeps it.
TEST(Rechart, PiecesThatAreLargeBecomeCharts) {
  const IndexedMesh mesh = canonical(ramcdb::test::terrain(10, 30));  // 600 faces
  Region region;
  region.mesh = mesh;
  region.chart_of_face.assign(mesh.faces.size(), 0);
  region.charts = {0};
  region.source_vertex.assign(mesh.positions.size(), kNone);
  std::int32_t low = 0, high = 0;
  for (const LatticePoint p : mesh.positions) high = std::max(high, p.y), low = std::min(low, p.y);
  std::vector<std::uint8_t> removed;
  for (const Triangle& t : mesh.faces) {
    const auto y = [&](std::size_t i) { return mesh.positions[t[i]].y; };
    const std::int32_t line = low + (high - low) * 2 / 5;
    removed.push_back(std::min({y(0), y(1), y(2)}) <= line && std::max({y(0), y(1), y(2)}) >= line);
  }
  remove_faces(region, removed);
  const Recharted out = rechart(region.rechart_input(), options_of(400));
  check_connected(region, out);
  ASSERT_EQ(out.charts.chart_count, 2U);
  EXPECT_EQ(out.continues, (std::vector<std::uint32_t>{0, kNone}));
  const std::vector<std::uint32_t> sizes = faces_of_charts(out.charts);
  EXPECT_GT(sizes[0], sizes[1]);
}

TEST(Rechart, HandlesFinsAndDoubledFaces) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, charts_around(stored, 4));
  glue_handle(region, inner_face(region, 0), inner_face(region, 3));
  glue_fin(region, inner_face(region, 1));
  double_face(region, inner_face(region, 2));
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, kTarget, outcome));
  EXPECT_EQ(outcome.out.charts.chart_count, region.charts.size());
}

TEST(Rechart, PolygonsStayWhole) {
  IndexedMesh mesh = on_lattice(ramcdb::test::terrain(40, 40));
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) mesh.polygon_of_face.push_back(f / 2);
  const StoredMesh stored = store(mesh, options_of(400));
  Region region = take_out(stored, first_charts(stored, 4));
  for (std::size_t f = 0; f < region.chart_of_face.size(); f += 2)
    if (region.chart_of_face[f] < 3) region.chart_of_face[f] = region.chart_of_face[f + 1] = kNone;
  Outcome outcome;
  ASSERT_NO_FATAL_FAILURE(commit(stored, region, 60, outcome));
  for (std::size_t f = 0; f < region.mesh.faces.size(); f += 2) {
    ASSERT_EQ(region.mesh.polygon_of_face[f], region.mesh.polygon_of_face[f + 1]);
    ASSERT_EQ(outcome.out.charts.chart_of_face[f], outcome.out.charts.chart_of_face[f + 1]);
  }
}

/// A chart between fixed wires on three sheets that meet: merged sheets would be torn along the line.
TEST(Rechart, FixedWiresSeparate) {
  const IndexedMesh mesh{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {{0, 1, 2}, {1, 0, 3}}};
  const std::vector<std::uint32_t> old{0, 0};
  const std::vector<FixedWire> fixed{{{1, 0}}};
  const Recharted out = rechart({mesh, old, {}, 1, fixed}, options_of(5000));
  ASSERT_EQ(out.charts.chart_count, 1U);
  const WireNet net = build_wire_net(mesh, out.charts, fixed);
  ASSERT_NO_FATAL_FAILURE(check_edited_net(mesh, out.charts, net));
  ASSERT_NO_FATAL_FAILURE(check_origins(net, fixed));
  const auto on = std::ranges::find_if(net.origin, [](WireOrigin o) { return o.fixed == 0; });
  ASSERT_NE(on, net.origin.end());
  const NetWire& wire = net.wires[static_cast<std::size_t>(on - net.origin.begin())];
  EXPECT_EQ(wire.vertices, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(wire.charts, (std::vector<std::uint32_t>{0, 0}));
}

/// A closed surface that another chart touches in one vertex is slit there, as if the other were in the mesh.
TEST(Rechart, ACornerInsideASurfaceIsSlit) {
  const IndexedMesh mesh = canonical(ramcdb::test::sphere(500));
  const Charts charts{1, std::vector<std::uint32_t>(mesh.faces.size(), 0), {}};
  const std::vector<std::uint32_t> corners{42};
  const WireNet net = build_wire_net(mesh, charts, {}, corners);
  ASSERT_NO_FATAL_FAILURE(check_chart(net.charts[0].chart));
  ASSERT_EQ(net.charts[0].loops.size(), 1U);
  EXPECT_TRUE(std::ranges::find(net.corners, 42U) != net.corners.end());
}

TEST(Rechart, IsTheSameHoweverFacesAreOrdered) {
  const StoredMesh stored = stored_sphere();
  Region region = take_out(stored, charts_around(stored, 7));
  subdivide(region, disk_around(region, inner_face(region, 2), 80));
  add_component(region, ramcdb::test::boxes(20), {100, 100, 100});
  const Recharted out = rechart(region.rechart_input(), options_of());
  std::vector<std::uint32_t> order(region.mesh.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  Region other = region;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Triangle& t = region.mesh.faces[order[i]];
    other.mesh.faces[i] = {t[i % 3], t[(i + 1) % 3], t[(i + 2) % 3]};
    other.chart_of_face[i] = region.chart_of_face[order[i]];
  }
  Options threads = options_of();
  threads.threads = 7;
  const Recharted again = rechart(other.rechart_input(), threads);
  EXPECT_EQ(again.continues, out.continues);
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_EQ(again.charts.chart_of_face[i], out.charts.chart_of_face[order[i]]);
}

TEST(Rechart, RefusesWhatDoesNotFit) {
  const IndexedMesh mesh{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}};
  const std::vector<std::uint32_t> old{0}, none;
  const std::vector<FixedWire> off{{{0, 1, 0}}};
  EXPECT_NO_THROW((void)rechart({mesh, old, {}, 1, {}}, options_of()));
  EXPECT_THROW((void)rechart({mesh, old, {}, 0, {}}, options_of()), Error);
  EXPECT_THROW((void)rechart({mesh, none, {}, 1, {}}, options_of()), Error);
  EXPECT_THROW((void)rechart({mesh, old, old, 1, {}}, options_of()), Error);
  EXPECT_THROW((void)rechart({mesh, old, {}, 1, off}, options_of()), Error);
  EXPECT_THROW((void)rechart({mesh, old, {}, 1, {}}, options_of(0)), Error);
}

}  // namespace
}  // namespace ramcdb::chartify::test
