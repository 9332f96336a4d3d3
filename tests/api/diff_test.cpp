#include <cmath>
#include <set>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/painted_grid.h"
#include "tests/api/temp_repository.h"

/// What status says of an edit and what diff says of the two versions around it are the same, counted in other ways.
namespace ramcdb::test {
namespace {

using Mesh = Patch::Mesh;

Region one_chart(std::uint32_t id) { return {{OfCharts{{ChartId(id)}}}, 0}; }

void allow_deletion(Mesh& mesh) {
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
}

/// Faces without a vertex on the patch's border, or next to one.
std::vector<Mesh::FaceHandle> inner_faces(const Patch& patch) {
  std::vector<Mesh::FaceHandle> faces;
  for (const auto f : patch.mesh().all_faces()) {
    bool inside = true;
    for (const auto v : patch.mesh().fv_range(f))
      for (const auto w : patch.mesh().vv_range(v)) inside = inside && !patch.on_outer_border(w);
    if (inside) faces.push_back(f);
  }
  return faces;
}

void lift_outwards(Mesh& mesh, Mesh::VertexHandle v, double by) { mesh.set_point(v, mesh.point(v) * (1 + by)); }

const ChartChange* change_of(const std::vector<ChartChange>& changes, ChartId chart) {
  for (const ChartChange& change : changes)
    if (change.chart == chart) return &change;
  return nullptr;
}

void expect_equal(const ChangeFigures& status, const ChangeFigures& diff) {
  EXPECT_EQ(status.vertices_moved, diff.vertices_moved);
  EXPECT_EQ(status.vertices_added, diff.vertices_added);
  EXPECT_EQ(status.vertices_removed, diff.vertices_removed);
  EXPECT_EQ(status.faces_added, diff.faces_added);
  EXPECT_EQ(status.faces_removed, diff.faces_removed);
  EXPECT_EQ(status.values_changed, diff.values_changed);
  EXPECT_NEAR(status.max_displacement, diff.max_displacement, 1e-12);
  EXPECT_NEAR(status.rms_displacement, diff.rms_displacement, 1e-12);
  EXPECT_NEAR(status.area_after - status.area_before, diff.area_after - diff.area_before, 1e-9);
  ASSERT_EQ(status.volume_change.has_value(), diff.volume_change.has_value());
  EXPECT_NEAR(status.volume_change.value_or(0), diff.volume_change.value_or(0), 1e-12);
}

/// Commits an edit and compares its status with the versions; returns both.
struct Compared {
  ChangeReport status;
  DiffReport diff;
};
Compared commit_and_compare(TempRepository& repository, EditTransaction& edit) {
  Compared compared{edit.status(), {}};
  const Snapshot before = edit.base();
  (void)edit.commit(message("edit"));
  compared.diff = repository->diff(before, repository->snapshot(before.info().mesh));
  expect_equal(compared.status, compared.diff);
  return compared;
}

TEST(Diff, CountsFacesAndVerticesThatASplitAdds) {
  TempRepository repository(sphere(6000), 500);
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout(one_chart(4));
  Mesh& mesh = patch.mesh();
  const auto face = inner_faces(patch).front();
  mesh.split(face, mesh.calc_face_centroid(face) * 1.5);
  const auto [status, diff] = commit_and_compare(repository, edit);
  EXPECT_EQ(status.vertices_added, 1U);
  EXPECT_EQ(status.faces_added, 3U);
  EXPECT_EQ(status.faces_removed, 1U);
  EXPECT_EQ(status.vertices_moved + status.vertices_removed, 0U);
  EXPECT_EQ(status.charts_touched, std::vector{ChartId(4)});
  ASSERT_TRUE(status.volume_change);
  EXPECT_GT(*status.volume_change, 0) << "a spike outwards";
  const ChartChange* there = change_of(diff.per_chart, ChartId(4));
  ASSERT_NE(there, nullptr);
  EXPECT_EQ(there->change_class(), ChangeClass::remeshed);
  expect_equal(*there, *change_of(status.per_chart, ChartId(4)));
}

/// A new vertex on the very place of one that charts outside share is new all the same, and gone on the way back.
TEST(Diff, CountsAVertexThatLiesOnTheBorder) {
  TempRepository repository(sphere(6000), 500);
  const Snapshot before = repository->snapshot();
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout(one_chart(4));
  Mesh& mesh = patch.mesh();
  std::vector<Mesh::FaceHandle> at_border;
  for (const auto f : mesh.faces())
    for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v)
      if (at_border.empty() || at_border.back() != f)
        if (patch.on_outer_border(*v)) at_border.push_back(f);
  std::size_t added = 0;
  for (const auto f : at_border)
    for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v)
      if (patch.on_outer_border(*v)) {
        mesh.split(f, mesh.point(*v));
        ++added;
        break;
      }
  ASSERT_GT(added, 20U);
  (void)edit.commit(message("split"));
  const Snapshot after = repository->snapshot();
  const DiffReport there = repository->diff(before, after), back = repository->diff(after, before);
  EXPECT_EQ(there.vertices_added, added);
  EXPECT_EQ(back.vertices_removed, added);
  EXPECT_EQ(there.vertices_removed + there.vertices_moved + back.vertices_added + back.vertices_moved, 0U);
}

