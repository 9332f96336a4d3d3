#include <bit>
#include <cmath>
#include <random>
#include <set>

#include "db/store.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/blobs_of.h"
#include "tests/api/temp_repository.h"

/// Meshes whose positions are kept to the last bit, through edits too.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;
using mesh_file::MeshData;
using mesh_file::Scalar;
using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const Point& p) {
  return {std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), std::bit_cast<std::uint64_t>(p.z)};
}

/// Faces with the bits of their positions, each from its smallest corner on, and all positions; sorted.
using BitFaces = std::vector<std::vector<Bits>>;
BitFaces bit_faces(const std::vector<Point>& positions, const std::vector<std::uint32_t>& corners) {
  BitFaces faces;
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    std::vector<Bits> face, best;
    for (std::size_t i = 0; i < 3; ++i) face.push_back(bits_of(positions[corners[c + i]]));
    best = face;
    for (int turn = 0; turn < 2; ++turn) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
      best = std::min(best, face);
    }
    faces.push_back(best);
  }
  for (const Point& p : positions) faces.push_back({bits_of(p)});
  std::sort(faces.begin(), faces.end());
  return faces;
}
BitFaces bit_faces(const fs::path& file) {
  const MeshData mesh = mesh_file::read_mesh(file);
  return bit_faces(mesh.positions, mesh.corners);
}

void write(const TestMesh& mesh, const fs::path& file, Scalar scalar) {
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : mesh.faces) corners.insert(corners.end(), t.begin(), t.end());
  mesh_file::MeshOutput out;
  out.positions = mesh.positions;
  out.corners = corners;
  out.scalar = scalar;
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

/// A fresh repository with one lossless mesh.
class Lossless {
 public:
  explicit Lossless(const TestMesh& mesh, Scalar scalar = Scalar::float32, std::uint32_t chart_faces = 400) {
    Repository::create(folder_ / "r.ramcdb");
    repository_.emplace(Repository::open(folder_ / "r.ramcdb"));
    write(mesh, input(), scalar);
    ImportOptions options;
    options.name = "mesh";
    options.lossless = true;
    options.chart_faces = chart_faces;
    report_ = repository_->import(input(), options);
  }
  [[nodiscard]] Repository* operator->() { return &*repository_; }
  [[nodiscard]] fs::path operator/(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] fs::path input() const { return folder_ / "input.ply"; }
  [[nodiscard]] const ImportReport& report() const { return report_; }
  [[nodiscard]] BitFaces exported(const std::string& name, std::string_view revision = {}) {
    (void)repository_->export_mesh(repository_->snapshot("mesh", revision), folder_ / name, {});
    return bit_faces(folder_ / name);
  }
  [[nodiscard]] std::size_t written(VersionId version, db::Kind kind) const {
    return count_blobs(*repository_, version, kind, report_.info.charts);
  }

 private:
  TempFolder folder_;
  std::optional<Repository> repository_;
  ImportReport report_;
};

/// The mesh with every coordinate changed.
template <class Change>
TestMesh changed(TestMesh mesh, Change&& change) {
  for (Point& p : mesh.positions)
    for (int a = 0; a < 3; ++a) p[a] = change(p[a]);
  return mesh;
}
double as_float(double x) { return static_cast<double>(static_cast<float>(x)); }

TEST(LosslessMesh, ComesOutBitByBit) {
  const std::pair<const char*, TestMesh> kMeshes[] = {{"scan", scan(6000)},
                                                      {"components", several_components()},
                                                      {"boxes", boxes(100)},
                                                      {"three sheets", three_faces_one_edge()},
                                                      {"moebius", moebius()},
                                                      {"degenerate", degenerate_and_duplicate_faces()},
                                                      {"isolated", isolated_vertices()}};
  for (const auto& [name, mesh] : kMeshes) {
    SCOPED_TRACE(name);
    for (const Scalar scalar : {Scalar::float32, Scalar::float64}) {
      const bool floats = scalar == Scalar::float32;
      Lossless repository(floats ? changed(mesh, as_float) : mesh, scalar);
      EXPECT_TRUE(repository.report().info.lossless);
      EXPECT_EQ(repository.report().info.max_error, 0);
      EXPECT_EQ(repository.report().measured_error, 0);
      const BitFaces before = bit_faces(repository.input());
      EXPECT_TRUE(repository.exported("out.ply") == before);
      (void)repository.exported("out.obj");
      MeshData text = mesh_file::read_mesh(repository / "out.obj");  // 0.1F is written as 0.1
      for (Point& p : text.positions)
        for (int a = 0; floats && a < 3; ++a) p[a] = as_float(p[a]);
      EXPECT_TRUE(bit_faces(text.positions, text.corners) == before);
      EXPECT_TRUE(repository->verify({}).ok());
    }
  }
}

