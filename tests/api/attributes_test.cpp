#include <cmath>
#include <limits>

#include "api/mesh_file/mesh_file.h"
#include "db/store.h"
#include "ramcdb/edit_transaction.h"
#include "tests/api/painted_grid.h"

/// Attributes and polygons on their way in, through edits, and out.
namespace ramcdb::test {
namespace {

using mesh_file::MeshData;

TEST(Attributes, ComeBackWithTheirPolygonsFromEveryVersion) {
  const MeshData mesh = painted_grid(60);
  for (const bool lossless : {false, true}) {
    Painted repository(mesh, lossless);
    EXPECT_GT(repository.report().info.charts, 10U);
    EXPECT_TRUE(repository.report().dropped.empty());
    const Snapshot snapshot = repository->snapshot();
    for (const MeshInfo::Layer& layer : snapshot.info().attributes)
      EXPECT_EQ(layer.max_error > 0, !lossless && layer.info.meaning != Meaning::color && layer.info.name != "heat" &&
                                         layer.info.name != "flags")
          << layer.info.name;
    for (const char* name : {"out.ply", "region.ply"}) {
      const auto left_out =
          name[0] == 'o'
              ? repository->export_mesh(snapshot, repository / name, {}).left_out
              : repository->checkout_file(snapshot, snapshot.find({{WholeMesh{}}, 0}), repository / name, {}).left_out;
      EXPECT_TRUE(left_out.empty());
      const MeshData read = mesh_file::read_mesh(repository / name);
      EXPECT_EQ(read.face_count(), mesh.face_count());
      EXPECT_TRUE(records(snapshot, read) == records(snapshot, mesh)) << name;
    }
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(Attributes, PolygonsStayWholeInEveryChart) {
  Painted repository(painted_grid(40));
  const Snapshot snapshot = repository->snapshot();
  std::size_t faces = 0;
  for (const ChartId id : snapshot.find({{WholeMesh{}}, 0})) {
    const RegionMesh chart = snapshot.read_with_attributes({id});
    faces += chart.polygon_sizes.size();
    EXPECT_TRUE(snapshot.read({id}).polygon_sizes.empty()) << "geometry alone was asked for";
  }
  EXPECT_EQ(faces, painted_grid(40).face_count());
}

TEST(Attributes, AGeometryReadDoesNotTouchThem) {
  Painted repository(painted_grid(40));
  const Snapshot snapshot = repository->snapshot();
  const std::vector<ChartId> one{snapshot.find({{WholeMesh{}}, 0}).front()};
  ReadCost geometry, all;
  (void)snapshot.read(one, 1, &geometry);
  (void)snapshot.read_with_attributes(one, 1, &all);
  EXPECT_EQ(all.blobs, geometry.blobs + 6);
}

TEST(Attributes, AnUneditedFileIsNoEditInAnyFormat) {
  Painted repository(painted_grid(40));
  const Snapshot snapshot = repository->snapshot();
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.glb", "a.gltf"}) {
    (void)repository->checkout_file(snapshot, snapshot.find({{InBox{{5, 5, -9}, {20, 20, 9}}}, 0}), repository / name,
                                    {});
    const ChangeReport change = repository->status_file(repository / name);
    EXPECT_TRUE(change.clean()) << name << ' ' << change.vertices_moved << ' ' << change.values_changed;
    EXPECT_TRUE(repository->commit_file(repository / name, message("nothing")).nothing_changed) << name;
  }
}

TEST(Attributes, AnEditOfColoursWritesColoursOnly) {
  Painted repository(painted_grid(40));
  const Snapshot before = repository->snapshot();
  const std::filesystem::path file = repository / "a.ply";
  (void)repository->checkout_file(before, before.find({{NearestTo{{20, 20, 0}}}, 0}), file, {});
  MeshData mesh = mesh_file::read_mesh(file);
  for (Attribute& attribute : mesh.attributes)
    if (attribute.info.name == "color")
      for (double& level : attribute.values) level = 255 - level;
  write_data(mesh, file);
  const CommitReport report = repository->commit_file(file, message("negative"));
  EXPECT_EQ(report.vertices_moved, 0U);
  EXPECT_EQ(report.values_changed, mesh.positions.size());
  EXPECT_EQ(report.charts_reencoded, 0U);
  EXPECT_GT(report.layers_reencoded, 1U) << "neighbours share the border";
  EXPECT_EQ(repository.written(report.revision, db::Kind::chart), 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::wire), 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::attribute), report.layers_reencoded);
  EXPECT_TRUE(repository->verify({}).ok());
  // The new version has them, the old one the old ones, and shared vertices agree.
  const Snapshot after = repository->snapshot();
  (void)repository->checkout_file(after, after.find({{NearestTo{{20, 20, 0}}}, 0}), repository / "b.ply", {});
  EXPECT_TRUE(records(after, mesh_file::read_mesh(repository / "b.ply")) == records(after, mesh));
  (void)repository->export_mesh(before, repository / "old.ply", {});
  EXPECT_TRUE(records(before, mesh_file::read_mesh(repository / "old.ply")) == records(before, painted_grid(40)));
  std::map<VertexKey, std::vector<double>> seen;
  for (const ChartId id : after.find({{WholeMesh{}}, 0})) {
    const RegionMesh chart = after.read_with_attributes({id});
    for (std::size_t v = 0; v < chart.keys.size(); ++v) {
      const auto first = chart.attributes[0].values.begin() + static_cast<std::ptrdiff_t>(3 * v);
      const std::vector<double> color(first, first + 3);
      if (chart.keys[v].where != VertexKey::Where::chart) {
        EXPECT_EQ(seen.emplace(chart.keys[v], color).first->second, color);
      }
    }
  }
  EXPECT_TRUE(repository->status_file(file).clean());
}

TEST(Attributes, AnEditOfGeometryWritesGeometryOnly) {
  Painted repository(painted_grid(40));
  const Snapshot before = repository->snapshot();
  const std::filesystem::path file = repository / "a.ply";
  const std::vector<ChartId> charts = before.find({{NearestTo{{20, 20, 0}}}, 0});
  (void)repository->checkout_file(before, charts, file, {});
  MeshData mesh = mesh_file::read_mesh(file);
  for (Point& p : mesh.positions) p.z += p.x * p.y * 0.01;
  write_data(mesh, file);
  const CommitReport report = repository->commit_file(file, message("bent"));
  EXPECT_EQ(report.values_changed, 0U);
  EXPECT_GT(report.charts_reencoded, 0U);
  EXPECT_EQ(repository.written(report.revision, db::Kind::attribute), 0U);
  EXPECT_TRUE(repository->verify({}).ok());
  const Snapshot after = repository->snapshot();
  (void)repository->checkout_file(after, charts, repository / "b.ply", {});
  EXPECT_TRUE(records(after, mesh_file::read_mesh(repository / "b.ply")) == records(after, mesh));
}

std::vector<double> values_of(const std::vector<Attribute>& attributes, std::string_view name) {
  for (const Attribute& attribute : attributes)
    if (attribute.info.name == name) return attribute.values;
  ADD_FAILURE() << "no attribute " << name;
  return {};
}

TEST(Attributes, CornersFacesAndVerticesAreEditedThroughThePatchToo) {
  Painted repository(painted_grid(40));
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout({{NearestTo{{20, 20, 0}}}, 1});
  ASSERT_EQ(patch.attribute("nothing"), nullptr);
  patch.attribute("flags")->values.at(3) = -30000;
  patch.attribute("texture")->values.at(2) = kNone;
  patch.attribute("texture")->values.at(3) = kNone;
  patch.attribute("heat")->values.at(1) = 0.1F;
  patch.mesh().point(Patch::Mesh::VertexHandle(0))[2] += 1;
  const RegionMesh region = patch.region();
  const std::vector<Attribute> expected = patch.attributes();
  const std::vector<ChartId> charts = region.charts;
  EXPECT_EQ(edit.status().values_changed, 3U);
  const CommitReport report = edit.commit(message("three values and a vertex"));
  EXPECT_EQ(report.values_changed, 3U);
  EXPECT_EQ(report.vertices_moved, 1U);
  const RegionMesh now = repository->snapshot().read_with_attributes(charts);
  const std::vector<double> heat = values_of(now.attributes, "heat");
  std::vector<double> flags = values_of(now.attributes, "flags"), wanted = values_of(expected, "flags");
  std::sort(flags.begin(), flags.end());
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(flags, wanted);
  const auto absent = [](const std::vector<double>& values) {
    return std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
  };
  EXPECT_EQ(absent(values_of(now.attributes, "texture")), absent(values_of(expected, "texture")));
  EXPECT_EQ(absent(values_of(now.attributes, "texture")), absent(values_of(region.attributes, "texture")) + 2);
  EXPECT_EQ(std::count(heat.begin(), heat.end(), double{0.1F}), 1);
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Attributes, NumbersThatALayerCannotHoldAreRefused) {
  Painted repository(painted_grid(20));
  for (const double number : {300.0, -1.0, 0.5}) {
    auto edit = repository->begin_edit();
    edit.checkout({{WholeMesh{}}, 0}).attribute("color")->values.front() = number;
    EXPECT_THROW((void)edit.commit(message("too much")), Error) << number;
  }
  EXPECT_EQ(repository->snapshot().version(), VersionId(1));
}

TEST(Attributes, PaintingConflictsWithPaintingOfTheSameChartOnly) {
  Painted repository(painted_grid(40));
  auto first = repository->begin_edit(), second = repository->begin_edit(), third = repository->begin_edit();
  const Snapshot base = repository->snapshot();
  const ChartId chart = base.find({{NearestTo{{20, 20, 0}}}, 0}).front();
  const auto touch_face = [&](EditTransaction& edit, ChartId id) {
    edit.checkout({{OfCharts{{id}}}, 0}).attribute("flags")->values.front() = 99;
  };
  touch_face(first, chart);
  touch_face(second, chart);
  touch_face(third, ChartId(chart.value == 1 ? 2 : 1));
  EXPECT_TRUE(first.commit(message("first")).conflicts.empty());
  EXPECT_EQ(second.commit(message("second")).conflicts, std::vector<ChartId>{chart});
  EXPECT_TRUE(third.commit(message("third")).conflicts.empty());
  EXPECT_EQ(repository->diff(base, repository->snapshot()).changed.size(), 2U);
}

TEST(Attributes, OfPiecesWithoutBorderFollowTheirVerticesWhereverTheyMove) {
  // Boxes in one chart: nothing of connectivity says which box is which, so that layers follow the geometry.
  TestMesh boxes_mesh = boxes(40);
  MeshData mesh;
  mesh.positions = boxes_mesh.positions;
  for (const Triangle& t : boxes_mesh.faces) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  Attribute number = make_attribute("number", AttributeOf::vertex, NumberType::int32, 1, Meaning::other);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) number.values.push_back(static_cast<double>(v));
  mesh.attributes = {number};
  Painted repository(mesh);
  const std::filesystem::path file = repository / "a.ply";
  const Snapshot before = repository->snapshot();
  (void)repository->checkout_file(before, before.find({{WholeMesh{}}, 0}), file, {});
  MeshData moved = mesh_file::read_mesh(file);
  for (Point& p : moved.positions) std::swap(p.x, p.y), p.z = -p.z * 0.5;
  write_data(moved, file);
  const CommitReport report = repository->commit_file(file, message("turned"));
  EXPECT_EQ(report.values_changed, 0U);
  const Snapshot after = repository->snapshot();
  (void)repository->export_mesh(after, repository / "out.ply", {});
  EXPECT_TRUE(records(after, mesh_file::read_mesh(repository / "out.ply")) == records(after, moved));
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST(Attributes, APolygonFileMayComeBackRenumberedOrCut) {
  Painted repository(painted_grid(24));
  const Snapshot before = repository->snapshot();
  const auto charts = before.find({{WholeMesh{}}, 0});
  for (const bool cut : {false, true}) {
    const std::filesystem::path file = repository / (cut ? "cut.obj" : "turned.obj");
    (void)repository->checkout_file(before, charts, file, {});
    MeshData mesh = mesh_file::read_mesh(file), other;
    other.positions.assign(mesh.positions.rbegin(), mesh.positions.rend());
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    if (cut) {
      // The triangles that the repository keeps: a tool that triangulates otherwise is refused.
      const RegionMesh region = before.read(charts);
      for (const Triangle& t : region.faces)
        for (const std::uint32_t v : t) other.corners.push_back(last - v);
    } else {
      std::size_t end = mesh.corners.size();
      for (auto size = mesh.face_sizes.rbegin(); size != mesh.face_sizes.rend(); ++size, end -= *(size - 1)) {
        other.face_sizes.push_back(*size);
        for (std::uint32_t i = 0; i < *size; ++i)
          other.corners.push_back(last - mesh.corners[end - *size + (i + 1) % *size]);
      }
    }
    for (Point& p : other.positions)
      if (p.x > 10 && p.x < 12) p.z += 0.5;
    write_data(other, file);
    const ChangeReport change = repository->status_file(file);
    EXPECT_EQ(change.vertices_moved, 25U) << cut;
    EXPECT_EQ(change.values_changed, 0U) << cut;
  }
}

}  // namespace
}  // namespace ramcdb::test