TEST(Diff, CountsWhatIsGone) {
  TempRepository repository(sphere(6000), 500);
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout(one_chart(4));
  allow_deletion(patch.mesh());
  const auto v = *patch.mesh().fv_begin(inner_faces(patch).front());
  const auto faces = patch.mesh().valence(v);
  patch.mesh().delete_vertex(v, true);
  patch.mesh().garbage_collection();
  const auto [status, diff] = commit_and_compare(repository, edit);
  EXPECT_EQ(status.vertices_removed, 1U);
  EXPECT_EQ(status.faces_removed, faces);
  EXPECT_EQ(status.faces_added + status.vertices_added + status.vertices_moved, 0U);
  EXPECT_FALSE(status.volume_change) << "there is a hole now";
  EXPECT_LT(status.area_after, status.area_before);
}

TEST(Diff, KnowsWhatIsRemovedWithAWholeChart) {
  TempRepository repository(sphere(6000), 500);
  auto edit = repository->begin_edit();
  Region region = one_chart(4);
  region.grow = 1;
  Patch& patch = edit.checkout(region);
  Mesh& mesh = patch.mesh();
  allow_deletion(mesh);
  std::uint64_t faces = 0, inside = 0;
  for (const auto v : mesh.all_vertices()) {
    const VertexKey key = VertexKey::unpack(mesh.property(patch.key_property(), v));
    inside += key.where == VertexKey::Where::chart && key.id == 4;
  }
  for (const auto f : mesh.all_faces())
    if (mesh.property(patch.chart_property(), f) == 4) {
      mesh.delete_face(f, true);
      ++faces;
    }
  mesh.garbage_collection();
  const auto [status, diff] = commit_and_compare(repository, edit);
  EXPECT_EQ(diff.removed, std::vector{ChartId(4)});
  EXPECT_EQ(diff.faces_removed, faces);
  EXPECT_EQ(diff.vertices_removed, inside) << "its border is its neighbours', too";
  EXPECT_EQ(change_of(diff.per_chart, ChartId(4))->faces_removed, faces);
}

TEST(Diff, SeesThroughChartsThatWereCutAnew) {
  TempRepository repository(scan(6000), 400);
  const std::uint64_t charts = repository->snapshot().info().charts;
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout(one_chart(3));
  Mesh& mesh = patch.mesh();
  const auto faces = inner_faces(patch);
  const auto moved = *mesh.fv_begin(faces.back());
  std::set<int> kept;
  for (const auto f : mesh.vf_range(moved)) kept.insert(f.idx());
  std::uint64_t splits = 0;
  for (const auto f : faces) {
    if (kept.contains(f.idx())) continue;
    mesh.split(f, mesh.calc_face_centroid(f));
    ++splits;
  }
  lift_outwards(mesh, moved, 0.01);
  const auto [status, diff] = commit_and_compare(repository, edit);
  EXPECT_EQ(diff.vertices_added, splits);
  EXPECT_EQ(diff.faces_added, 3 * splits);
  EXPECT_EQ(diff.faces_removed, splits);
  EXPECT_EQ(diff.vertices_moved, 1U);
  EXPECT_FALSE(diff.added.empty());
  EXPECT_GT(repository->snapshot().info().charts, charts);
  std::uint64_t added = 0;
  for (const ChartChange& change : diff.per_chart) added += change.faces_added;
  EXPECT_EQ(added, diff.faces_added) << "every face is in one chart";

  const DiffReport back = repository->diff(repository->snapshot(), repository->snapshot("mesh", "v1"));
  EXPECT_EQ(back.vertices_removed, splits);
  EXPECT_EQ(back.faces_added, splits);
  EXPECT_EQ(back.removed, diff.added);
}

