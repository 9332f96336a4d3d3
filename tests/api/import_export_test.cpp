#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "tests/api/blobs_of.h"
#include "tests/api/numbered_edits.h"
#include "tests/api/painted_grid.h"
#include "tests/api/temp_repository.h"

namespace ramcdb::test {
namespace {

struct Family {
  const char* name;
  TestMesh mesh;
};

std::vector<Family> families() {
  return {{"sphere", sphere(6000)},
          {"torus", torus(5000)},
          {"terrain", terrain(60, 50)},
          {"genus3", genus3(6000)},
          {"components", several_components()},
          {"boxes", boxes(200)},
          {"scan", scan(8000)},
          {"moebius", moebius()},
          {"two cubes on an edge", two_cubes_sharing_edge()},
          {"hourglass", hourglass()},
          {"three faces on an edge", three_faces_one_edge()},
          {"degenerate and duplicate", degenerate_and_duplicate_faces()},
          {"isolated vertices", isolated_vertices()}};
}

TEST(Import, ThenExportGivesTheSameTrianglesOnTheLattice) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    TempRepository repository(family.mesh);
    const Snapshot snapshot = repository->snapshot();
    const auto expected = face_set(snapped(snapshot.lattice(), family.mesh.positions), family.mesh.faces);
    EXPECT_EQ(face_set(whole(snapshot)), expected);
    for (const char* name : {"out.ply", "out.obj", "out.off"}) {
      const auto report = repository->export_mesh(snapshot, repository / name, {});
      EXPECT_EQ(face_set_of_file(snapshot.lattice(), repository / name), expected) << name;
      EXPECT_EQ(report.faces, family.mesh.faces.size());
      EXPECT_EQ(report.vertices, family.mesh.positions.size()) << "no vertex is lost or doubled";
    }
  }
}

TEST(Import, CountsEveryVertexOnce) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    TempRepository repository(family.mesh);
    auto points = whole(repository->snapshot()).points;
    auto expected = snapped(repository->snapshot().lattice(), family.mesh.positions);
    std::sort(points.begin(), points.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(points, expected);
    EXPECT_EQ(repository.import_report().info.vertices, family.mesh.positions.size());
  }
}

TEST(Import, MovesNoCoordinateByMoreThanHalfAStep) {
  for (const unsigned bits : {8U, 12U, 16U, 20U}) {
    TempRepository repository(terrain(40, 40), 500, bits);
    const ImportReport& report = repository.import_report();
    EXPECT_LE(report.measured_error, report.info.max_error * (1 + 1e-9)) << bits << " bits";
    EXPECT_GT(report.measured_error, 0);
  }
}

TEST(Import, OfAnExportOnTheSameLatticeGivesTheSameBytes) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    TempRepository repository(family.mesh);
    for (const char* name : {"again.ply", "again.obj"}) {
      (void)repository->export_mesh(repository->snapshot("mesh"), repository / name, {});
      ImportOptions options;
      options.name = name;
      options.lattice = repository->snapshot("mesh").lattice();
      options.chart_faces = 500;
      (void)repository->import(repository / name, options);
      EXPECT_EQ(blobs_of(*repository, "mesh"), blobs_of(*repository, name)) << name;
    }
  }
}

/// Against two threads, which share faces in pieces of 2^16.
TEST(Import, DoesNotDependOnOrderOrThreads) {
  const TestMesh mesh = scan(140'000);
  TempRepository repository(mesh);
  write_test_mesh(shuffled(mesh, 7), repository / "shuffled.ply");
  ImportOptions options;
  options.name = "shuffled";
  options.bits = 14;
  options.chart_faces = 500;
  options.threads = 1;
  (void)repository->import(repository / "shuffled.ply", options);
  EXPECT_EQ(blobs_of(*repository, "mesh"), blobs_of(*repository, "shuffled"));
}

Repository& imported(TempFolder& folder, std::optional<Repository>& repository, const TestMesh& mesh,
                     ChartProfile profile) {
  Repository::create(folder / "r.ramcdb");
  repository.emplace(Repository::open(folder / "r.ramcdb"));
  write_test_mesh(mesh, folder / "input.ply");
  ImportOptions options;
  options.name = "mesh";
  options.bits = 14;
  options.chart_faces = 500;
  options.profile = profile;
  (void)repository->import(folder / "input.ply", options);
  return *repository;
}

/// Numbers that suit the mesh are one blob; charts that are edited later are coded with them, too.
TEST(Import, TrainsACoderTableThatEditsKeepUsing) {
  const TestMesh mesh = terrain(160, 150);
  for (const ChartProfile profile : {ChartProfile::dense, ChartProfile::fast}) {
    TempFolder folder;
    std::optional<Repository> at;
    Repository& repository = imported(folder, at, mesh, profile);
    EXPECT_EQ(repository.snapshot().info().profile, profile == ChartProfile::dense ? "dense" : "fast");
    const std::uint64_t charts = repository.snapshot().info().charts;
    EXPECT_EQ(count_blobs(repository, VersionId(1), db::Kind::table, 3), 1U);
    const NumberedEdits edits(repository);
    (void)edits.commit(repository, 1);
    EXPECT_EQ(count_blobs(repository, VersionId(2), db::Kind::table, 3), 0U);
    EXPECT_GT(count_blobs(repository, VersionId(2), db::Kind::chart, charts), 0U);
    EXPECT_TRUE(repository.verify({}).ok());
    const std::uint64_t before = repository.snapshot({}, "v1").info().bytes.geometry,
                        after = repository.snapshot().info().bytes.geometry;
    EXPECT_LT(after, before * 11 / 10) << "as dense as before";
  }
}

/// Every kind of mesh comes out of both profiles alike.
TEST(Import, InTheFastProfileGivesTheSameTriangles) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    TempFolder folder;
    std::optional<Repository> at;
    Repository& repository = imported(folder, at, family.mesh, ChartProfile::fast);
    const Snapshot snapshot = repository.snapshot();
    EXPECT_EQ(face_set(whole(snapshot)),
              face_set(snapped(snapshot.lattice(), family.mesh.positions), family.mesh.faces));
    EXPECT_TRUE(repository.verify({}).ok());
  }
}

