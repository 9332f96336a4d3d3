#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <random>

#include "tests/api/temp_repository.h"

/// Checked-out files that other programs rewrote.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

struct FileMesh {
  std::vector<Point> positions;
  std::vector<Triangle> faces;
};

FileMesh read(const fs::path& file) {
  mesh_file::MeshData data = mesh_file::read_mesh(file);
  FileMesh mesh{data.positions, {}};
  for (std::size_t c = 0; c + 2 < data.corners.size(); c += 3)
    mesh.faces.push_back({data.corners[c], data.corners[c + 1], data.corners[c + 2]});
  return mesh;
}

/// In double where the format has it.
void write(const FileMesh& mesh, const fs::path& file) {
  if (!file.extension().string().starts_with(".gl")) return write_test_mesh({mesh.positions, mesh.faces}, file);
  mesh_file::MeshOutput out;
  out.positions = mesh.positions;
  if (!mesh.faces.empty()) out.corners = {mesh.faces.front().data(), 3 * mesh.faces.size()};
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

FileMesh renumbered(const FileMesh& mesh, unsigned seed) {
  const TestMesh shuffled_mesh = shuffled({mesh.positions, mesh.faces}, seed);
  return {shuffled_mesh.positions, shuffled_mesh.faces};
}

/// Every face with three vertices of its own.
FileMesh soup(const FileMesh& mesh) {
  FileMesh out;
  for (const Triangle& t : mesh.faces) {
    Triangle own;
    for (std::size_t i = 0; i < 3; ++i) {
      own[i] = static_cast<std::uint32_t>(out.positions.size());
      out.positions.push_back(mesh.positions[t[i]]);
    }
    out.faces.push_back(own);
  }
  return out;
}

/// How many faces there are at the edges of a face, itself counted three times.
std::size_t faces_around(const FileMesh& mesh, const Triangle& face) {
  const auto shares = [&](const Triangle& t) {
    std::size_t common = 0;
    for (const std::uint32_t v : t) common += static_cast<std::size_t>(std::ranges::count(face, v));
    return common == 3 ? std::size_t{3} : std::size_t{common == 2};
  };
  std::size_t count = 0;
  for (const Triangle& t : mesh.faces) count += shares(t);
  return count;
}

/// The first face with neighbours on all sides, and the first without.
std::size_t inner_face(const FileMesh& mesh) {
  std::size_t f = 0;
  while (faces_around(mesh, mesh.faces[f]) != 6) ++f;
  return f;
}
std::size_t outer_face(const FileMesh& mesh) {
  std::size_t f = 0;
  while (faces_around(mesh, mesh.faces[f]) == 6) ++f;
  return f;
}

class ForeignTool : public ::testing::Test {
 protected:
  void check_out(const char* name, std::initializer_list<std::uint32_t> ids) {
    file_ = repository_ / name;
    std::vector<ChartId> charts;
    for (const std::uint32_t id : ids) charts.emplace_back(id);
    (void)repository_->checkout_file(repository_->snapshot(), charts, file_, {});
  }

  /// A tool hands the file over to another name: the sidecar goes along.
  void hand_over(const fs::path& to) {
    fs::rename(file_.string() + ".ramcdb.json", to.string() + ".ramcdb.json");
    file_ = to;
  }

  /// Commits, and expects the mesh to be what the file says it is.
  CommitReport commit_and_check(const FileMesh& edited, std::uint64_t moved) {
    const Snapshot before = repository_->snapshot();
    const std::vector<LatticePoint> now = snapped(before.lattice(), edited.positions);
    std::map<LatticePoint, LatticePoint> to;  // faces outside the region that share a moved vertex move as well
    for (std::size_t v = 0; v < now.size(); ++v)
      EXPECT_TRUE(to.emplace(original_[v], now[v]).second) << "the test wants different points";
    RegionMesh expected = whole(before);
    for (LatticePoint& p : expected.points)
      if (const auto it = to.find(p); it != to.end()) p = it->second;
    EXPECT_EQ(repository_->status_file(file_).vertices_moved, moved);
    const CommitReport report = repository_->commit_file(file_, message("foreign"));
    EXPECT_EQ(report.vertices_moved, moved);
    EXPECT_TRUE(face_set(whole(repository_->snapshot())) == face_set(expected));
    return report;
  }

  void remember(const FileMesh& mesh) { original_ = snapped(repository_->snapshot().lattice(), mesh.positions); }

  TempRepository repository_{scan(8000), 400};
  fs::path file_;
  std::vector<LatticePoint> original_;  ///< the checked-out file's vertices
};

TEST_F(ForeignTool, UneditedInAnyOrderAndFormatIsUnchanged) {
  check_out("region.ply", {3, 4, 9});
  const FileMesh mesh = read(file_);
  for (const char* name : {"again.ply", "again.obj", "again.off", "again.stl", "again.glb", "again.gltf"}) {
    fs::copy_file(file_.string() + ".ramcdb.json", (repository_ / name).string() + ".ramcdb.json");
    write(renumbered(mesh, 5), repository_ / name);
    EXPECT_TRUE(repository_->status_file(repository_ / name).clean()) << name;
    EXPECT_TRUE(repository_->commit_file(repository_ / name, message("same")).nothing_changed) << name;
  }
  write(soup(mesh), repository_ / "again.obj");
  EXPECT_TRUE(repository_->status_file(repository_ / "again.obj").clean()) << "split vertices";
  EXPECT_EQ(repository_->resolve("HEAD"), VersionId(1));
}

TEST_F(ForeignTool, AttributesThatItAddedAreNamedAndNotTaken) {
  check_out("region.ply", {3, 4});
  mesh_file::MeshData data = mesh_file::read_mesh(file_);
  const std::size_t vertices = data.positions.size();
  data.attributes = {{{"quality", AttributeOf::vertex, NumberType::float32, 1, Meaning::other, {}, {}}, {}},
                     {{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}}};
  data.attributes[0].values.assign(vertices, 0.5);
  data.attributes[1].values.assign(3 * vertices, 200);
  (void)mesh_file::write_mesh(file_, mesh_file::Format::ply, mesh_file::output_of(data, mesh_file::Scalar::float64));
  const std::vector<std::string> names{"quality", "color"};
  EXPECT_EQ(repository_->status_file(file_).notes.not_taken, names);
  EXPECT_TRUE(repository_->status_file(file_).clean());
  data.positions[0].x += 20 * repository_->snapshot().lattice().step;
  (void)mesh_file::write_mesh(file_, mesh_file::Format::ply, mesh_file::output_of(data, mesh_file::Scalar::float64));
  const CommitReport report = repository_->commit_file(file_, message("painted"));
  EXPECT_EQ(report.vertices_moved, 1U);
  EXPECT_EQ(report.notes.not_taken, names);
}

TEST_F(ForeignTool, MovedAndKeptInOrder) {
  check_out("region.ply", {3, 4});
  FileMesh mesh = read(file_);
  remember(mesh);
  const double step = repository_->snapshot().lattice().step;
  for (Point& p : mesh.positions) p.x += 7 * step;
  write(mesh, file_);
  (void)commit_and_check(mesh, mesh.positions.size());
}

TEST_F(ForeignTool, MovedReorderedAndWrittenInAnotherFormat) {
  const double step = repository_->snapshot().lattice().step;
  int round = 0;
  for (const char* name : {"out.obj", "out.off", "out.stl", "out.ply", "out.glb", "out.gltf"}) {
    check_out("region.ply", {3, 4});
    FileMesh mesh = read(file_);
    remember(mesh);
    std::uint64_t moved = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); v += 3, ++moved) {
      mesh.positions[v].y += (5 + round) * step;
      mesh.positions[v].z -= static_cast<double>(v % 11) * step;
    }
    hand_over(repository_ / name);
    write(renumbered(mesh, 17), file_);
    const CommitReport report = commit_and_check(mesh, moved);
    EXPECT_EQ(report.revision, VersionId(static_cast<std::uint32_t>(2 + round))) << name;
    ++round;
  }
}