TEST(LosslessMesh, KeepsSignedZerosTinyAndFarNumbers) {
  TestMesh mesh = terrain(20, 20);
  std::mt19937 random(1);
  for (Point& p : mesh.positions) {
    p = {std::floor(p.x * 8) / 8 + 6'378'137, as_float(p.y * 1e-30), p.z};
    if (random() % 3 == 0) p.z = random() % 2 ? 0.0 : -0.0;
    if (random() % 50 == 0) p.z = 1e-310;
  }
  Lossless repository(mesh, Scalar::float64);
  EXPECT_TRUE(repository.exported("out.ply") == bit_faces(repository.input()));
}

TEST(LosslessMesh, IsSmallWhereItsNumbersAreShort) {
  const auto bits = [](const TestMesh& mesh, Scalar scalar) {
    Lossless repository(mesh, scalar, 5000);
    const MeshInfo info = repository.report().info;
    return 8.0 * static_cast<double>(info.bytes.payload) / static_cast<double>(info.vertices);
  };
  const auto rounded = [](double x, double per_unit) { return std::floor(x * per_unit + 0.5) / per_unit; };
  const TestMesh mesh = scan(40000);
  const double on_decimals = bits(changed(mesh, [&](double x) { return rounded(x, 1e4); }), Scalar::float64);
  const double on_floats = bits(changed(mesh, as_float), Scalar::float32);
  EXPECT_LT(on_decimals, 30);
  EXPECT_LT(on_floats, 70);
  EXPECT_NEAR(bits(changed(mesh, [&](double x) { return as_float(rounded(x, 1e4)); }), Scalar::float32), on_decimals, 1)
      << "decimal fractions that a program kept as float32";
}

TEST(LosslessMesh, MovesByLessThanAStepAreKeptAndCostNoChart) {
  Lossless repository(changed(scan(4000), as_float));
  const double step = repository.report().info.lattice.step;
  EditTransaction edit = repository->begin_edit();
  Patch& patch = edit.checkout({{OfCharts{{ChartId(2)}}}, 0});
  std::map<std::uint64_t, Point> expected;
  const Snapshot base = edit.base();
  for (const auto v : patch.mesh().all_vertices()) {
    if (v.idx() % 5 != 0) continue;
    auto p = patch.mesh().point(v);
    const LatticePoint before = base.lattice().snap({p[0], p[1], p[2]});
    for (const double up : {1e-7, -1e-7})
      if (base.lattice().snap(as_float(p[2] * (1 + up)), 2) == before.z) {
        p[2] = as_float(p[2] * (1 + up));
        break;
      }
    patch.mesh().set_point(v, p);
    expected[patch.mesh().property(patch.key_property(), v)] = {p[0], p[1], p[2]};
  }
  const ChangeReport status = edit.status();
  EXPECT_GT(status.vertices_moved, 10U);
  EXPECT_GT(status.max_displacement, 0);
  EXPECT_LT(status.max_displacement, step);
  const CommitReport report = edit.commit(message("a breath"));
  EXPECT_EQ(report.vertices_moved, status.vertices_moved);
  EXPECT_EQ(report.charts_reencoded, 0U);
  EXPECT_EQ(report.wires_reencoded, 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::chart), 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::wire), 0U);
  EXPECT_GE(repository.written(report.revision, db::Kind::attribute), 1U);

  const Snapshot now = repository->snapshot("mesh");
  const RegionMesh mesh = whole(now), was = whole(base);
  ASSERT_EQ(mesh.keys, was.keys);
  for (std::size_t v = 0; v < mesh.keys.size(); ++v) {
    const auto it = expected.find(mesh.keys[v].packed());
    EXPECT_EQ(bits_of(mesh.exact[v]), bits_of(it == expected.end() ? was.exact[v] : it->second));
  }
  const DiffReport diff = repository->diff(base, now);
  EXPECT_EQ(diff.vertices_moved, status.vertices_moved);
  EXPECT_EQ(diff.max_displacement, status.max_displacement);
  EXPECT_TRUE(repository.exported("first.ply", "1") == bit_faces(repository.input()));
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(LosslessMesh, FarMovesOfEveryKindOfVertexAreKept) {
  Lossless repository(scan(4000), Scalar::float64);
  const RegionMesh was = whole(repository->snapshot("mesh"));
  EditTransaction edit = repository->begin_edit();
  Patch& patch = edit.checkout({{WholeMesh{}}, 0});
  std::map<std::uint64_t, Point> expected;
  std::set<VertexKey::Where> kinds;
  for (const auto v : patch.mesh().all_vertices()) {
    const std::uint64_t key = patch.mesh().property(patch.key_property(), v);
    if (v.idx() % 37 != 0 && VertexKey::unpack(key).where != VertexKey::Where::corner) continue;
    kinds.insert(VertexKey::unpack(key).where);
    auto p = patch.mesh().point(v);
    p *= 1.1 + 1e-9 * v.idx();
    patch.mesh().set_point(v, p);
    expected[key] = {p[0], p[1], p[2]};
  }
  EXPECT_EQ(kinds.size(), 3U);
  EXPECT_EQ(edit.commit(message("outwards")).vertices_moved, expected.size());
  const RegionMesh mesh = whole(repository->snapshot("mesh"));
  std::multiset<Bits> found, wanted;
  for (const Point& p : mesh.exact) found.insert(bits_of(p));
  for (std::size_t v = 0; v < was.keys.size(); ++v) {
    const auto it = expected.find(was.keys[v].packed());
    wanted.insert(bits_of(it == expected.end() ? was.exact[v] : it->second));
  }
  EXPECT_TRUE(found == wanted);
  // Every chart that shares a vertex says the same of it.
  std::map<VertexKey, Bits> shared;
  for (const ChartId chart : mesh.charts) {
    const RegionMesh alone = repository->snapshot("mesh").read({chart});
    for (std::size_t v = 0; v < alone.keys.size(); ++v)
      if (alone.keys[v].where != VertexKey::Where::chart) {
        EXPECT_EQ(shared.emplace(alone.keys[v], bits_of(alone.exact[v])).first->second, bits_of(alone.exact[v]));
      }
  }
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(LosslessMesh, FilesGoOutAndInWithoutAChange) {
  Lossless repository(changed(scan(3000), as_float));
  const Snapshot snapshot = repository->snapshot("mesh");
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
    const fs::path file = repository / name;
    (void)repository->checkout_file(snapshot, snapshot.find({{OfCharts{{ChartId(1)}}}, 1}), file, {});
    EXPECT_TRUE(repository->status_file(file).clean()) << name;
    EXPECT_TRUE(repository->commit_file(file, message("nothing")).nothing_changed) << name;
  }
}