TEST(Import, RefusesWhatItCannotTakeWholeAndChangesNothing) {
  TempRepository repository(sphere(500));
  const auto refused = [&](const char* name, const std::string& text, Errc code) {
    std::ofstream(repository / name) << text;
    ImportOptions options;
    options.name = "other";
    try {
      (void)repository->import(repository / name, options);
      ADD_FAILURE() << name << " was taken";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), code) << e.what();
    }
  };
  refused("nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", Errc::invalid_argument);
  refused("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", Errc::invalid_argument);
  refused("empty.off", "OFF\n0 0 0\n", Errc::invalid_argument);
  refused("short.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", Errc::invalid_argument);
  refused("what.xyz", "1 2 3\n", Errc::invalid_argument);
  ImportOptions taken;
  taken.name = "mesh";
  EXPECT_THROW((void)repository->import(repository / "input.ply", taken), Error);
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
  EXPECT_EQ(repository->meshes().size(), 1U);
}

TEST(Import, ADryRunReportsAndWritesNothing) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  write_test_mesh(scan(3000), folder / "scan.ply");
  ImportOptions options;
  options.chart_faces = 300;
  options.dry_run = true;
  const ImportReport tried = repository.import(folder / "scan.ply", options);
  EXPECT_EQ(tried.info.revision, VersionId());
  EXPECT_TRUE(repository.meshes().empty());
  EXPECT_TRUE(repository.log().empty());
  options.dry_run = false;
  const ImportReport done = repository.import(folder / "scan.ply", options);
  EXPECT_EQ(done.info.revision, VersionId(1));
  EXPECT_EQ(tried.info.charts, done.info.charts);
  EXPECT_EQ(tried.info.bytes.payload, done.info.bytes.payload);
  EXPECT_EQ(tried.measured_error, done.measured_error);
  options.dry_run = true;
  EXPECT_THROW((void)repository.import(folder / "scan.ply", options), Error) << "the name is taken";
}

TEST(Import, WeldsSoupsUnlessToldOtherwise) {
  const TestMesh mesh = sphere(400);
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  write_test_mesh(mesh, folder / "soup.stl");
  TestMesh twice = mesh;
  twice.positions.insert(twice.positions.end(), mesh.positions.begin(), mesh.positions.end());
  write_test_mesh(twice, folder / "twice.ply");
  const auto vertices = [&](const char* file, std::optional<bool> weld) {
    ImportOptions options;
    options.name = file + std::to_string(weld ? 1 + *weld : 0);
    options.weld = weld;
    return repository.import(folder / file, options).info.vertices;
  };
  const std::size_t count = mesh.positions.size();
  EXPECT_EQ(vertices("soup.stl", {}), count);
  EXPECT_EQ(vertices("soup.stl", false), 3 * mesh.faces.size());
  EXPECT_EQ(vertices("twice.ply", {}), 2 * count);
  EXPECT_EQ(vertices("twice.ply", true), count);
}

TEST(Export, OfTheFinestLatticeIsExact) {
  TempRepository repository(scan(500), 200, 30);
  const Snapshot snapshot = repository->snapshot();
  for (const char* name : {"out.ply", "out.obj"}) {
    (void)repository->export_mesh(snapshot, repository / name, {});
    EXPECT_TRUE(face_set_of_file(snapshot.lattice(), repository / name) == face_set(whole(snapshot))) << name;
  }
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Export, WritesTheSameFileWithNoMemoryToSpeakOf) {
  for (const auto& [name, mesh] : families()) {
    TempRepository repository(mesh, 300);
    const Snapshot snapshot = repository->snapshot();
    for (const Paint paint : {Paint::none, Paint::version}) {
      FileOptions options;
      options.paint = paint;
      (void)repository->export_mesh(snapshot, repository / "all.ply", options);
      options.memory = 1;  // a chart at a time, all else in a file
      (void)repository->export_mesh(snapshot, repository / "little.ply", options);
      EXPECT_EQ(bytes_of(repository / "little.ply"), bytes_of(repository / "all.ply")) << name;
    }
    EXPECT_TRUE(face_set_of_file(snapshot.lattice(), repository / "little.ply") == face_set(whole(snapshot))) << name;
  }
}

