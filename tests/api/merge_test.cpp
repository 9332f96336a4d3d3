#include <algorithm>

#include "api/page_index.h"
#include "api/snapshot_impl.h"
#include "tests/api/temp_repository.h"

/// Edits that meet: merged three ways, on branches, and taken back.
namespace ramcdb::test {
namespace {

CommitOptions options(const char* text, bool merge = false) {
  CommitOptions out = message(text);
  out.merge = merge;
  return out;
}

bool is_inner(const Patch& patch, Patch::Mesh::VertexHandle v) {
  const std::uint64_t key = patch.mesh().property(patch.key_property(), v);
  return key != 0 && VertexKey::unpack(key).where == VertexKey::Where::chart;
}

/// Inner vertices of a patch that were there before, in order of their handles.
std::vector<Patch::Mesh::VertexHandle> inner(const Patch& patch) {
  std::vector<Patch::Mesh::VertexHandle> found;
  for (const auto v : patch.mesh().all_vertices())
    if (is_inner(patch, v)) found.push_back(v);
  return found;
}

Region chart(std::uint32_t id) { return {{OfCharts{{ChartId(id)}}}, 0}; }

/// Moves the n-th inner vertex of a chart by some steps along z.
void lift(Patch& patch, std::size_t n, int steps) {
  patch.mesh().point(inner(patch)[n])[2] += steps * patch.base().lattice().step;
}

/// Splits the n-th face without a border vertex in three, by a point some steps above its middle.
void split_face(Patch& patch, std::size_t n, int steps = 0) {
  auto& mesh = patch.mesh();
  for (const auto f : mesh.all_faces()) {
    bool inside = true;
    for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v) inside = inside && is_inner(patch, *v);
    if (!inside || n-- > 0) continue;
    mesh.split(f, mesh.calc_face_centroid(f) + Patch::Mesh::Point(0, 0, steps * patch.base().lattice().step));
    return;
  }
  FAIL() << "the chart has too few faces inside";
}

class Merge : public ::testing::Test {
 protected:
  EditTransaction begin(std::uint32_t id, Patch*& patch, const char* branch = "main") {
    EditTransaction edit = repository_->begin_edit({}, branch);
    patch = &edit.checkout(chart(id));
    return edit;
  }
  FaceSet faces(const char* revision = "") { return face_set(whole(repository_->snapshot({}, revision))); }
  void expect_whole() { EXPECT_TRUE(repository_->verify({}).ok()); }

  TempRepository repository_{scan(8000), 400};
};

TEST_F(Merge, MovesOfDifferentVerticesOfOneChart) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction mine = begin(4, a), theirs = begin(4, b), late = begin(4, b);
  lift(*a, 3, 40);
  lift(*b, 9, 70);
  EXPECT_EQ(late.commit(options("theirs")).vertices_moved, 1U);
  EXPECT_EQ(mine.commit(options("mine")).conflicts, std::vector<ChartId>{ChartId(4)}) << "not without being asked";
  const CommitReport merged = mine.commit(options("mine", true));
  EXPECT_TRUE(merged.conflicts.empty());
  EXPECT_TRUE(merged.merged);
  const DiffReport diff = repository_->diff(repository_->snapshot({}, "1"), repository_->snapshot());
  EXPECT_EQ(diff.vertices_moved, 2U) << "both are there";
  expect_whole();
}

TEST_F(Merge, OneVertexMovedToTwoPlacesIsAConflictWithItsPlace) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction mine = begin(4, a), theirs = begin(4, b);
  lift(*a, 3, 40);
  lift(*b, 3, 70);
  (void)theirs.commit(options("theirs"));
  const CommitReport report = mine.commit(options("mine", true));
  EXPECT_EQ(report.conflicts, std::vector<ChartId>{ChartId(4)});
  ASSERT_EQ(report.conflict_places.size(), 1U);
  EXPECT_EQ(report.conflict_places.front().chart, ChartId(4));
  EXPECT_EQ(repository_->resolve("HEAD"), VersionId(2)) << "nothing was written";

  CommitOptions saved = options("mine");
  saved.onto = "mine";
  const CommitReport kept = mine.commit(saved);
  EXPECT_TRUE(kept.conflicts.empty());
  EXPECT_EQ(kept.parent, VersionId(1)) << "the branch begins where the edit was made";
  EXPECT_EQ(repository_->resolve("mine"), kept.revision);
  EXPECT_EQ(repository_->resolve("main"), VersionId(2));
  expect_whole();
}