TEST(LosslessMesh, OthersWorkOnTheSameChartIsAConflict) {
  Lossless repository(changed(scan(3000), as_float));
  const auto lift = [](EditTransaction& edit, ChartId chart, double by) {
    Patch& patch = edit.checkout({{OfCharts{{chart}}}, 0});
    for (const auto v : patch.mesh().all_vertices())
      if (VertexKey::unpack(patch.mesh().property(patch.key_property(), v)).where == VertexKey::Where::chart) {
        auto p = patch.mesh().point(v);
        p[2] += by;
        patch.mesh().set_point(v, p);
        return;
      }
  };
  EditTransaction first = repository->begin_edit(), second = repository->begin_edit(), third = repository->begin_edit();
  lift(first, ChartId(1), 1e-4);
  lift(second, ChartId(1), 2e-4);
  lift(third, ChartId(3), 1e-4);
  EXPECT_TRUE(first.commit(message("first")).conflicts.empty());
  EXPECT_EQ(second.commit(message("second")).conflicts, std::vector<ChartId>{ChartId(1)});
  EXPECT_TRUE(third.commit(message("third")).conflicts.empty());
}

struct PreciseCase {
  const char* name;
  double per_unit;   ///< of the file's coordinates; 0: full doubles
  double precision;  ///< asked for
  double step;       ///< expected
};

TEST(Precision, StepsAreRoundWhereThatCostsNothing) {
  const PreciseCase kCases[] = {{"millimetres in metres", 1000, 0.0005, 0.001},
                                {"coarser than asked for", 10, 0.0005, 0.001},
                                {"a little finer than asked for", 1000, 0.0007, 0.001},
                                {"fifths", 5, 0.15, 0.2},
                                {"binary fractions", 64, 0.01, 1.0 / 64},
                                {"twice a round number", 0, 0.0005, 0.001},
                                {"near a round number", 0, 0.00052, 0.001},
                                {"near a power of two", 0, 0.0041, 1.0 / 128},
                                {"no round number", 0, 0.00035, 0.0007}};
  for (const PreciseCase& c : kCases) {
    SCOPED_TRACE(c.name);
    const TempFolder folder;
    Repository::create(folder / "r");
    Repository repository = Repository::open(folder / "r");
    TestMesh mesh = changed(scan(2000), [&](double x) {
      return c.per_unit != 0 ? std::floor((3 + x) * c.per_unit + 0.5) / c.per_unit : 3 + x;
    });
    write(mesh, folder / "in.ply", Scalar::float64);
    ImportOptions options;
    options.precision = c.precision;
    const ImportReport report = repository.import(folder / "in.ply", options);
    EXPECT_EQ(report.info.lattice.step, c.step);
    EXPECT_LE(report.measured_error, c.precision);
    EXPECT_EQ(report.measured_error == 0, c.per_unit != 0);
    if (c.per_unit == 0) continue;
    (void)repository.export_mesh(repository.snapshot(), folder / "out.ply", {});
    EXPECT_TRUE(bit_faces(folder / "out.ply") == bit_faces(folder / "in.ply"));
  }
}

