#include <gtest/gtest.h>

#include <algorithm>

#include "chartify/face_moves.h"
#include "chartify/growth.h"
#include "chartify/paper_lloyd.h"
#include "chartify/rebalance.h"
#include "chartify/split.h"
#include "chartify/straighten.h"
#include "tests/chartify/chart_checks.h"

namespace ramcdb::chartify::test {
namespace {

using ramcdb::test::TestMesh;

std::size_t border_edges(const std::vector<HalfEdge>& twins, const std::vector<std::uint32_t>& chart_of_face) {
  std::size_t edges = 0;
  for (HalfEdge h = 0; h < twins.size(); ++h)
    edges += twins[h] != kNoTwin && twins[h] > h && chart_of_face[face_of(h)] != chart_of_face[face_of(twins[h])];
  return edges;
}

/// A mesh with what every stage needs.
struct Stage {
  explicit Stage(const TestMesh& test_mesh, std::uint32_t target)
      : mesh(canonical(test_mesh)),
        twins(find_twins(mesh, group_half_edges(mesh))),
        neighbours(find_neighbours(twins)),
        limits(target),
        partition(grow_charts(mesh, neighbours, find_components(neighbours, target), 5, nullptr)) {}

  [[nodiscard]] std::size_t border() const { return border_edges(twins, partition.chart_of_face); }
  void expect_consistent() const {
    Charts charts{static_cast<std::uint32_t>(partition.sizes.size()), partition.chart_of_face, {}};
    EXPECT_EQ(faces_of_charts(charts), partition.sizes);
    Partition numbered = partition;
    renumber(numbered);
    check_charts(mesh, {charts.chart_count, numbered.chart_of_face, {}});
  }