TEST_F(Merge, FacesChangedBesideMovedVertices) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction mine = begin(4, a), theirs = begin(4, b);
  split_face(*a, 2);
  lift(*b, inner(*b).size() - 1, 70);
  (void)theirs.commit(options("theirs"));
  const auto before = repository_->snapshot().info();
  const CommitReport merged = mine.commit(options("mine", true));
  EXPECT_TRUE(merged.conflicts.empty());
  const auto after = repository_->snapshot().info();
  EXPECT_EQ(after.faces, before.faces + 2);
  EXPECT_EQ(after.vertices, before.vertices + 1);
  EXPECT_EQ(repository_->diff(repository_->snapshot({}, "2"), repository_->snapshot()).vertices_moved, 0U)
      << "what theirs moved stays where they put it";
  expect_whole();
}

TEST_F(Merge, TheSameFacesChangedTwiceAreAConflict) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction mine = begin(4, a), theirs = begin(4, b);
  split_face(*a, 2);
  split_face(*b, 2, 5);
  (void)theirs.commit(options("theirs"));
  const CommitReport report = mine.commit(options("mine", true));
  EXPECT_FALSE(report.conflict_places.empty());
  EXPECT_EQ(repository_->resolve("HEAD"), VersionId(2));
}

/// Values that one side changed are never lost with what the other side took away.
class MergeOfValues : public ::testing::Test {
 protected:
  MergeOfValues() {
    const TestMesh mesh = scan(2000);
    mesh_file::MeshOutput out;
    std::vector<Attribute> attributes{{{"heat", AttributeOf::vertex, NumberType::int16, 1, Meaning::other, {}, {}}, {}},
                                      {{"kind", AttributeOf::face, NumberType::int16, 1, Meaning::other, {}, {}}, {}}};
    attributes[0].values.assign(mesh.positions.size(), 1);
    attributes[1].values.assign(mesh.faces.size(), 2);
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : mesh.faces) corners.insert(corners.end(), t.begin(), t.end());
    out.positions = mesh.positions;
    out.corners = corners;
    out.attributes = attributes;
    (void)mesh_file::write_mesh(folder_ / "a.ply", mesh_file::Format::ply, out);
    Repository::create(folder_ / "r");
    (void)Repository::open(folder_ / "r").import(folder_ / "a.ply", {});
  }

  /// One side deletes a face with a vertex inside around it, the other changes values there; whoever comes second is
  /// refused.
  template <class Paint>
  void expect_conflict(bool paint_first, Paint&& paint) {
    Repository repository = Repository::open(folder_ / "r");
    auto remover = repository.begin_edit(), painter = repository.begin_edit();
    Patch &removed = remover.checkout({{WholeMesh{}}, 0}), &painted = painter.checkout({{WholeMesh{}}, 0});
    removed.mesh().request_vertex_status();
    removed.mesh().request_edge_status();
    removed.mesh().request_face_status();
    const auto vertex = inner(removed).front();
    const std::uint32_t v = removed.mesh().property(removed.region_property(), vertex);
    const std::uint32_t f =
        removed.mesh().property(removed.region_face_property(), *removed.mesh().vf_iter(vertex)) - 1;
    removed.mesh().delete_vertex(vertex);
    paint(painted, v, f);
    auto &first = paint_first ? painter : remover, &second = paint_first ? remover : painter;
    const VersionId version = first.commit(options("first")).revision;
    const CommitReport report = second.commit(options("second", true));
    EXPECT_FALSE(report.conflict_places.empty());
    EXPECT_EQ(repository.resolve("HEAD"), version);
  }

  TempFolder folder_;
};

TEST_F(MergeOfValues, OfAVertexThatIsRemovedAreAConflict) {
  for (const bool paint_first : {false, true})
    expect_conflict(paint_first,
                    [](Patch& patch, std::uint32_t v, std::uint32_t) { patch.attribute("heat")->values[v] = 77; });
}

TEST_F(MergeOfValues, OfAFaceThatIsRemovedAreAConflict) {
  for (const bool paint_first : {false, true})
    expect_conflict(paint_first,
                    [](Patch& patch, std::uint32_t, std::uint32_t f) { patch.attribute("kind")->values[f] = 77; });
}

TEST_F(MergeOfValues, AMoveOfAVertexThatIsRemovedIsAConflict) {
  for (const bool paint_first : {false, true})
    expect_conflict(paint_first, [](Patch& patch, std::uint32_t v, std::uint32_t) {
      for (const auto vertex : patch.mesh().vertices())
        if (patch.mesh().property(patch.region_property(), vertex) == v)
          patch.mesh().point(vertex)[2] += 50 * patch.base().lattice().step;
    });
}

