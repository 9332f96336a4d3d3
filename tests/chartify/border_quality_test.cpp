#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "chartify/growth.h"
#include "chartify/paper_lloyd.h"
#include "chartify/straighten.h"
#include "chartify/wire_net_builder.h"
#include "tests/chartify/chart_checks.h"
#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"

namespace ramcdb::chartify::test {
namespace {

using ramcdb::test::TestMesh;

double length(LatticePoint a, LatticePoint b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = static_cast<double>(a[axis]) - b[axis];
    sum += d * d;
  }
  return std::sqrt(sum);
}

struct Borders {
  std::size_t edges = 0;
  std::uint64_t cost = 0;  ///< of straightening: 64 an edge and 64 more for its length in mean edges, rounded
};

Borders borders_of(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins,
                   const std::vector<std::uint32_t>& chart_of_face) {
  const auto edge = [&](HalfEdge h) {
    const Triangle& t = mesh.faces[face_of(h)];
    return length(mesh.positions[t[h % 3]], mesh.positions[t[(h + 1) % 3]]);
  };
  double mean = 0;
  for (HalfEdge h = 0; h < twins.size(); ++h) mean += edge(h);
  mean /= static_cast<double>(std::max<std::size_t>(1, twins.size()));
  Borders borders;
  for (HalfEdge h = 0; h < twins.size(); ++h) {
    if (twins[h] == kNoTwin || h > twins[h] || chart_of_face[face_of(h)] == chart_of_face[face_of(twins[h])]) continue;
    ++borders.edges;
    borders.cost += 64 + static_cast<std::uint64_t>(std::min(64.0, edge(h) / mean) * 64 + 0.5);
  }
  return borders;
}

std::vector<HalfEdge> twins_of(const IndexedMesh& mesh) { return find_twins(mesh, group_half_edges(mesh)); }

class BorderQuality : public testing::TestWithParam<Family> {};

TEST_P(BorderQuality, RefinedBordersAreShorterThanThoseOfThePaperAndOfGrowth) {
  const IndexedMesh mesh = canonical(GetParam().make());
  const std::vector<HalfEdge> twins = twins_of(mesh);
  const Neighbours neighbours = find_neighbours(twins);
  Options options;
  options.target_faces = 1000;
  const Charts refined = chartify(mesh, options);
  options.method = Method::paper;
  const Charts paper = chartify(mesh, options);
  const Partition grown = grow_charts(mesh, neighbours, find_components(neighbours, 1000), 5, nullptr);
  const std::size_t edges = borders_of(mesh, twins, refined.chart_of_face).edges;
  EXPECT_LT(edges, borders_of(mesh, twins, grown.chart_of_face).edges * 9 / 10);
  EXPECT_LT(edges, borders_of(mesh, twins, paper.chart_of_face).edges * 9 / 10);
}

TEST_P(BorderQuality, StripesOfSomebodyElseBecomeChartsWithShorterBorders) {
  const IndexedMesh mesh = canonical(GetParam().make());
  const std::vector<HalfEdge> twins = twins_of(mesh);
  Options options;
  options.target_faces = 1000;
  std::vector<std::uint32_t> stripes;  // of canonical order: of fair size, frayed, in pieces
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) stripes.push_back(f / 1000);
  const Charts refined = refine_cut(mesh, stripes, options);
  check_charts(mesh, refined);
  EXPECT_LT(borders_of(mesh, twins, refined.chart_of_face).edges, borders_of(mesh, twins, stripes).edges * 9 / 10);
  for (const std::uint32_t faces : faces_of_charts(refined)) EXPECT_LE(faces, 1100U);
}