TEST(Diff, ChartsThatWereOnlyCodedAnewAreUntouched) {
  TempRepository repository(scan(6000), 400);
  RepackOptions options;
  options.profile = ChartProfile::fast;
  (void)repository->repack("mesh", options);
  const DiffReport diff = repository->diff(repository->snapshot("mesh", "v1"), repository->snapshot());
  EXPECT_TRUE(diff.clean());
  EXPECT_EQ(diff.changed.size(), repository->snapshot().info().charts);
  ASSERT_EQ(diff.per_chart.size(), diff.changed.size());
  for (const ChartChange& change : diff.per_chart) EXPECT_EQ(change.change_class(), ChangeClass::untouched);
  EXPECT_EQ(diff.area_before, diff.area_after);
  EXPECT_EQ(diff.volume_change, 0.0);
}

/// A sphere far away: its volume relative to the world's origin would have lost all its digits.
TEST(Diff, VolumeAndAreaAreThoseOfTheShapeWhereverItIs) {
  TestMesh mesh = sphere(8000);
  for (Point& p : mesh.positions) p = {p.x + 5e6, p.y - 3e6, p.z + 4e6};
  TempRepository repository(mesh, 500, 20);
  auto edit = repository->begin_edit();
  Mesh& patch = edit.checkout({{WholeMesh{}}, 0}).mesh();
  const Mesh::Point middle(5e6, -3e6, 4e6);
  const double r = (patch.point(Mesh::VertexHandle(0)) - middle).norm();
  for (const auto v : patch.all_vertices()) patch.set_point(v, middle + (patch.point(v) - middle) * 1.1);
  const auto [status, diff] = commit_and_compare(repository, edit);
  const double volume = 4 * std::acos(-1.0) / 3 * r * r * r, area = 4 * std::acos(-1.0) * r * r;
  ASSERT_TRUE(status.volume_change);
  EXPECT_NEAR(*status.volume_change, volume * (1.331 - 1), volume * 0.01);
  EXPECT_NEAR(status.area_before, area, area * 0.01);
  EXPECT_NEAR(status.area_after, area * 1.21, area * 0.02);
  EXPECT_NEAR(status.rms_displacement, 0.1 * r, 1e-4 * r);
  for (const ChartChange& change : diff.per_chart) EXPECT_EQ(change.change_class(), ChangeClass::moved);
}

TEST(Diff, VolumeIsNotSaidWhereAnOpenBorderMoved) {
  TempRepository repository(terrain(30, 30), 300);
  for (const bool inside : {true, false}) {
    auto edit = repository->begin_edit();
    Mesh& mesh = edit.checkout({{WholeMesh{}}, 0}).mesh();
    for (const auto v : mesh.all_vertices())
      if (mesh.is_boundary(v) != inside) {
        mesh.set_point(v, mesh.point(v) + Mesh::Point(0, 0, 5 * edit.base().lattice().step));
        break;
      }
    const auto [status, diff] = commit_and_compare(repository, edit);
    EXPECT_EQ(status.vertices_moved, 1U);
    EXPECT_EQ(status.volume_change.has_value(), inside);
  }
}

TEST(Diff, ClassesOfChartsWhoseValuesChanged) {
  TempRepository repository(sphere(100));
  const mesh_file::MeshData grid = painted_grid(40);
  write_data(grid, repository / "grid.ply", mesh_file::Scalar::float32);
  ImportOptions options;
  options.name = "grid";
  options.chart_faces = 500;
  (void)repository->import(repository / "grid.ply", options);

  auto edit = repository->begin_edit("grid");
  Patch& patch = edit.checkout(one_chart(2));
  Attribute* flags = patch.attribute("flags");
  ASSERT_NE(flags, nullptr);
  flags->values[5] += 1;
  const auto [status, diff] = commit_and_compare(repository, edit);
  EXPECT_EQ(status.values_changed, 1U);
  EXPECT_EQ(diff.vertices_moved, 0U);
  ASSERT_EQ(diff.per_chart.size(), 1U);
  EXPECT_EQ(diff.per_chart[0].change_class(), ChangeClass::attributes);
  EXPECT_EQ(diff.per_chart[0].values_changed, 1U);
}

TEST(Diff, OfDifferentMeshesIsRefused) {
  TempRepository repository(sphere(500));
  write_test_mesh(terrain(10, 10), repository / "other.ply");
  (void)repository->import(repository / "other.ply", {});
  EXPECT_THROW((void)repository->diff(repository->snapshot("mesh"), repository->snapshot("other")), Error);
}