TEST_F(Merge, TheSameChangeOnBothSidesIsTakenOnce) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction mine = begin(4, a), theirs = begin(4, b);
  split_face(*a, 2);
  split_face(*b, 2);
  lift(*b, 0, 5);
  (void)theirs.commit(options("theirs"));
  const FaceSet before = faces();
  EXPECT_TRUE(mine.commit(options("mine", true)).nothing_changed);
  EXPECT_EQ(faces(), before);
  expect_whole();
}

TEST_F(Merge, AVertexThatOneSideMovedAndTheOtherRemovedIsAConflict) {
  for (const bool remove_first : {false, true}) {
    Patch *a = nullptr, *b = nullptr;
    EditTransaction mine = begin(4, a), theirs = begin(4, b);
    Patch &moved = remove_first ? *a : *b, &cut = remove_first ? *b : *a;
    std::size_t n = 0;  // a vertex away from the border
    const auto away = [&](Patch::Mesh::VertexHandle v) {
      const auto around = cut.mesh().vv_range(v);
      return std::all_of(around.begin(), around.end(), [&](auto w) { return is_inner(cut, w); });
    };
    while (!away(inner(cut)[n])) ++n;
    lift(moved, n, 40);
    cut.mesh().request_vertex_status();
    cut.mesh().request_edge_status();
    cut.mesh().request_face_status();
    cut.mesh().delete_vertex(inner(cut)[n]);
    const VersionId before = theirs.commit(options("theirs")).revision;
    EXPECT_FALSE(mine.commit(options("mine", true)).conflict_places.empty());
    EXPECT_EQ(repository_->resolve("HEAD"), before);
    (void)repository_->revert("HEAD", {}, options("back"));
  }
}

TEST_F(Merge, ASmallChartIsJoinedToANeighbourThatNobodyElseHasLocked) {
  // Of chart 4 or one behind it so few faces are at its border that it is small without the others.
  constexpr std::size_t kSmall = 100;
  const auto is_at_border = [](const Patch& patch, auto f) {
    for (auto v = patch.mesh().cfv_iter(f); v.is_valid(); ++v)
      if (patch.on_outer_border(*v)) return true;
    return false;
  };
  const auto border_faces = [&](std::uint32_t chart) {
    Patch* patch = nullptr;
    const EditTransaction edit = begin(chart, patch);
    const auto faces = patch->mesh().all_faces();
    return std::count_if(faces.begin(), faces.end(), [&](auto f) { return is_at_border(*patch, f); });
  };
  std::uint32_t chart = 4;
  while (border_faces(chart) >= static_cast<std::ptrdiff_t>(kSmall)) ++chart;
  for (const bool locked : {true, false}) {
    Patch* patch = nullptr;
    EditTransaction edit = begin(chart, patch);
    auto& mesh = patch->mesh();
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_face_status();
    for (const auto f : mesh.all_faces())
      if (!is_at_border(*patch, f)) mesh.delete_face(f);
    LockOptions others;
    others.owner = "somebody";
    std::vector<ChartId> charts = repository_->snapshot().find({{WholeMesh{}}, 0});
    std::erase(charts, ChartId(chart));
    if (locked) (void)repository_->lock(repository_->snapshot(), charts, others);
    ASSERT_TRUE(edit.commit(options("cut")).conflicts.empty());
    const std::uint32_t least = repository_->snapshot().info().chart_faces.min;
    EXPECT_EQ(least < kSmall, locked) << least;
    expect_whole();
    if (!locked) break;
    (void)repository_->unlock_all("somebody");
    (void)repository_->revert("HEAD", {}, options("back"));
    ASSERT_EQ(faces(), faces("1"));
    ASSERT_EQ(repository_->snapshot().find({{OfCharts{{ChartId(chart)}}}, 0}).size(), 1U);
  }
}

TEST_F(Merge, AChartThatComesBackIsJoinedToItsNeighbours) {
  Patch* patch = nullptr;
  EditTransaction edit = repository_->begin_edit();
  patch = &edit.checkout({{OfCharts{{ChartId(4)}}}, 1});
  auto& mesh = patch->mesh();
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  for (const auto f : mesh.all_faces())
    if (mesh.property(patch->chart_property(), f) == 4) mesh.delete_face(f);
  const MeshInfo before = repository_->snapshot().info();
  EXPECT_EQ(edit.commit(options("cut")).charts_removed, 1U);
  EXPECT_TRUE(repository_->revert("HEAD", {}, options("back")).conflicts.empty());
  const MeshInfo after = repository_->snapshot().info();
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  EXPECT_EQ(faces(), faces("1"));
  expect_whole();
}