INSTANTIATE_TEST_SUITE_P(Families, BorderQuality,
                         testing::Values(Family{"Sphere", [] { return ramcdb::test::sphere(40'000); }},
                                         Family{"Torus", [] { return ramcdb::test::torus(40'000); }},
                                         Family{"Terrain", [] { return ramcdb::test::terrain(140, 140); }},
                                         Family{"Scan", [] { return ramcdb::test::scan(40'000); }}),
                         [](const auto& family) { return std::string(family.param.name); });

class StraightenOn : public testing::TestWithParam<Family> {};

TEST_P(StraightenOn, NeverMakesBordersLonger) {
  const IndexedMesh mesh = canonical_order(on_lattice(GetParam().make())).mesh;
  const std::vector<HalfEdge> twins = twins_of(mesh);
  const Neighbours neighbours = find_neighbours(twins);
  for (const std::uint32_t target : {30U, 100U, 300U}) {
    SCOPED_TRACE(target);
    Partition partition = grow_charts(mesh, neighbours, find_components(neighbours, target), 3, nullptr);
    const Borders before = borders_of(mesh, twins, partition.chart_of_face);
    const std::set<std::uint32_t> pieces_before = [&] {
      const auto piece = pieces(mesh, partition.chart_of_face);
      return std::set<std::uint32_t>(piece.begin(), piece.end());
    }();
    const SizeLimits limits(target);
    BorderStraightener(mesh, twins).run(limits, partition);
    const Borders after = borders_of(mesh, twins, partition.chart_of_face);
    EXPECT_LE(after.cost, before.cost);
    const auto piece = pieces(mesh, partition.chart_of_face);
    EXPECT_LE(std::set<std::uint32_t>(piece.begin(), piece.end()).size(), pieces_before.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Families, StraightenOn, testing::ValuesIn(all_families()),
                         [](const auto& family) { return std::string(family.param.name); });

TEST(Packing, LargerComponentsKeepChartsOfTheirOwn) {
  TestMesh mesh = ramcdb::test::boxes(300);
  const auto add = [&](const TestMesh& part, double shift) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point& p : part.positions) mesh.positions.push_back({p.x + shift, p.y, p.z});
    for (const Triangle& t : part.faces) mesh.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  };
  for (int i = 0; i < 4; ++i) add(ramcdb::test::sphere(300), 3.0 * i);
  const IndexedMesh on_grid = canonical(mesh);
  const auto component = pieces(on_grid, std::vector<std::uint32_t>(on_grid.faces.size(), 0));
  std::map<std::uint32_t, std::size_t> size;
  for (const std::uint32_t c : component) ++size[c];
  Options options;
  options.target_faces = 400;
  const Charts charts = chartify(on_grid, options);
  std::map<std::uint32_t, std::set<std::uint32_t>> components_of_chart;
  for (std::size_t f = 0; f < component.size(); ++f) components_of_chart[charts.chart_of_face[f]].insert(component[f]);
  std::size_t packed = 0, large = 0;
  for (const auto& [chart, components] : components_of_chart) {
    packed += components.size() > 1;
    for (const std::uint32_t c : components) {
      if (2 * size[c] < options.target_faces) continue;
      EXPECT_EQ(components.size(), 1U) << "a component of " << size[c] << " faces shares chart " << chart;
      ++large;
    }
  }
  EXPECT_EQ(large, 4U);
  EXPECT_GE(packed, 9U);  // 3,600 faces of boxes
}

/// What the paper calls abnormal, seen in the wire-net of a manifold mesh.
struct Abnormal {
  std::size_t islands = 0, rings = 0, double_borders = 0;
};

Abnormal survey(const IndexedMesh& mesh, const Partition& partition) {
  const Charts charts{static_cast<std::uint32_t>(partition.sizes.size()), partition.chart_of_face, {}};
  const WireNet net = build_wire_net(mesh, charts);
  Abnormal found;
  std::map<std::vector<std::uint32_t>, std::size_t> wires_between;
  for (const NetWire& wire : net.wires)
    if (wire.charts.size() == 2) ++wires_between[wire.charts];
  for (const auto& [pair, wires] : wires_between) found.double_borders += wires > 1;
  for (std::uint32_t c = 0; c < net.charts.size(); ++c) {
    std::set<std::vector<std::uint32_t>> sides;
    for (const auto& loop : net.charts[c].loops)
      for (const NetLoopStep step : loop) sides.insert(net.wires[step.wire].charts);
    found.islands += sides.size() == 1 && sides.begin()->size() == 2;
    found.rings += net.charts[c].loops.size() > 1;
  }
  return found;
}

/// A flat sheet cut by `chart_at` of the middle of each face, in hundredths of the sheet.
template <class ChartAt>
Abnormal repaired(std::uint32_t charts, const Abnormal& expected_before, ChartAt&& chart_at) {
  const IndexedMesh mesh = canonical(ramcdb::test::terrain(40, 40));
  LatticeBox box;
  for (const LatticePoint p : mesh.positions) box.add(p);
  Partition partition;
  partition.sizes.assign(charts, 0);
  for (const Triangle& t : mesh.faces) {
    std::array<std::int64_t, 2> at{};
    for (const std::uint32_t v : t)
      for (int a = 0; a < 2; ++a) at[static_cast<std::size_t>(a)] += mesh.positions[v][a] - box.lo[a];
    const auto hundredths = [&](int a) {
      return 100 * at[static_cast<std::size_t>(a)] / (3 * (std::int64_t{box.hi[a]} - box.lo[a]));
    };
    partition.chart_of_face.push_back(chart_at(hundredths(0), hundredths(1)));
    ++partition.sizes[partition.chart_of_face.back()];
  }
  const Abnormal before = survey(mesh, partition);
  EXPECT_EQ(before.islands, expected_before.islands);
  EXPECT_EQ(before.rings, expected_before.rings);
  EXPECT_EQ(before.double_borders, expected_before.double_borders);
  const std::vector<HalfEdge> twins = twins_of(mesh);
  repair_topology(mesh, twins, find_neighbours(twins), partition);
  return survey(mesh, partition);
}

bool within(std::int64_t x, std::int64_t y, std::int64_t low, std::int64_t high) {
  return x >= low && x < high && y >= low && y < high;
}

void expect_normal(const Abnormal& after) {
  EXPECT_EQ(after.islands, 0U);
  EXPECT_EQ(after.rings, 0U);
  EXPECT_EQ(after.double_borders, 0U);
}

TEST(PaperRepairSeenInWires, NoIslandIsLeft) {
  expect_normal(repaired(3, {1, 1, 0}, [](std::int64_t x, std::int64_t y) {
    return x >= 60 ? 2U : within(x, y, 20, 40) ? 1U : 0U;
  }));
}

/// The ring, and the two halves of what is outside, which meet on either side of it.
TEST(PaperRepairSeenInWires, NoRingIsLeft) {
  expect_normal(repaired(5, {0, 1, 1}, [](std::int64_t x, std::int64_t y) {
    if (within(x, y, 35, 65)) return x < 50 ? 0U : 1U;
    if (within(x, y, 15, 85)) return 2U;
    return y < 50 ? 3U : 4U;
  }));
}

TEST(PaperRepairSeenInWires, NoDoubleBorderIsLeft) {
  expect_normal(repaired(3, {0, 0, 1}, [](std::int64_t x, std::int64_t y) {
    if (x < 50) return 0U;
    return x < 70 && y >= 40 && y < 60 ? 2U : 1U;
  }));
}

}  // namespace
}  // namespace ramcdb::chartify::test
