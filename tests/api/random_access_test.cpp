#include <set>

#include "tests/api/temp_repository.h"

namespace ramcdb::test {
namespace {

std::vector<TestMesh> meshes() {
  return {sphere(6000), torus(5000), terrain(60, 50),          genus3(6000), boxes(200),
          scan(8000),   hourglass(), two_cubes_sharing_edge(), moebius()};
}

TEST(Charts, DecodedAloneAgreeOnEverySharedVertex) {
  for (const TestMesh& mesh : meshes()) {
    TempRepository repository(mesh, 300);
    const Snapshot snapshot = repository->snapshot();
    std::map<VertexKey, LatticePoint> seen;
    std::uint64_t shared = 0;
    for (const ChartId id : snapshot.find({{WholeMesh{}}, 0})) {
      const RegionMesh alone = snapshot.read({id});
      for (std::size_t v = 0; v < alone.keys.size(); ++v) {
        const auto [it, is_new] = seen.emplace(alone.keys[v], alone.points[v]);
        shared += !is_new;
        ASSERT_EQ(it->second, alone.points[v]);
      }
    }
    EXPECT_EQ(seen.size(), mesh.positions.size());
    if (snapshot.info().charts > 1 && snapshot.info().wires > 1) {
      EXPECT_GT(shared, 0U);
    }
  }
}

TEST(Charts, OneReadsItsBlobItsWiresAndFewPages) {
  TempRepository repository(terrain(260, 260), 300);
  const auto info = repository->snapshot().info();
  ASSERT_GT(info.charts, 300U);
  std::uint64_t whole_bytes = info.bytes.payload;
  for (const std::uint32_t id : {1U, 57U, 200U, 301U}) {
    const Snapshot cold = repository->snapshot();
    ReadCost cost;
    const RegionMesh region = cold.read({ChartId(id)}, 1, &cost);
    std::set<std::uint32_t> wires;
    for (const VertexKey key : region.keys)
      if (key.where == VertexKey::Where::wire) wires.insert(key.id);
    EXPECT_LE(cost.pages, 4U);
    EXPECT_LE(cost.blobs, 1 + wires.size() + cost.pages);  // some wires share a blob
    EXPECT_LT(cost.bytes * 20, whole_bytes);
  }
}

TEST(Region, FindsWhatAFullScanFinds) {
  TempRepository repository(scan(8000), 200);
  const Snapshot snapshot = repository->snapshot();
  const auto all = snapshot.find({{WholeMesh{}}, 0});
  const auto charts = snapshot.describe(all);
  const MeshInfo info = snapshot.info();
  const Point mid{(info.lo.x + info.hi.x) / 2, (info.lo.y + info.hi.y) / 2, (info.lo.z + info.hi.z) / 2};

  const InBox box{mid, info.hi};
  std::vector<ChartId> expected;
  for (const ChartSummary& c : charts) {
    bool meets = true;
    for (int a = 0; a < 3; ++a) meets = meets && c.hi[a] >= box.lo[a] && c.lo[a] <= box.hi[a];
    if (meets) expected.push_back(c.id);
  }
  EXPECT_EQ(snapshot.find({{box}, 0}), expected);
  EXPECT_LT(expected.size(), all.size());

  const double radius = (info.hi.x - info.lo.x) / 6;
  const InSphere ball{info.hi, radius};
  expected.clear();
  for (const ChartSummary& c : charts) {
    double d = 0;
    for (int a = 0; a < 3; ++a) {
      const double out = std::max({c.lo[a] - ball.center[a], 0.0, ball.center[a] - c.hi[a]});
      d += out * out;
    }
    if (d <= radius * radius) expected.push_back(c.id);
  }
  if (expected.empty())
    EXPECT_THROW((void)snapshot.find({{ball}, 0}), Error);
  else
    EXPECT_EQ(snapshot.find({{ball}, 0}), expected);

  // The clip matrix that scales the box's lower half along x to the unit cube.
  InFrustum half;
  const double sx = 4 / (info.hi.x - info.lo.x);
  half.clip = {sx, 0, 0, -1 - sx * info.lo.x, 0, 1e-9, 0, 0, 0, 0, 1e-9, 0, 0, 0, 0, 1};
  expected.clear();
  for (const ChartSummary& c : charts)
    if (c.lo.x <= mid.x) expected.push_back(c.id);
  EXPECT_EQ(snapshot.find({{half}, 0}), expected);
}

TEST(Region, NearestIsTheChartOfTheNearestVertex) {
  TempRepository repository(scan(8000), 200);
  const Snapshot snapshot = repository->snapshot();
  const RegionMesh mesh = whole(snapshot);
  for (const Point p : {Point{0, 0, 0}, Point{3, -1, 0.5}, Point{0.2, 0.9, -0.4}}) {
    double best = 1e300;
    std::set<ChartId> candidates;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (const std::uint32_t v : mesh.faces[f]) {
        const Point q = snapshot.position(mesh.points[v]);
        const double d = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z);
        if (d < best) candidates.clear();
        if (d <= best) candidates.insert(mesh.charts[mesh.chart_of_face[f]]);
        best = std::min(best, d);
      }
    EXPECT_EQ(snapshot.find({{NearestTo{p}}, 0}), std::vector<ChartId>{*candidates.begin()});
  }
}

TEST(Region, GrowsByChartsThatShareAVertex) {
  TempRepository repository(scan(8000), 200);
  const Snapshot snapshot = repository->snapshot();
  const RegionMesh mesh = whole(snapshot);
  std::map<std::uint32_t, std::set<ChartId>> charts_at;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) charts_at[v].insert(mesh.charts[mesh.chart_of_face[f]]);
  const ChartId start(5);
  std::set<ChartId> ring{start};
  for (int grow = 0; grow < 3; ++grow) {
    EXPECT_EQ(snapshot.find({{OfCharts{{start}}}, static_cast<unsigned>(grow)}),
              std::vector<ChartId>(ring.begin(), ring.end()));
    std::set<ChartId> next = ring;
    for (const auto& [v, charts] : charts_at)
      if (std::any_of(charts.begin(), charts.end(), [&](ChartId c) { return ring.contains(c); }))
        next.insert(charts.begin(), charts.end());
    ring = next;
  }
}

TEST(Region, TextsAreReadOrRefused) {
  EXPECT_EQ(parse_box("0,1,2,3,4,5.5").hi.z, 5.5);
  EXPECT_EQ(parse_sphere("-1,0,1e2,3").center.z, 100);
  EXPECT_EQ(parse_charts("5,9-11").charts, (std::vector<ChartId>{ChartId(5), ChartId(9), ChartId(10), ChartId(11)}));
  for (const char* bad : {"", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,6,7", "0,0,0,-1,1,1", "nan,0,0,1,1,1", "1,,2,3,4,5"})
    EXPECT_THROW((void)parse_box(bad), Error) << bad;
  for (const char* bad : {"", "0", "5-", "-5", "9-5", "1,2,x", "99999999999", "1-4000000000"})
    EXPECT_THROW((void)parse_charts(bad), Error) << bad;
  EXPECT_THROW((void)parse_sphere("0,0,0,-1"), Error);
}

TEST(Snapshot, UnknownChartIsNotFound) {
  TempRepository repository(sphere(2000));
  try {
    (void)repository->snapshot().read({ChartId(4711)});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::not_found);
  }
}

}  // namespace
}  // namespace ramcdb::test