TEST_F(Merge, BranchesOfDifferentChartsBecomeOne) {
  (void)repository_->create_branch("side");
  Patch *a = nullptr, *b = nullptr;
  EditTransaction on_main = begin(2, a), on_side = begin(7, b, "side");
  lift(*a, 1, 50);
  split_face(*b, 1);
  (void)on_main.commit(options("main"));
  CommitOptions side = options("side");
  side.branch = "side";
  const CommitReport other = on_side.commit(side);
  ASSERT_TRUE(other.conflicts.empty());

  const MergeReport report = repository_->merge("side", options("merged"));
  EXPECT_EQ(report.base, VersionId(1));
  EXPECT_EQ(repository_->show("HEAD").parents, (std::vector<VersionId>{VersionId(2), other.revision}));
  EXPECT_EQ(repository_->snapshot().info().faces, repository_->snapshot({}, "1").info().faces + 2);
  EXPECT_EQ(repository_->diff(repository_->snapshot({}, other.revision.value ? "side" : ""), repository_->snapshot())
                .vertices_moved,
            1U);
  EXPECT_TRUE(repository_->merge("side", options("again")).nothing_changed);
  expect_whole();
}

TEST_F(Merge, ABranchThatIsAheadIsTakenWithoutABlob) {
  (void)repository_->create_branch("side");
  Patch* b = nullptr;
  EditTransaction on_side = begin(7, b, "side");
  lift(*b, 1, 50);
  CommitOptions side = options("side");
  side.branch = "side";
  (void)on_side.commit(side);
  const MergeReport report = repository_->merge("side", options("merged"));
  EXPECT_EQ(report.charts_taken, 1U);
  EXPECT_TRUE(faces() == faces("side"));
  expect_whole();
}

TEST_F(Merge, RevertTakesOneVersionBackAndLeavesLaterOnes) {
  const FaceSet first = faces();
  Patch *a = nullptr, *b = nullptr;
  EditTransaction one = begin(4, a);
  split_face(*a, 2);
  lift(*a, 0, 33);
  ASSERT_TRUE(one.commit(options("one")).conflicts.empty());
  EditTransaction two = begin(9, b);
  lift(*b, 4, 20);
  (void)two.commit(options("two"));
  const CommitReport report = repository_->revert("2", {}, options("back"));
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(repository_->diff(repository_->snapshot({}, "1"), repository_->snapshot()).vertices_moved, 1U);
  (void)repository_->revert("3", {}, options("back, too"));
  EXPECT_TRUE(faces() == first);
  EXPECT_TRUE(repository_->revert("3", {}, options("once more")).nothing_changed);
  expect_whole();
}

TEST_F(Merge, RevertOfWhatWasChangedAgainIsAConflict) {
  Patch *a = nullptr, *b = nullptr;
  EditTransaction one = begin(4, a);
  lift(*a, 0, 33);
  (void)one.commit(options("one"));
  EditTransaction two = begin(4, b);
  lift(*b, 0, 20);
  (void)two.commit(options("two"));
  EXPECT_FALSE(repository_->revert("2", {}, options("back")).conflicts.empty());
  EXPECT_EQ(repository_->resolve("HEAD"), VersionId(3));
}

/// Splits all faces of a patch in three, some times over.
void refine(Patch& patch, int times) {
  auto& mesh = patch.mesh();
  for (; times > 0; --times) {
    std::vector<Patch::Mesh::FaceHandle> faces;
    for (const auto f : mesh.all_faces()) faces.push_back(f);
    for (const auto f : faces) mesh.split(f, mesh.calc_face_centroid(f));
  }
}

PageChart entry_of(const Snapshot& snapshot, std::uint32_t id) {
  return *detail::find_chart(*snapshot.impl().pages().leaf_of(ChartId(id))->leaf, ChartId(id));
}

TEST_F(Merge, AChartThatSplitsCutsBordersOfNeighboursThatKeepTheirBlobs) {
  const Snapshot before = repository_->snapshot();
  const auto neighbours = before.describe({ChartId(4)}).front().neighbours;
  Patch* a = nullptr;
  EditTransaction edit = begin(4, a);
  refine(*a, 2);
  const CommitReport report = edit.commit(options("finer"));
  EXPECT_GT(report.charts_added, 2U);
  const Snapshot after = repository_->snapshot();
  std::size_t cut = 0;
  for (const ChartId id : neighbours) {
    const PageChart was = entry_of(before, id.value), is = entry_of(after, id.value);
    EXPECT_EQ(detail::state_of(is), detail::state_of(was)) << "chart " << id.value;
    cut += is.loops != was.loops;
  }
  EXPECT_GT(cut, 0U) << "the new charts' borders end somewhere";
  EXPECT_EQ(report.charts_reencoded, report.charts_added);
  expect_whole();
}