TEST_F(ForeignTool, SmoothedInsideAndReorderedIsRecognizedByItsBorder) {
  check_out("region.ply", {3, 4});
  const Snapshot snapshot = repository_->snapshot();
  const RegionMesh region = snapshot.read({ChartId(3), ChartId(4)});
  FileMesh mesh = read(file_);
  remember(mesh);
  std::uint64_t moved = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!region.outer_border[v]) {
      mesh.positions[v].z += 3 * snapshot.lattice().step;
      ++moved;
    }
  hand_over(repository_ / "smooth.obj");
  write(renumbered(mesh, 3), file_);
  (void)commit_and_check(mesh, moved);
}

TEST_F(ForeignTool, TheSameFileIsCommittedAgainAndAgain) {
  check_out("region.ply", {3, 4});
  const double step = repository_->snapshot().lattice().step;
  for (int round = 0; round < 3; ++round) {
    FileMesh mesh = read(file_);
    remember(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); v += 50) mesh.positions[v].z += 2 * step;
    write(mesh, file_);
    (void)commit_and_check(mesh, (mesh.positions.size() + 49) / 50);
  }
  EXPECT_TRUE(repository_->status_file(file_).clean());
}

TEST_F(ForeignTool, OthersWorkBesideItIsNeverUndone) {
  check_out("mine.ply", {3, 15});
  const fs::path mine = file_;
  check_out("theirs.ply", {15});
  FileMesh theirs = read(file_);
  const double step = repository_->snapshot().lattice().step;
  // Not on its border: the edits shall not meet.
  const RegionMesh region = repository_->snapshot().read({ChartId(15)});
  const auto inner = std::find_if(region.keys.begin(), region.keys.end(),
                                  [](VertexKey k) { return k.where == VertexKey::Where::chart; });
  theirs.positions[static_cast<std::size_t>(inner - region.keys.begin())].z += 9 * step;
  write(theirs, file_);
  ASSERT_EQ(repository_->commit_file(file_, message("theirs")).revision, VersionId(2));
  const FaceSet chart15 = face_set(repository_->snapshot().read({ChartId(15)}));

  const auto edit_chart_3 = [&](double by) {
    FileMesh mesh = read(mine);
    const RegionMesh r3 = repository_->snapshot("mesh", "v1").read({ChartId(3), ChartId(15)});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (r3.keys[v].where == VertexKey::Where::chart && r3.keys[v].id == 3) {
        mesh.positions[v].z += by * step;
        break;
      }
    write(mesh, mine);
  };
  for (const double by : {4.0, 5.0}) {
    edit_chart_3(by);
    EXPECT_EQ(repository_->status_file(mine).changed_by_others, std::vector<ChartId>{ChartId(15)});
    const CommitReport report = repository_->commit_file(mine, message("mine"));
    EXPECT_TRUE(report.conflicts.empty());
    EXPECT_EQ(report.vertices_moved, 1U);
    EXPECT_EQ(face_set(repository_->snapshot().read({ChartId(15)})), chart15) << "their work stands";
  }
}

