#include "ramcdb/edit_transaction.h"

#include <random>
#include <set>

#include "db/store.h"
#include "tests/api/painted_grid.h"
#include "tests/api/temp_repository.h"

namespace ramcdb::test {
namespace {

Region charts(std::initializer_list<std::uint32_t> ids) {
  OfCharts shape;
  for (const std::uint32_t id : ids) shape.charts.emplace_back(id);
  return {{shape}, 0};
}

/// Patch vertices whose key is of a kind.
std::vector<Patch::Mesh::VertexHandle> vertices_of_kind(const Patch& patch, VertexKey::Where where) {
  std::vector<Patch::Mesh::VertexHandle> found;
  for (const auto v : patch.mesh().all_vertices())
    if (VertexKey::unpack(patch.mesh().property(patch.key_property(), v)).where == where) found.push_back(v);
  return found;
}

void move(Patch& patch, Patch::Mesh::VertexHandle v, double x, double y, double z) {
  const double step = patch.base().lattice().step;
  patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(x * step, y * step, z * step));
}

/// The triangles that an edit should lead to: those before, with the patch's points.
FaceSet expected_after(const Snapshot& before, const std::map<VertexKey, LatticePoint>& moved) {
  RegionMesh mesh = whole(before);
  for (std::size_t v = 0; v < mesh.keys.size(); ++v)
    if (const auto it = moved.find(mesh.keys[v]); it != moved.end()) mesh.points[v] = it->second;
  return face_set(mesh);
}

std::map<VertexKey, LatticePoint> points_of(const Patch& patch) {
  std::map<VertexKey, LatticePoint> points;
  for (const auto v : patch.mesh().all_vertices()) {
    const auto p = patch.mesh().point(v);
    points[VertexKey::unpack(patch.mesh().property(patch.key_property(), v))] =
        patch.base().lattice().snap({p[0], p[1], p[2]});
  }
  return points;
}

TEST(Patch, HoldsTheRegionAsAnOpenMeshMesh) {
  for (const TestMesh& mesh : {sphere(3000), genus3(4000), terrain(40, 40), boxes(30), scan(5000)}) {
    TempRepository repository(mesh);
    auto edit = repository->begin_edit();
    const Patch& patch = edit.checkout({{WholeMesh{}}, 0});
    EXPECT_EQ(patch.copies(), 0U);
    EXPECT_EQ(patch.mesh().n_vertices(), mesh.positions.size());
    EXPECT_EQ(patch.mesh().n_faces(), mesh.faces.size());
    for (const auto v : patch.mesh().all_vertices()) EXPECT_FALSE(patch.on_outer_border(v));
  }
}

TEST(Patch, HoldsNonManifoldRegionsWithCopiesOfOneKey) {
  for (const TestMesh& mesh :
       {hourglass(), two_cubes_sharing_edge(), three_faces_one_edge(), moebius(), degenerate_and_duplicate_faces()}) {
    TempRepository repository(mesh);
    auto edit = repository->begin_edit();
    const Patch& patch = edit.checkout({{WholeMesh{}}, 0});
    EXPECT_EQ(patch.mesh().n_faces(), mesh.faces.size());
    EXPECT_EQ(patch.mesh().n_vertices(), mesh.positions.size() + patch.copies());
    EXPECT_TRUE(edit.status().clean());
  }
}

TEST(Commit, OfAnUneditedRegionWritesNothing) {
  TempRepository repository(scan(6000));
  const auto usage = repository->snapshot().info().bytes.store;
  auto edit = repository->begin_edit();
  (void)edit.checkout(charts({1, 2, 3}));
  EXPECT_TRUE(edit.status().clean());
  const CommitReport report = edit.commit(message("nothing"));
  EXPECT_TRUE(report.nothing_changed);
  EXPECT_EQ(report.bytes_written, 0U);
  EXPECT_EQ(report.revision, VersionId(1));
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
  EXPECT_EQ(repository->snapshot().info().bytes.store, usage);
}

TEST(Commit, OfMovesOfEveryKindChangesJustThem) {
  for (const auto where : {VertexKey::Where::chart, VertexKey::Where::wire, VertexKey::Where::corner}) {
    SCOPED_TRACE(static_cast<int>(where));
    TempRepository repository(scan(6000), 400);
    auto edit = repository->begin_edit();
    const Snapshot before = edit.base();
    Patch& patch = edit.checkout(charts({4, 5}));
    const auto candidates = vertices_of_kind(patch, where);
    ASSERT_FALSE(candidates.empty());
    move(patch, candidates[candidates.size() / 2], 3, -2, 5);
    const FaceSet expected = expected_after(before, points_of(patch));
    const ChangeReport status = edit.status();
    EXPECT_EQ(status.vertices_moved, 1U);
    EXPECT_NEAR(status.max_displacement, std::sqrt(38.0) * before.lattice().step, 1e-12);
    const CommitReport report = edit.commit(message("move"));
    EXPECT_EQ(report.vertices_moved, 1U);
    EXPECT_EQ(report.revision, VersionId(2));
    EXPECT_GT(report.bytes_written, 0U);
    const Snapshot after = repository->snapshot();
    EXPECT_EQ(face_set(whole(after)), expected);
    EXPECT_EQ(face_set(whole(repository->snapshot("mesh", "v1"))), face_set(whole(before))) << "history stays";
    const DiffReport diff = repository->diff(before, after);
    EXPECT_EQ(diff.vertices_moved, 1U);
    EXPECT_EQ(diff.changed.size(), report.charts_reencoded);
    EXPECT_NEAR(diff.max_displacement, status.max_displacement, 1e-12);
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(Commit, OfTheRegionsOwnBorderTakesTheNeighboursAlong) {
  TempRepository repository(scan(6000), 400);
  auto edit = repository->begin_edit();
  const Snapshot before = edit.base();
  Patch& patch = edit.checkout(charts({6}));
  std::uint64_t moved = 0;
  for (const auto v : patch.mesh().all_vertices())
    if (patch.on_outer_border(v)) {
      move(patch, v, 1, 1, 1);
      ++moved;
    }
  ASSERT_GT(moved, 10U);
  const FaceSet expected = expected_after(before, points_of(patch));
  EXPECT_EQ(edit.status().border_vertices_moved, moved);
  const CommitReport report = edit.commit(message("border"));
  EXPECT_EQ(report.charts_touched, 1U);
  EXPECT_GT(report.charts_reencoded, 3U);
  EXPECT_EQ(face_set(whole(repository->snapshot())), expected);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Commit, OfMovesAtNonManifoldPlacesMovesAllCharts) {
  for (const TestMesh& mesh : {hourglass(), two_cubes_sharing_edge(), three_faces_one_edge()}) {
    TempRepository repository(mesh, 4);
    auto edit = repository->begin_edit();
    const Snapshot before = edit.base();
    Patch& patch = edit.checkout({{WholeMesh{}}, 0});
    std::map<std::uint64_t, int> uses;
    for (const auto v : patch.mesh().all_vertices()) ++uses[patch.mesh().property(patch.key_property(), v)];
    for (const auto v : patch.mesh().all_vertices())
      if (uses[patch.mesh().property(patch.key_property(), v)] > 1) move(patch, v, 2, 2, 2);
    const FaceSet expected = expected_after(before, points_of(patch));
    (void)edit.commit(message("tip"));
    EXPECT_EQ(face_set(whole(repository->snapshot())), expected);
  }
}

TEST(Commit, RefusesCopiesThatMovedApart) {
  TempRepository repository(hourglass(), 4);
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout({{WholeMesh{}}, 0});
  std::set<std::uint64_t> seen;
  for (const auto v : patch.mesh().all_vertices())
    if (!seen.insert(patch.mesh().property(patch.key_property(), v)).second) move(patch, v, 9, 0, 0);
  EXPECT_THROW((void)edit.commit(message("torn")), Error);
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
}

TEST(Commit, FarOutsideTheFirstBoxExpandsTheRange) {
  TempRepository repository(sphere(3000));
  auto edit = repository->begin_edit();
  const Snapshot before = edit.base();
  Patch& patch = edit.checkout(charts({2}));
  const auto inner = vertices_of_kind(patch, VertexKey::Where::chart);
  move(patch, inner.front(), 1e7, -3e6, 5e5);
  const FaceSet expected = expected_after(before, points_of(patch));
  const CommitReport report = edit.commit(message("far"));
  EXPECT_EQ(report.ranges_expanded, 1U);
  EXPECT_EQ(face_set(whole(repository->snapshot())), expected);
  EXPECT_EQ(repository->snapshot().lattice(), before.lattice()) << "the step and so the error bound stay";
  auto back = repository->begin_edit();
  Patch& again = back.checkout(charts({2}));
  for (const auto v : again.mesh().all_vertices()) {
    const auto p = again.mesh().point(v);
    if (p[0] > 100) move(again, v, -1e7, 3e6, -5e5);
  }
  (void)back.commit(message("back"));
  EXPECT_EQ(face_set(whole(repository->snapshot())), face_set(whole(before)));
}

TEST(Commit, BeyondTheLatticeIsRefused) {
  TempRepository repository(sphere(1000));
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout({{WholeMesh{}}, 0});
  move(patch, Patch::Mesh::VertexHandle(0), 3e9, 0, 0);
  EXPECT_THROW((void)edit.commit(message("too far")), Error);
  patch.mesh().set_point(Patch::Mesh::VertexHandle(0), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_THROW((void)edit.commit(message("nan")), Error);
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
}

TEST(Commit, TakesAFaceAway) {
  TempRepository repository(sphere(1000));
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout({{WholeMesh{}}, 0});
  patch.mesh().request_face_status();
  patch.mesh().request_edge_status();
  patch.mesh().request_vertex_status();
  patch.mesh().delete_face(Patch::Mesh::FaceHandle(3), false);
  const std::uint64_t faces = repository->snapshot().info().faces;
  EXPECT_EQ(edit.commit(message("hole")).faces_removed, 1U);
  EXPECT_EQ(repository->snapshot().info().faces, faces - 1);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Commit, AHundredRoundsOfMovesAndMovesBackEndWhereTheyBegan) {
  TempRepository repository(terrain(40, 40), 300);
  const FaceSet start = face_set(whole(repository->snapshot()));
  std::mt19937 random(11);
  for (int round = 0; round < 50; ++round) {
    const auto chart = ChartId(1 + static_cast<std::uint32_t>(random() % repository->snapshot().info().charts));
    std::map<std::uint64_t, Patch::Mesh::Point> before;
    for (const bool back : {false, true}) {
      auto edit = repository->begin_edit();
      Patch& patch = edit.checkout({{OfCharts{{chart}}}, 0});
      // The chart's vertices by position: moving one renumbers the inner ones.
      std::vector<Patch::Mesh::VertexHandle> order(patch.mesh().n_vertices());
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = Patch::Mesh::VertexHandle(static_cast<int>(i));
      std::sort(order.begin(), order.end(), [&](auto a, auto b) {
        const auto p = patch.mesh().point(a), q = patch.mesh().point(b);
        return std::tie(p[0], p[1]) < std::tie(q[0], q[1]);
      });
      // A terrain's x and y name its vertices; only heights move.
      for (std::size_t i = static_cast<std::size_t>(round % 7); i < order.size(); i += 7)
        move(patch, order[i], 0, 0, back ? -37 : 37);
      (void)edit.commit(message(back ? "back" : "there"));
    }
  }
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(101));
  EXPECT_EQ(face_set(whole(repository->snapshot())), start);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Commit, OfDisjointChartsGoesInBesideOthers) {
  TempRepository repository(scan(8000), 300);
  auto mine = repository->begin_edit();
  auto theirs = repository->begin_edit();
  Patch& a = mine.checkout(charts({1}));
  Patch& b = theirs.checkout(charts({20}));
  move(a, vertices_of_kind(a, VertexKey::Where::chart).front(), 0, 0, 4);
  move(b, vertices_of_kind(b, VertexKey::Where::chart).front(), 0, 0, 4);
  auto both = points_of(a);
  for (const auto& [key, point] : points_of(b)) both[key] = point;
  const FaceSet expected = expected_after(mine.base(), both);
  EXPECT_EQ(theirs.commit(message("theirs")).revision, VersionId(2));
  const CommitReport report = mine.commit(message("mine"));
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(report.revision, VersionId(3));
  EXPECT_EQ(report.parent, VersionId(2));
  EXPECT_EQ(face_set(whole(repository->snapshot())), expected);
}

/// Takes away the faces of a patch at the vertex that lies at a place; `keeps_vertex`: it stays in the patch.
void open_at(Patch& patch, const Point& place, bool keeps_vertex) {
  auto& mesh = patch.mesh();
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  Patch::Mesh::VertexHandle at;
  for (const auto v : mesh.all_vertices())
    if (mesh.point(v) == Patch::Mesh::Point(place.x, place.y, place.z)) at = v;
  std::vector<Patch::Mesh::FaceHandle> faces;
  for (auto f = mesh.cvf_iter(at); f.is_valid(); ++f) faces.push_back(*f);
  EXPECT_FALSE(faces.empty());
  for (const auto f : faces) mesh.delete_face(f, !keeps_vertex);
}

TEST(Commit, OfBothSidesOfAVertexTakesItAway) {
  const TempFolder folder;
  mesh_file::MeshData mesh;
  mesh.positions = hourglass().positions;
  for (const Triangle& t : hourglass().faces) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  mesh.attributes = {make_attribute("heat", AttributeOf::vertex, NumberType::float32, 1, Meaning::other)};
  mesh.attributes.front().values.assign(mesh.positions.size(), kNone);  // absent is the same as absent
  write_data(mesh, folder / "mesh.ply");
  Repository::create(folder / "r.ramcdb");
  Repository repository = Repository::open(folder / "r.ramcdb");
  ImportOptions importing;
  importing.chart_faces = 12;
  (void)repository.import(folder / "mesh.ply", importing);
  const Snapshot before = repository.snapshot();
  ASSERT_EQ(before.info().charts, 2U) << "one for each side of the vertex";
  const RegionMesh first = before.read({ChartId(1)}), second = before.read({ChartId(2)});
  std::vector<LatticePoint> common;
  for (const LatticePoint p : first.points)
    if (std::ranges::count(second.points, p)) common.push_back(p);
  ASSERT_EQ(common.size(), 1U);
  for (const bool keeps : {false, true}) {
    const std::string branch = keeps ? "kept" : "dropped";
    (void)repository.create_branch(branch, "1");
    auto mine = repository.begin_edit({}, branch), theirs = repository.begin_edit({}, branch);
    open_at(mine.checkout(charts({1})), before.position(common.front()), keeps);
    open_at(theirs.checkout(charts({2})), before.position(common.front()), false);
    CommitOptions options = message("open");
    options.branch = branch;
    (void)theirs.commit(options);
    const MeshInfo halfway = repository.snapshot({}, branch).info();
    EXPECT_EQ(halfway.vertices, 15U);
    (void)mine.commit(options);
    const MeshInfo after = repository.snapshot({}, branch).info();
    EXPECT_EQ(after.vertices, 14U) << branch;
    EXPECT_EQ(after.isolated_vertices, 0U) << branch;
  }
  EXPECT_TRUE(repository.verify({}).ok());
}

TEST(Commit, OfTheSameChartIsAConflictAndWritesNothing) {
  TempRepository repository(scan(8000), 300);
  auto mine = repository->begin_edit();
  auto theirs = repository->begin_edit();
  Patch& a = mine.checkout(charts({7}));
  Patch& b = theirs.checkout(charts({7}));
  move(a, vertices_of_kind(a, VertexKey::Where::chart).front(), 0, 0, 4);
  move(b, vertices_of_kind(b, VertexKey::Where::chart).back(), 0, 0, 4);
  (void)theirs.commit(message("theirs"));
  EXPECT_EQ(mine.status().conflicts, std::vector<ChartId>{ChartId(7)});
  const CommitReport report = mine.commit(message("mine"));
  EXPECT_EQ(report.conflicts, std::vector<ChartId>{ChartId(7)});
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(2));
}

TEST(Commit, OfASharedBorderGoesInBesideAnEditInsideTheNeighbour) {
  TempRepository repository(scan(8000), 300);
  auto mine = repository->begin_edit();
  auto theirs = repository->begin_edit();
  Patch& a = mine.checkout(charts({7}));
  const auto neighbour = repository->snapshot().describe({ChartId(7)}).front().neighbours.front();
  Patch& b = theirs.checkout({{OfCharts{{neighbour}}}, 0});
  std::set<std::uint64_t> keys_of_b;
  for (const auto v : b.mesh().all_vertices()) keys_of_b.insert(b.mesh().property(b.key_property(), v));
  for (const auto v : a.mesh().all_vertices())
    if (keys_of_b.contains(a.mesh().property(a.key_property(), v))) move(a, v, 1, 0, 0);
  move(b, vertices_of_kind(b, VertexKey::Where::chart).front(), 0, 0, 4);
  (void)theirs.commit(message("theirs"));
  const CommitReport report = mine.commit(message("mine"));
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(repository->diff(repository->snapshot({}, "1"), repository->snapshot()).vertices_moved,
            report.vertices_moved + 1);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Commit, AbortedOrForgottenLeavesNothing) {
  TempRepository repository(sphere(2000));
  {
    auto edit = repository->begin_edit();
    Patch& patch = edit.checkout(charts({1}));
    move(patch, Patch::Mesh::VertexHandle(0), 5, 5, 5);
  }
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
  auto edit = repository->begin_edit();
  (void)edit.checkout(charts({1}));
  EXPECT_THROW((void)edit.checkout(charts({1, 2})), Error) << "patches may not overlap";
  edit.abort();
  EXPECT_THROW((void)edit.commit(message("over")), Error);
}

TEST(Commit, KeepsTheFiguresOfInfoTrue) {
  TempRepository repository(scan(6000), 300);
  const auto bytes_read = [&] {
    const auto charts = repository->snapshot().find({{WholeMesh{}}, 0});
    ReadCost cost;
    (void)repository->snapshot().read(charts, 1, &cost);  // a snapshot that has read no pages yet
    return cost.bytes;
  };
  const auto charts_bytes = [](const Snapshot& snapshot) {
    std::uint64_t bytes = 0;
    for (const ChartSummary& c : snapshot.describe(snapshot.find({{WholeMesh{}}, 0}))) bytes += c.bytes;
    return bytes;
  };
  const MeshInfo before = repository->snapshot().info();
  EXPECT_EQ(bytes_read(), charts_bytes(repository->snapshot()) + before.bytes.wires + before.bytes.wire_net);

  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout(charts({3, 4, 5}));
  int n = 0;
  for (const auto v : patch.mesh().all_vertices()) {
    ++n;
    move(patch, v, n % 5, n % 3, -(n % 4));
  }
  (void)edit.commit(message("wobble"));
  // The running totals must be those of the blobs that the version really has; of a group that some wires have left,
  // only what is still in use counts.
  const Snapshot snapshot = repository->snapshot();
  const MeshInfo info = snapshot.info();
  const std::uint64_t charts = charts_bytes(snapshot);
  EXPECT_EQ(info.bytes.connectivity + info.bytes.geometry + info.bytes.chart_headers, charts);
  const std::uint64_t counted = charts + info.bytes.wires + info.bytes.wire_net, read = bytes_read();
  EXPECT_GT(read, counted);
  EXPECT_LT(read, counted + before.bytes.wires);
  EXPECT_GT(info.bytes.wires, before.bytes.wires);  // moved points are noise
  EXPECT_LT(info.bytes.wires, 2 * before.bytes.wires);
}

}  // namespace
}  // namespace ramcdb::test