TEST(Export, OfPolygonsAndAttributesNeedsNoMemoryEither) {
  for (const bool lossless : {false, true}) {
    Painted repository(painted_grid(40), lossless);
    const Snapshot snapshot = repository->snapshot();
    for (const std::string ending : {"ply", "obj", "off", "stl", "glb"}) {
      FileOptions options;
      const CheckoutReport all = repository->export_mesh(snapshot, repository / ("all." + ending), options);
      options.memory = 1;
      const CheckoutReport little = repository->export_mesh(snapshot, repository / ("little." + ending), options);
      EXPECT_EQ(little.vertices, all.vertices);
      EXPECT_EQ(little.faces, all.faces);
      EXPECT_EQ(bytes_of(repository / ("little." + ending)), bytes_of(repository / ("all." + ending))) << ending;
    }
  }
}

TEST(Export, OfGeoreferencedCoordinatesKeepsThem) {
  TestMesh mesh = terrain(30, 30);
  for (Point& p : mesh.positions) {
    p.x += 566000.25;
    p.y += 5120000.5;
  }
  TempRepository repository(mesh, 500, 20);
  const Snapshot snapshot = repository->snapshot();
  for (const char* name : {"utm.ply", "utm.obj", "utm.off"}) {
    (void)repository->export_mesh(snapshot, repository / name, {});
    EXPECT_EQ(face_set_of_file(snapshot.lattice(), repository / name), face_set(whole(snapshot))) << name;
  }
}

TEST(Info, PartsAddUpToThePayload) {
  TempRepository repository(scan(8000));
  const MeshBytes b = repository->snapshot().info().bytes;
  EXPECT_EQ(b.payload, b.wire_net + b.wires + b.connectivity + b.geometry + b.chart_headers + b.attributes + b.tables);
  EXPECT_GT(b.geometry, b.connectivity);
  EXPECT_GT(b.store, b.payload);
}

/// The counts of edges and faces that `info` gives.
std::vector<std::uint64_t> counts_of(const MeshInfo& info) {
  return {info.vertices,          info.faces,
          info.components,        info.boundary_loops,
          info.nonmanifold_edges, info.nonmanifold_vertices,
          info.duplicate_faces,   info.inconsistent_edges};
}

TEST(Import, CountsPolygonsWholeAndSoDoEdits) {
  TempFolder folder;
  // Five quads at the edge 1-2, one of them turned over upon another, and a quad far away.
  std::ofstream(folder / "quads.obj") << "v 0 0 0\nv 0 0 9\nv 9 0 0\nv 9 0 9\nv 0 9 0\nv 0 9 9\nv 0 -9 0\nv 0 -9 9\n"
                                         "v -9 0 0\nv -9 0 9\nv 50 0 0\nv 50 0 9\nv 59 0 9\nv 59 0 0\n"
                                         "f 1 2 4 3\nf 2 1 5 6\nf 1 2 8 7\nf 2 1 9 10\nf 10 9 1 2\nf 11 12 13 14\n";
  Repository::create(folder / "r.ramcdb");
  Repository repository = Repository::open(folder / "r.ramcdb");
  ImportOptions importing;
  importing.bits = 12;
  const MeshInfo info = repository.import(folder / "quads.obj", importing).info;
  EXPECT_EQ(info.polygons, 6U);
  EXPECT_EQ(info.nonmanifold_edges, 1U) << "no diagonal of the two quads in one place";
  EXPECT_EQ(info.duplicate_faces, 1U);

  const Snapshot before = repository.snapshot();
  (void)repository.checkout_file(before, before.find({{WholeMesh{}}, 0}), folder / "edited.obj", {});
  std::ifstream in(folder / "edited.obj");
  std::string text, line;
  for (int faces = 0; std::getline(in, line);)
    if (!line.starts_with("f ") || ++faces > 2) text += line + "\n";
  std::ofstream(folder / "edited.obj") << text;
  CommitOptions options;
  options.message = "two quads less";
  (void)repository.commit_file(folder / "edited.obj", options);
  const Snapshot after = repository.snapshot();
  (void)repository.export_mesh(after, folder / "now.obj", {});
  importing.lattice = after.lattice();
  const MeshInfo afresh = repository.import(folder / "now.obj", importing).info;
  EXPECT_EQ(counts_of(after.info()), counts_of(afresh));
  EXPECT_EQ(after.info().polygons, 4U);
}

}  // namespace
}  // namespace ramcdb::test