  IndexedMesh mesh;
  std::vector<HalfEdge> twins;
  Neighbours neighbours;
  SizeLimits limits;
  Partition partition;
};

TEST(Rebalance, BringsChartsBelowTheCap) {
  Stage stage(ramcdb::test::sphere(40'000), 1000);
  ASSERT_GT(*std::max_element(stage.partition.sizes.begin(), stage.partition.sizes.end()), stage.limits.cap);
  FaceMover mover(stage.twins, stage.limits, stage.partition);
  rebalance(mover, stage.limits, static_cast<std::uint32_t>(stage.partition.sizes.size()));
  stage.expect_consistent();
  EXPECT_LE(*std::max_element(stage.partition.sizes.begin(), stage.partition.sizes.end()), stage.limits.cap * 21 / 20);
}

TEST(FaceMoves, ShortenBordersAndKeepChartsWhole) {
  Stage stage(ramcdb::test::scan(40'000), 1000);
  const std::size_t before = stage.border();
  FaceMover mover(stage.twins, stage.limits, stage.partition);
  move_faces(mover);
  stage.expect_consistent();
  EXPECT_LT(stage.border(), before * 9 / 10);
}

TEST(FaceMoves, AreTheSameOnAnyNumberOfThreads) {
  Stage one(ramcdb::test::scan(40'000), 300), many = one;
  FaceMover mover(one.twins, one.limits, one.partition), mover_of_many(many.twins, many.limits, many.partition);
  move_faces(mover, 1);
  move_faces(mover_of_many, 5);
  EXPECT_EQ(many.partition.chart_of_face, one.partition.chart_of_face);
  EXPECT_EQ(many.partition.sizes, one.partition.sizes);
}

TEST(FaceMoves, LeaveFacesOfNoChartAlone) {
  Stage stage(ramcdb::test::torus(4000), 300);
  for (std::uint32_t& chart : stage.partition.chart_of_face)
    if (chart == 1) chart = kNone;
  stage.partition.sizes[1] = 0;
  const auto of_none = [&] { return std::ranges::count(stage.partition.chart_of_face, kNone); };
  const auto before = of_none();
  FaceMover mover(stage.twins, stage.limits, stage.partition);
  move_faces(mover, 2);
  EXPECT_EQ(of_none(), before);
}

TEST(Straighten, ShortensBordersAndKeepsChartsWhole) {
  Stage stage(ramcdb::test::scan(40'000), 1000);
  const std::size_t before = stage.border();
  BorderStraightener(stage.mesh, stage.twins).run(stage.limits, stage.partition);
  stage.expect_consistent();
  EXPECT_LT(stage.border(), before * 9 / 10);
}

/// Two charts of a flat grid that meet along a zigzag; the straight line between its ends is the only cheapest path.
TEST(Straighten, MakesAZigzagStraight) {
  constexpr std::uint32_t kSide = 12;
  IndexedMesh mesh;
  Partition partition;
  partition.sizes.assign(2, 0);
  for (std::int32_t y = 0; y <= 12; ++y)
    for (std::int32_t x = 0; x <= 12; ++x) mesh.positions.push_back({10 * x, 10 * y, 0});
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t v = y * (kSide + 1) + x, up = v + kSide + 1;
      mesh.faces.push_back({v, v + 1, up + 1});
      mesh.faces.push_back({v, up + 1, up});
      const bool zig = y >= 3 && y < 9 && y % 2 == 1;
      const std::uint32_t chart = x < (zig ? 9U : 6U) ? 0 : 1;
      partition.chart_of_face.insert(partition.chart_of_face.end(), 2, chart);
      partition.sizes[chart] += 2;
    }
  const auto twins = find_twins(mesh, group_half_edges(mesh));
  ASSERT_GT(border_edges(twins, partition.chart_of_face), kSide);
  BorderStraightener(mesh, twins).run(SizeLimits(200), partition);
  EXPECT_EQ(border_edges(twins, partition.chart_of_face), kSide);
  EXPECT_EQ(partition.sizes, (std::vector<std::uint32_t>{144, 144}));
}

TEST(SplitCharts, CutsAChartInEvenParts) {
  Stage stage(ramcdb::test::torus(10'000), 10'000);
  ASSERT_EQ(stage.partition.sizes.size(), 1U);
  split_charts(stage.mesh, stage.neighbours, {5}, stage.partition);
  ASSERT_EQ(stage.partition.sizes.size(), 5U);
  stage.expect_consistent();
  for (const std::uint32_t size : stage.partition.sizes) EXPECT_NEAR(size, 2000, 800);
}

TEST(MergePieces, StraysJoinTheChartAroundThem) {
  Stage stage(ramcdb::test::terrain(40, 40), 3200);
  ASSERT_EQ(stage.partition.sizes.size(), 1U);
  // A second chart of the last faces, and every 50th face strewn over the first.
  stage.partition.sizes.push_back(0);
  FaceMover mover(stage.twins, stage.limits, stage.partition);
  const auto faces = static_cast<std::uint32_t>(stage.mesh.faces.size());
  for (std::uint32_t f = 0; f < faces; ++f)
    if (f >= faces / 2 || f % 50 == 0) mover.move(f, 1);
  merge_pieces(stage.neighbours, stage.partition);
  stage.expect_consistent();
  EXPECT_EQ(stage.partition.sizes.size(), 2U);
}

/// A grid of cells cut by `chart_at` of each cell's column and row.
template <class ChartAt>
Stage grid_of(std::size_t side, std::uint32_t charts, ChartAt&& chart_at) {
  Stage stage(ramcdb::test::terrain(side, side), 2 * static_cast<std::uint32_t>(side * side));
  const auto [low, high] = std::minmax_element(stage.mesh.positions.begin(), stage.mesh.positions.end(),
                                               [](const auto& a, const auto& b) { return a.x < b.x; });
  const double width = high->x - low->x + 1;
  stage.partition.sizes.assign(charts, 0);
  for (std::size_t f = 0; f < stage.mesh.faces.size(); ++f) {
    double x = 0, y = 0;
    for (const std::uint32_t v : stage.mesh.faces[f]) {
      x += (stage.mesh.positions[v].x - low->x) / width / 3;
      y += (stage.mesh.positions[v].y - low->y) / width / 3;
    }
    stage.partition.chart_of_face[f] = chart_at(x, y);
    ++stage.partition.sizes[stage.partition.chart_of_face[f]];
  }
  return stage;
}

bool within(double x, double y, double low, double high) { return x > low && x < high && y > low && y < high; }

TEST(PaperRepair, AnIslandJoinsItsNeighbour) {
  Stage stage = grid_of(30, 3, [](double x, double y) { return x > 0.6 ? 2U : within(x, y, 0.2, 0.4) ? 1U : 0U; });
  repair_topology(stage.mesh, stage.twins, stage.neighbours, stage.partition);
  EXPECT_EQ(stage.partition.sizes.size(), 2U);
  stage.expect_consistent();
}

TEST(PaperRepair, ARingIsCutInThree) {
  // Two charts inside the ring, so that neither is an island.
  Stage stage = grid_of(30, 4, [](double x, double y) {
    if (within(x, y, 0.35, 0.65)) return x < 0.5 ? 0U : 1U;
    return within(x, y, 0.15, 0.85) ? 2U : 3U;
  });
  repair_topology(stage.mesh, stage.twins, stage.neighbours, stage.partition);
  EXPECT_GE(stage.partition.sizes.size(), 6U);
  stage.expect_consistent();
}

TEST(PaperRepair, OfTwoChartsWithTwoCommonBordersTheLargerIsCut) {
  // Chart 2 lies in the middle of the border between the others.
  Stage stage = grid_of(30, 3, [](double x, double y) {
    if (x < 0.5) return 0U;
    return x < 0.7 && y > 0.4 && y < 0.6 ? 2U : 1U;
  });
  const std::size_t before = stage.partition.sizes.size();
  repair_topology(stage.mesh, stage.twins, stage.neighbours, stage.partition);
  EXPECT_GT(stage.partition.sizes.size(), before);
  stage.expect_consistent();
}

class BothMethods : public testing::TestWithParam<Method> {
 protected:
  BothMethods() {
    options_.method = GetParam();
    options_.target_faces = 700;
  }
  Options options_;
};

TEST_P(BothMethods, ThreadsNeverChangeTheResult) {
  const IndexedMesh mesh = canonical(ramcdb::test::several_components());
  const Charts one = chartify(mesh, options_);
  for (const unsigned threads : {2U, 7U}) {
    options_.threads = threads;
    const Charts more = chartify(mesh, options_);
    EXPECT_EQ(more.chart_of_face, one.chart_of_face);
    EXPECT_EQ(more.chart_of_isolated_vertex, one.chart_of_isolated_vertex);
  }
}

TEST_P(BothMethods, TheOrderOfTheInputDoesNotMatter) {
  for (const TestMesh& test_mesh : {ramcdb::test::scan(9000), ramcdb::test::isolated_vertices()}) {
    const Charts charts = chartify(canonical(test_mesh), options_);
    for (const unsigned seed : {1U, 2U, 3U}) {
      const Charts shuffled = chartify(canonical(ramcdb::test::shuffled(test_mesh, seed)), options_);
      EXPECT_EQ(shuffled.chart_of_face, charts.chart_of_face);
      EXPECT_EQ(shuffled.chart_of_isolated_vertex, charts.chart_of_isolated_vertex);
    }
  }
}

struct Cancelled {};

TEST_P(BothMethods, ProgressRisesToOneAndMayCancelAnywhere) {
  const IndexedMesh mesh = canonical(ramcdb::test::scan(9000));
  std::vector<double> reports;
  options_.progress = [&](double done) { reports.push_back(done); };
  (void)chartify(mesh, options_);
  ASSERT_GE(reports.size(), 5U);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_GE(reports.front(), 0);
  EXPECT_EQ(reports.back(), 1);
  for (std::size_t stop = 0; stop < reports.size(); ++stop) {
    std::size_t calls = 0;
    options_.progress = [&](double) {
      if (calls++ == stop) throw Cancelled{};
    };
    EXPECT_THROW((void)chartify(mesh, options_), Cancelled);
    EXPECT_EQ(calls, stop + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Chartify, BothMethods, testing::Values(Method::refined, Method::paper),
                         [](const auto& method) { return method.param == Method::paper ? "Paper" : "Refined"; });

}  // namespace
}  // namespace ramcdb::chartify::test
