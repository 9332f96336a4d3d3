#include <algorithm>
#include <cmath>

#include "ramcdb/built_in_edits.h"
#include "tests/api/whole_surface.h"

/// Regions moved by a map: exactly those vertices, and neighbours that share some.
namespace ramcdb::test {
namespace {

TransformOptions by(const Matrix& matrix, double falloff = 0) {
  TransformOptions options;
  options.matrix = matrix;
  options.falloff = falloff;
  options.commit.message = "transform";
  options.commit.author = "test";
  return options;
}

Point mapped(const Matrix& m, const Point& p) {
  Point q;
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<std::size_t>(4 * row);
    q[row] = m[at] * p.x + m[at + 1] * p.y + m[at + 2] * p.z + m[at + 3];
  }
  return q;
}

/// The surface with each vertex where `to` takes it.
template <class To>
FaceSet moved_surface(const Snapshot& snapshot, const RegionMesh& region, const To& to) {
  std::vector<LatticePoint> points;
  for (std::size_t v = 0; v < region.points.size(); ++v)
    points.push_back(snapshot.lattice().snap(to(v, snapshot.position(region.points[v]))));
  return face_set(points, region.faces);
}

TEST(Transform, AWholeMeshGoesAlong) {
  const Matrix matrix = rotation({1, 2, 3}, 40, {0.1, 0, 0});
  for (const std::uint32_t chart_faces : {300U, 5000U}) {
    TempRepository repository(scan(5000), chart_faces);
    const Snapshot base = repository->snapshot();
    const FaceSet expected =
        moved_surface(base, whole(base), [&](std::size_t, const Point& p) { return mapped(matrix, p); });
    TransformOptions options = by(matrix);
    options.memory = 1;
    options.commit.threads = 2;
    const CommitReport report = repository->transform({}, kAll, options);
    EXPECT_EQ(report.charts_reencoded, base.info().charts);
    EXPECT_EQ(surface(*repository), expected);
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(Transform, ARegionTakesItsBorderAndNoOtherVertex) {
  TempRepository repository(scan(8000), 300);
  const Snapshot base = repository->snapshot();
  const std::vector<ChartId> charts = base.find({{OfCharts{{ChartId(5)}}}, 1});
  const RegionMesh region = base.read(charts), before = whole(base);
  const Matrix matrix = translation({0.01, -0.02, 0.03});
  const auto moves = [&](std::size_t v, const Point& p) {
    return std::ranges::find(region.keys, before.keys[v]) != region.keys.end() ? mapped(matrix, p) : p;
  };
  const FaceSet expected = moved_surface(base, before, moves);
  const CommitReport report = repository->transform({}, {{OfCharts{charts}}, 0}, by(matrix));
  EXPECT_EQ(surface(*repository), expected);
  EXPECT_EQ(report.charts_touched, charts.size());
  EXPECT_GT(report.charts_reencoded, charts.size());
  EXPECT_LT(report.charts_reencoded, base.info().charts);
  EXPECT_EQ(report.vertices_moved, region.points.size());
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Transform, FalloffFadesOutFromTheShape) {
  const TestMesh mesh = terrain(60, 60);
  TempRepository repository(mesh, 300);
  const Snapshot base = repository->snapshot();
  const MeshInfo info = base.info();
  const Point middle{(info.lo.x + info.hi.x) / 2, (info.lo.y + info.hi.y) / 2, (info.lo.z + info.hi.z) / 2};
  const double radius = (info.hi.x - info.lo.x) / 10, falloff = 2 * radius;
  const Matrix matrix = translation({0, 0, radius});
  const auto moves = [&](std::size_t, const Point& p) {
    const double d = std::max(std::sqrt((p.x - middle.x) * (p.x - middle.x) + (p.y - middle.y) * (p.y - middle.y) +
                                        (p.z - middle.z) * (p.z - middle.z)) -
                                  radius,
                              0.0);
    if (d >= falloff) return p;
    const double x = 1 - d / falloff, w = x * x * (3 - 2 * x);
    return Point{p.x, p.y, p.z + w * radius};
  };
  const FaceSet expected = moved_surface(base, whole(base), moves);
  const CommitReport report = repository->transform({}, {{InSphere{middle, radius}}, 0}, by(matrix, falloff));
  EXPECT_EQ(surface(*repository), expected);
  EXPECT_NEAR(report.max_displacement, radius, base.lattice().step);
  EXPECT_LT(report.charts_reencoded, info.charts);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Transform, AFalloffAroundAPointPullsThere) {
  TempRepository repository(terrain(40, 40), 300);
  const Snapshot base = repository->snapshot();
  const RegionMesh before = whole(base);
  const Point p = base.position(before.points[before.points.size() / 2]);
  const CommitReport report =
      repository->transform({}, {{NearestTo{p}}, 0}, by(translation({0, 0, 100 * base.lattice().step}), 0.05));
  EXPECT_NEAR(report.max_displacement, 100 * base.lattice().step, base.lattice().step / 2);
  EXPECT_THROW((void)repository->transform({}, {{OfCharts{{ChartId(1)}}}, 0}, by(translation({0, 0, 1}), 0.05)), Error);
}

TEST(Transform, LosslessMeshesMoveByTheirOwnPositions) {
  const TempFolder folder;
  Repository::create(folder / "r.ramcdb");
  Repository repository = Repository::open(folder / "r.ramcdb");
  write_test_mesh(scan(3000), folder / "in.ply");
  ImportOptions options;
  options.lossless = true;
  options.chart_faces = 300;
  (void)repository.import(folder / "in.ply", options);
  const auto positions = [&] {
    std::vector<std::array<double, 3>> found;
    for (const Point& p : whole(repository.snapshot()).exact) found.push_back({p.x, p.y, p.z});
    std::ranges::sort(found);
    return found;
  };
  std::vector<std::array<double, 3>> expected;
  for (const auto& p : positions()) expected.push_back({-2 * p[0], p[1] / 2, p[2]});
  std::ranges::sort(expected);
  (void)repository.transform({}, kAll, by(scaling({-2, 0.5, 1}, {0, 0, 0})));
  EXPECT_EQ(positions(), expected);
  EXPECT_TRUE(repository.verify({}).ok());
}

TEST(Transform, NothingMovedWritesNothing) {
  TempRepository repository(scan(2000), 300);
  EXPECT_TRUE(repository->transform({}, kAll, by(translation({0, 0, 0}))).nothing_changed);
  EXPECT_EQ(repository->log().size(), 1U);
}

TEST(Transform, RefusesWhatIsNoAffineMapAndPlacesOffTheLattice) {
  TempRepository repository(scan(2000), 300);
  Matrix projective = translation({0, 0, 0});
  projective[12] = 1;
  EXPECT_THROW((void)repository->transform({}, kAll, by(projective)), Error);
  Matrix broken = translation({std::nan(""), 0, 0});
  EXPECT_THROW((void)repository->transform({}, kAll, by(broken)), Error);
  EXPECT_THROW((void)repository->transform({}, kAll, by(translation({1e12, 0, 0}))), Error);
  EXPECT_THROW((void)rotation({0, 0, 0}, 10, {}), Error);
  EXPECT_EQ(repository->log().size(), 1U);
}

}  // namespace
}  // namespace ramcdb::test
