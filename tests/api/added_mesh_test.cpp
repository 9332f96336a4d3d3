#include <cmath>
#include <limits>

#include "ramcdb/error.h"
#include "tests/api/painted_grid.h"
#include "tests/api/whole_surface.h"

/// Files that are imported into a mesh, as new components of it.
namespace ramcdb::test {
namespace {

TestMesh moved(TestMesh mesh, double by) {
  for (Point& p : mesh.positions) p.x += by;
  return mesh;
}

ImportIntoReport add(TempRepository& repository, const TestMesh& mesh, bool dry_run = false) {
  write_test_mesh(mesh, repository / "added.ply");
  ImportIntoOptions options;
  options.dry_run = dry_run;
  options.commit.author = "test";
  options.commit.threads = 2;
  return repository->import_into("mesh", repository / "added.ply", options);
}

/// The surface with a mesh added.
FaceSet with(const Snapshot& before, const TestMesh& mesh) {
  FaceSet both = surface(whole(before));
  const FaceSet added = face_set(snapped(before.lattice(), mesh.positions), mesh.faces);
  both.insert(both.end(), added.begin(), added.end());
  std::sort(both.begin(), both.end());
  return both;
}

TEST(ImportInto, LargeComponentsGetChartsOfTheirOwn) {
  TempRepository repository(scan(4000), 300);
  const Snapshot before = repository->snapshot();
  const TestMesh mesh = moved(sphere(3000), 3);
  const ImportIntoReport report = add(repository, mesh);
  EXPECT_EQ(report.vertices, mesh.positions.size());
  EXPECT_EQ(report.faces, mesh.faces.size());
  EXPECT_EQ(report.commit.vertices_added, mesh.positions.size());
  EXPECT_GT(report.measured_error, 0);
  EXPECT_LE(report.measured_error, before.lattice().step / 2 * 1.0001);
  EXPECT_EQ(report.commit.charts_reencoded, report.commit.charts_added) << "the others keep their blobs";
  EXPECT_EQ(report.commit.added.front().value, before.info().charts + 1);
  EXPECT_EQ(surface(*repository), with(before, mesh));
  const MeshInfo was = before.info(), is = repository->snapshot().info();
  EXPECT_EQ(is.components, was.components + 1);
  EXPECT_EQ(is.boundary_loops, was.boundary_loops);
  EXPECT_EQ(is.vertices, was.vertices + mesh.positions.size());
  EXPECT_EQ(repository->show("2").operation, "import");
  EXPECT_EQ(repository->show("2").message, "import added.ply");
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(ImportInto, SmallAndOpenAndUglyOnesGoInToo) {
  for (const TestMesh& mesh : {boxes(30), terrain(20, 20), hourglass(), three_faces_one_edge(),
                               degenerate_and_duplicate_faces(), isolated_vertices()}) {
    TempRepository repository(sphere(2000), 300);
    const Snapshot before = repository->snapshot();
    TestMesh small = mesh;
    for (Point& p : small.positions)
      for (int a = 0; a < 3; ++a) p[a] *= 0.05;
    (void)add(repository, small);
    EXPECT_EQ(surface(*repository), with(before, small));
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(ImportInto, DryRunsWriteNothing) {
  TempRepository repository(sphere(2000), 300);
  const ImportIntoReport report = add(repository, boxes(4), true);
  EXPECT_EQ(report.faces, 48U);
  EXPECT_FALSE(report.commit.revision);
  EXPECT_EQ(repository->resolve("HEAD").value, 1U);
}

TEST(ImportInto, RefusesWhatTheLatticeDoesNotReach) {
  TempRepository repository(sphere(2000), 300);
  EXPECT_THROW((void)add(repository, moved(sphere(100), 1e9)), Error);
  EXPECT_EQ(repository->resolve("HEAD").value, 1U);
}

TEST(ImportInto, LosslessMeshesTakeEveryBit) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  ImportOptions options;
  options.name = "mesh";
  options.lossless = true;
  write_test_mesh(scan(2000), folder / "a.ply");
  (void)repository.import(folder / "a.ply", options);
  const TestMesh added = moved(sphere(500), 2.0000001);
  write_test_mesh(added, folder / "b.ply");
  EXPECT_EQ(repository.import_into({}, folder / "b.ply", {}).measured_error, 0);
  const RegionMesh mesh = whole(repository.snapshot());
  std::size_t found = 0;
  for (const Point& p : added.positions)
    found += std::any_of(mesh.exact.begin(), mesh.exact.end(), [&](const Point& q) { return p == q; });
  EXPECT_EQ(found, added.positions.size());
  EXPECT_TRUE(repository.verify({}).ok());
}

TEST(ImportInto, AttributesAndPolygonsComeAlong) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  const mesh_file::MeshData first = painted_grid(24);
  write_data(first, folder / "a.ply");
  ImportOptions options;
  options.name = "mesh";
  (void)repository.import(folder / "a.ply", options);
  const Snapshot before = repository.snapshot();
  mesh_file::MeshData second = first;
  for (Point& p : second.positions) p.z += 1;
  const std::string absent = "heat";
  for (Attribute& attribute : second.attributes)
    if (attribute.info.name == absent) attribute.info.name = "extra";
  write_data(second, folder / "b.ply");
  const ImportIntoReport report = repository.import_into("mesh", folder / "b.ply", {});
  EXPECT_EQ(report.commit.notes.attributes_missing, 1U);
  EXPECT_EQ(std::count_if(report.dropped.begin(), report.dropped.end(),
                          [](const auto& d) { return d.what.find("extra") != std::string::npos; }),
            1);
  EXPECT_EQ(repository.snapshot().info().polygons, 2 * before.info().polygons);
  const RegionMesh was = whole(before), is = whole(repository.snapshot());
  for (std::size_t a = 0; a < is.attributes.size(); ++a) {
    const auto known = [](const Attribute& attribute) {
      return std::count_if(attribute.values.begin(), attribute.values.end(), [](double x) { return !std::isnan(x); });
    };
    const bool missing = is.attributes[a].info.name == absent;
    EXPECT_EQ(known(is.attributes[a]), (missing ? 1 : 2) * known(was.attributes[a])) << is.attributes[a].info.name;
  }
  EXPECT_TRUE(repository.verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