TEST_F(ForeignTool, FacesMayComeAndGoInside) {
  check_out("region.ply", {3, 4});
  FileMesh edited = read(file_);
  const std::size_t faces = edited.faces.size();
  edited.faces.erase(edited.faces.begin() + static_cast<std::ptrdiff_t>(inner_face(edited)));
  write(edited, file_);
  const CommitReport hole = repository_->commit_file(file_, message("a hole"));
  EXPECT_EQ(hole.faces_removed, 1U);
  EXPECT_EQ(hole.vertices_moved + hole.faces_added, 0U);
  edited = read(file_);
  std::swap(edited.faces[inner_face(edited)][0], edited.faces[inner_face(edited)][1]);
  write(renumbered(edited, 2), file_);
  const CommitReport flip = repository_->commit_file(file_, message("a face turned over"));
  EXPECT_EQ(flip.faces_added, 1U);
  EXPECT_EQ(flip.faces_removed, 1U);
  EXPECT_TRUE(repository_->status_file(file_).clean()) << "what was committed is the region now";
  EXPECT_EQ(read(file_).faces.size(), faces - 1);
  EXPECT_TRUE(repository_->verify({}).ok());
}

TEST_F(ForeignTool, FacesThatGoAtTheOuterBorderAreRefusedWithPlaces) {
  check_out("region.ply", {3, 4});
  FileMesh hole = read(file_);
  hole.faces.erase(hole.faces.begin() + static_cast<std::ptrdiff_t>(outer_face(hole)));
  write(hole, file_);
  try {
    (void)repository_->commit_file(file_, message("bad"));
    ADD_FAILURE() << "a torn neighbour was taken";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(e.what()).find("--grow 1"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("near "), std::string::npos) << e.what();
  }
  EXPECT_EQ(repository_->resolve("HEAD"), VersionId(1));
}

