#include <gtest/gtest.h>

#include <algorithm>

#include "ramcdb/error.h"
#include "tests/chartify/chart_checks.h"

namespace ramcdb::chartify::test {
namespace {

using ramcdb::test::TestMesh;

struct Spread {
  double median, p95, largest;  // in targets
};

Spread spread_of(const Charts& charts, std::uint32_t target) {
  std::vector<std::uint32_t> sizes = faces_of_charts(charts);
  std::sort(sizes.begin(), sizes.end());
  const auto at = [&](std::size_t i) { return static_cast<double>(sizes[i]) / target; };
  return {at(sizes.size() / 2), at(sizes.size() * 19 / 20), at(sizes.size() - 1)};
}

void expect_even(const TestMesh& test_mesh, std::uint32_t target) {
  const IndexedMesh mesh = canonical(test_mesh);
  Options options;
  options.target_faces = target;
  const Charts charts = chartify(mesh, options);
  check_charts(mesh, charts);
  EXPECT_EQ(charts.chart_count, (mesh.faces.size() + target / 2) / target);
  const Spread spread = spread_of(charts, target);
  EXPECT_NEAR(spread.median, 1, 0.1);
  EXPECT_LE(spread.p95, 1.15);
  EXPECT_LE(spread.largest, 1.2);
}

TEST(ChartSizes, SphereOf200kFaces) { expect_even(ramcdb::test::sphere(200'000), 5000); }
TEST(ChartSizes, TorusOf200kFaces) { expect_even(ramcdb::test::torus(200'000), 5000); }
TEST(ChartSizes, TerrainOf200kFaces) { expect_even(ramcdb::test::terrain(317, 317), 5000); }
TEST(ChartSizes, SmallChartsOfAScan) { expect_even(ramcdb::test::scan(60'000), 500); }

TEST(ChartSizes, LittleBoxesShareCharts) {
  const IndexedMesh mesh = canonical(ramcdb::test::boxes(2000));
  const Charts charts = chartify(mesh, {});
  check_charts(mesh, charts);
  const std::vector<std::uint32_t> sizes = faces_of_charts(charts);
  ASSERT_EQ(sizes.size(), 5U);  // 24,000 faces
  for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(sizes[c], 4992U);
}

/// Long strips that hang together at one end only: charts have few neighbours to hand faces to.
TestMesh comb(std::size_t teeth, std::size_t length) {
  TestMesh mesh;
  const auto vertex = [&](std::size_t x, std::size_t y) { return static_cast<std::uint32_t>(x * (length + 1) + y); };
  for (std::size_t x = 0; x <= teeth; ++x)
    for (std::size_t y = 0; y <= length; ++y) mesh.positions.push_back({double(x), double(y), 0.0});
  for (std::size_t x = 0; x < teeth; ++x)
    for (std::size_t y = 0; y < length; ++y) {
      if (x % 2 == 1 && y > 0) continue;
      mesh.faces.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
      mesh.faces.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  return mesh;
}

TEST(ChartSizes, BranchingSurfacesStayBelowTheCeiling) {
  const IndexedMesh mesh = canonical(comb(100, 300));
  for (const std::uint32_t target : {100U, 450U, 1000U}) {
    Options options;
    options.target_faces = target;
    const Charts charts = chartify(mesh, options);
    check_charts(mesh, charts);
    EXPECT_LE(spread_of(charts, target).largest, 1.6) << target;
  }
}

TEST(ChartSizes, AsSmallAsOneFace) {
  const IndexedMesh mesh = canonical(ramcdb::test::torus(500));
  Options options;
  options.target_faces = 1;
  const Charts charts = chartify(mesh, options);
  check_charts(mesh, charts);
  EXPECT_EQ(charts.chart_count, mesh.faces.size());
}

TEST(ChartSizes, TargetsOutOfRangeAreRefused) {
  const IndexedMesh mesh = canonical(ramcdb::test::sphere(100));
  for (const std::uint32_t target : {0U, kMostTargetFaces + 1, ~0U}) {
    Options options;
    options.target_faces = target;
    try {
      (void)chartify(mesh, options);
      FAIL() << target << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace ramcdb::chartify::test