TEST_F(Merge, AFileWhoseBordersOthersCutStaysOneSurface) {
  const std::filesystem::path file = repository_ / "region.ply";
  const auto neighbour = repository_->snapshot().describe({ChartId(4)}).front().neighbours.front();
  std::vector<ChartId> charts{ChartId(4), neighbour};
  std::sort(charts.begin(), charts.end());
  (void)repository_->checkout_file(repository_->snapshot(), charts, file, {});
  Patch* a = nullptr;
  EditTransaction edit = begin(4, a);
  refine(*a, 2);
  (void)edit.commit(options("finer"));

  const RegionMesh region = repository_->snapshot({}, "1").read(charts);
  std::size_t vertex = 0;
  while (region.keys[vertex] != VertexKey{VertexKey::Where::chart, neighbour.value, 0}) ++vertex;
  for (int round = 1; round <= 3; ++round) {
    auto data = mesh_file::read_mesh(file);
    data.positions[vertex].z += 5 * repository_->snapshot().lattice().step;
    write_data(data, file, mesh_file::Scalar::float32);
    const CommitReport report = repository_->commit_file(file, options("mine"));
    EXPECT_TRUE(report.conflicts.empty());
    EXPECT_EQ(report.vertices_moved, 1U) << "round " << round;
    EXPECT_EQ(report.faces_added + report.faces_removed, 0U);
    EXPECT_TRUE(repository_->status_file(file).clean());
  }
  EXPECT_EQ(repository_->snapshot().info().faces, repository_->snapshot({}, "2").info().faces);
  expect_whole();
}

/// Two sheets of a chart each that touch at a place where each has a vertex.
TestMesh touching_sheets() {
  TestMesh mesh;
  for (std::uint32_t sheet = 0; sheet < 2; ++sheet) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t y = 0; y <= 10; ++y)
      for (std::uint32_t x = 0; x <= 10; ++x) mesh.positions.push_back({10.0 * sheet + x, 10.0 * sheet + y, 0});
    for (std::uint32_t y = 0; y < 10; ++y)
      for (std::uint32_t x = 0; x < 10; ++x) {
        const std::uint32_t v = first + 11 * y + x;
        mesh.faces.push_back({v, v + 1, v + 12});
        mesh.faces.push_back({v, v + 12, v + 11});
      }
  }
  return mesh;
}

TEST(MergeAtOnePlace, VerticesOfDifferentChartsStayTwo) {
  TempRepository repository(touching_sheets(), 200);
  const MeshInfo before = repository->snapshot().info();
  ASSERT_EQ(before.charts, 2U);
  const std::vector<ChartId> both = repository->snapshot().find({{WholeMesh{}}, 0});
  auto mine = repository->begin_edit(), theirs = repository->begin_edit();
  // The faces at the place go from one sheet, and the vertex stays; others change the other sheet and this one
  // elsewhere.
  Patch &mine_patch = mine.checkout({{OfCharts{{both[0]}}}, 0}), &theirs_patch = theirs.checkout({{OfCharts{both}}, 0});
  mine_patch.mesh().request_face_status();
  mine_patch.mesh().request_edge_status();
  mine_patch.mesh().request_vertex_status();
  const auto at_place = [&](Patch& patch, Patch::Mesh::VertexHandle v) {
    const auto p = patch.mesh().point(v);
    return std::abs(p[0] - 10) + std::abs(p[1] - 10) < 0.5;
  };
  for (const auto f : mine_patch.mesh().all_faces())
    for (auto v = mine_patch.mesh().cfv_iter(f); v.is_valid(); ++v)
      if (at_place(mine_patch, *v)) {
        mine_patch.mesh().delete_face(f, false);
        break;
      }
  const double step = repository->snapshot().lattice().step;
  for (const auto v : theirs_patch.mesh().vertices()) {
    const auto p = theirs_patch.mesh().point(v);
    if (std::abs(p[0] - 3) + std::abs(p[1] - 3) < 0.5 || std::abs(p[0] - 15) + std::abs(p[1] - 15) < 0.5)
      theirs_patch.mesh().point(v)[2] += 20 * step;
  }
  (void)theirs.commit(message("elsewhere"));
  CommitOptions merging = message("mine");
  merging.merge = true;
  ASSERT_TRUE(mine.commit(merging).conflicts.empty());
  EXPECT_EQ(repository->snapshot().info().vertices, before.vertices);
  EXPECT_TRUE(repository->verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