TEST_F(ForeignTool, EditedFilesAreNotOverwrittenUnasked) {
  check_out("region.ply", {3});
  FileOptions careful;
  careful.overwrite = false;
  (void)repository_->checkout_file(repository_->snapshot(), {ChartId(4)}, file_, careful);
  std::ofstream(file_, std::ios::app) << "\n";
  EXPECT_THROW((void)repository_->checkout_file(repository_->snapshot(), {ChartId(4)}, file_, careful), Error);
}

TEST_F(ForeignTool, ASidecarIsNeededAndMustFit) {
  check_out("region.ply", {3});
  EXPECT_THROW((void)repository_->commit_file(repository_ / "input.ply", message("x")), Error);
  TempRepository other(sphere(500));
  EXPECT_THROW((void)other->commit_file(file_, message("x")), Error);
  EXPECT_EQ(open_for_file(file_).id(), repository_->id());
  std::ofstream(file_.string() + ".ramcdb.json") << "{\"format\": 7";
  EXPECT_THROW((void)repository_->commit_file(file_, message("x")), Error);
}

TEST_F(ForeignTool, PaintedFilesAreToLookAt) {
  FileOptions options;
  options.paint = Paint::chart;
  file_ = repository_ / "painted.ply";
  (void)repository_->checkout_file(repository_->snapshot(), {ChartId(3), ChartId(4)}, file_, options);
  EXPECT_THROW((void)repository_->commit_file(file_, message("x")), Error);
  options.paint = Paint::bits;
  EXPECT_THROW((void)repository_->export_mesh(repository_->snapshot(), repository_ / "painted.obj", options), Error);
}

/// Faces that have no edge left in place, and others that stand twice: each vertex is moved in a file that numbers
/// nothing as it was.
TEST(ForeignToolOnUglyMeshes, VerticesOfDegenerateFacesMove) {
  TestMesh mesh = degenerate_and_duplicate_faces();
  for (const std::uint32_t v : {20U, 47U, 90U}) {
    mesh.faces.push_back({v, v, v});
    mesh.faces.push_back({v, v, v});
    mesh.faces.push_back({v, v, v + 1});
  }
  TempRepository repository(mesh, 5000);
  const Lattice lattice = repository->snapshot().lattice();
  for (const std::uint32_t v : {5U, 20U, 21U, 47U, 90U, 143U}) {
    const fs::path file = repository / ("v" + std::to_string(v) + ".stl");
    (void)repository->checkout_file(repository->snapshot(), {ChartId(1)}, file, {});
    FileMesh edited = read(file);
    RegionMesh expected = whole(repository->snapshot());
    const LatticePoint from = lattice.snap(mesh.positions[v]);
    LatticePoint to = from;
    to.z += 90;
    std::replace(expected.points.begin(), expected.points.end(), from, to);
    for (Point& p : edited.positions)
      if (lattice.snap(p) == from) p = lattice.position(to);
    std::reverse(edited.faces.begin(), edited.faces.end());
    write(edited, file);
    EXPECT_EQ(repository->commit_file(file, message("up")).vertices_moved, 1U) << v;
    EXPECT_TRUE(face_set(whole(repository->snapshot())) == face_set(expected)) << v;
  }
}

}  // namespace
}  // namespace ramcdb::test