/// Metres of a national grid with millimetres, which float32 does not hold.
class Georeferenced : public ::testing::Test {
 protected:
  Georeferenced() {
    Repository::create(folder_ / "r");
    repository_.emplace(Repository::open(folder_ / "r"));
    TestMesh mesh = terrain(40, 40);
    for (Point& p : mesh.positions)
      p = {449'320 + std::floor(p.x * 1e4 + 0.5) / 1000, 5'411'830 + std::floor(p.y * 1e4 + 0.5) / 1000,
           std::floor(p.z * 1e4 + 0.5) / 1000};
    write(mesh, folder_ / "in.ply", Scalar::float64);
    ImportOptions options;
    options.name = "land";
    options.precision = 0.0005;
    options.chart_faces = 500;
    report_ = repository_->import(folder_ / "in.ply", options);
  }
  CheckoutReport checkout(const fs::path& file, std::optional<bool> local_origin = {}) {
    const Snapshot snapshot = repository_->snapshot();
    FileOptions options;
    options.local_origin = local_origin;
    return repository_->checkout_file(snapshot, snapshot.find({{OfCharts{{ChartId(2)}}}, 0}), file, options);
  }

  TempFolder folder_;
  std::optional<Repository> repository_;
  ImportReport report_;
};

TEST_F(Georeferenced, GoesThroughFloat32FilesAndBack) {
  EXPECT_EQ(report_.measured_error, 0);
  for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
    const fs::path file = folder_ / name;
    const CheckoutReport report = checkout(file);
    EXPECT_NEAR(report.local_origin.y, 5'411'830, 1000) << name;
    const MeshData data = mesh_file::read_mesh(file);
    for (const Point& p : data.positions)
      if (data.soup || fs::path(name).extension() == ".ply") {
        EXPECT_EQ(as_float(p.y), p.y) << name;
      }
    EXPECT_TRUE(repository_->status_file(file).clean()) << name;
    EXPECT_TRUE(repository_->commit_file(file, message("nothing")).nothing_changed) << name;
  }
}

TEST_F(Georeferenced, AnEditThereIsAnEditHere) {
  const fs::path file = folder_ / "a.ply";
  const CheckoutReport report = checkout(file);
  MeshData data = mesh_file::read_mesh(file);
  data.positions[7].z = as_float(data.positions[7].z + 0.25);
  const Point there = data.positions[7];
  write_data(data, file, mesh_file::Scalar::float32);
  EXPECT_EQ(repository_->commit_file(file, message("a quarter up")).vertices_moved, 1U);
  const Snapshot snapshot = repository_->snapshot();
  const LatticePoint wanted = snapshot.lattice().snap(
      {there.x + report.local_origin.x, there.y + report.local_origin.y, there.z + report.local_origin.z});
  const RegionMesh mesh = whole(snapshot);
  EXPECT_NE(std::find(mesh.points.begin(), mesh.points.end(), wanted), mesh.points.end());
}

TEST_F(Georeferenced, WholeCoordinatesAreDoubles) {
  const CheckoutReport report = checkout(folder_ / "a.ply", false);
  EXPECT_EQ(report.local_origin, Point{});
  EXPECT_GT(mesh_file::read_mesh(folder_ / "a.ply").positions.front().y, 5e6);
  EXPECT_TRUE(repository_->status_file(folder_ / "a.ply").clean());
  EXPECT_THROW((void)checkout(folder_ / "a.stl", false), Error);
}

TEST(LocalOrigin, IsLeftAloneWhereNumbersAreShort) {
  TempRepository repository(changed(scan(2000), [](double x) { return x + 3; }));
  const Snapshot snapshot = repository->snapshot();
  for (const char* name : {"a.ply", "a.obj"}) {
    const CheckoutReport report = repository->checkout_file(snapshot, {ChartId(1)}, repository / name, {});
    EXPECT_EQ(report.local_origin, Point{}) << name;
  }
  FileOptions options;
  options.local_origin = true;
  const CheckoutReport report = repository->checkout_file(snapshot, {ChartId(1)}, repository / "b.ply", options);
  EXPECT_NE(report.local_origin, Point{});
  EXPECT_TRUE(repository->status_file(repository / "b.ply").clean());
}

}  // namespace
}  // namespace ramcdb::test