const Attribute* attribute_of(const mesh_file::MeshData& mesh, std::string_view name) {
  for (const Attribute& attribute : mesh.attributes)
    if (attribute.info.name == name) return &attribute;
  return nullptr;
}

/// A sphere with one vertex moved and one face split, far from each other.
class HeatmapTest : public testing::Test {
 protected:
  void SetUp() override {
    auto edit = repository_->begin_edit();
    Patch& patch = edit.checkout(one_chart(4));
    Mesh& mesh = patch.mesh();
    const auto faces = inner_faces(patch);
    lift_outwards(mesh, *mesh.fv_begin(faces.front()), 0.1);
    mesh.split(faces.back(), mesh.calc_face_centroid(faces.back()));
    report_ = edit.status();
    (void)edit.commit(message("edit"));
  }

  [[nodiscard]] DiffReport diff(const std::string& file, bool all = false) {
    DiffOptions options;
    options.heatmap = repository_ / file;
    options.heatmap_of_all = all;
    return repository_->diff(repository_->snapshot("mesh", "v1"), repository_->snapshot(), options);
  }

  /// Vertices with this colour.
  static int count(const mesh_file::MeshData& mesh, const std::array<double, 3>& color) {
    const Attribute* colors = attribute_of(mesh, "color");
    int found = 0;
    for (std::size_t v = 0; colors && v < mesh.positions.size(); ++v)
      found += std::equal(color.begin(), color.end(), colors->values.begin() + static_cast<std::ptrdiff_t>(3 * v));
    return found;
  }

  static constexpr std::array<double, 3> kMost{253, 231, 37}, kNone{68, 1, 84}, kAdded{230, 30, 140};
  TempRepository repository_{sphere(6000), 500};
  ChangeReport report_;
};

TEST_F(HeatmapTest, PlyHasDisplacementsAndColours) {
  const DiffReport report = diff("heat.ply");
  const mesh_file::MeshData mesh = mesh_file::read_mesh(repository_ / "heat.ply");
  EXPECT_EQ(count(mesh, kMost), 1);
  EXPECT_EQ(count(mesh, kAdded), 4) << "three new faces around a new vertex";
  EXPECT_EQ(count(mesh, kMost) + count(mesh, kNone) + count(mesh, kAdded), static_cast<int>(mesh.positions.size()));
  const Attribute* displacement = attribute_of(mesh, "displacement");
  ASSERT_NE(displacement, nullptr);
  EXPECT_EQ(displacement->info.type, NumberType::float32);
  EXPECT_EQ(*std::max_element(displacement->values.begin(), displacement->values.end()),
            static_cast<float>(report.max_displacement));
  EXPECT_NEAR(report.max_displacement, report_.max_displacement, 1e-12);
  EXPECT_FALSE(std::filesystem::exists(repository_ / "heat.ply.ramcdb.json"));
}

TEST_F(HeatmapTest, OfAllShowsTheWholeMesh) {
  (void)diff("some.ply");
  (void)diff("all.ply", true);
  const mesh_file::MeshData some = mesh_file::read_mesh(repository_ / "some.ply");
  const mesh_file::MeshData all = mesh_file::read_mesh(repository_ / "all.ply");
  EXPECT_EQ(all.face_count(), repository_->snapshot().info().faces);
  EXPECT_LT(some.face_count(), all.face_count());
  EXPECT_EQ(count(all, kMost), 1);
  EXPECT_EQ(count(all, kAdded), 4);
}

TEST_F(HeatmapTest, GlbHasTheSameColours) {
  (void)diff("heat.glb");
  const mesh_file::MeshData mesh = mesh_file::read_mesh(repository_ / "heat.glb");
  ASSERT_FALSE(mesh.attributes.empty());
  EXPECT_GE(count(mesh, kMost), 1);
  EXPECT_GE(count(mesh, kAdded), 4);
}

TEST_F(HeatmapTest, IsNeverWrittenOverACheckedOutFile) {
  const Snapshot now = repository_->snapshot();
  (void)repository_->checkout_file(now, {ChartId(4)}, repository_ / "mine.ply", {});
  EXPECT_THROW((void)diff("mine.ply"), Error);
  EXPECT_THROW((void)repository_->status_file(repository_ / "mine.ply", repository_ / "mine.ply"), Error);
  EXPECT_THROW((void)diff("heat.obj"), Error);
  EXPECT_TRUE(repository_->status_file(repository_ / "mine.ply", repository_ / "heat.ply").clean());
  EXPECT_GT(mesh_file::read_mesh(repository_ / "heat.ply").face_count(), 0U);
}

}  // namespace
}  // namespace ramcdb::test
