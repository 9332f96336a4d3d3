#include <algorithm>
#include <set>

#include "ramcdb/edit_transaction.h"
#include "ramcdb/error.h"
#include "tests/api/painted_grid.h"

/// What a version did is taken back in a region only.
namespace ramcdb::test {
namespace {

constexpr std::uint32_t kCells = 40;

using Places = std::map<std::pair<double, double>, double>;

class RevertInRegion : public ::testing::Test {
 protected:
  /// Commits what `change` does to a patch of everything.
  CommitReport edit(const std::function<void(Patch&)>& change) {
    EditTransaction edit = repository_->begin_edit();
    Patch& patch = edit.checkout({{WholeMesh{}}, 0});
    patch.mesh().request_vertex_status();
    patch.mesh().request_edge_status();
    patch.mesh().request_face_status();
    change(patch);
    return edit.commit(message("edit"));
  }

  CommitReport revert(const char* version, RegionShape shape) {
    return repository_->revert(version, {}, message("back"), Region{{std::move(shape)}, 0});
  }

  /// Heights over the grid.
  [[nodiscard]] Places heights(const char* revision = "") {
    const Snapshot snapshot = repository_->snapshot({}, revision);
    const RegionMesh mesh = whole(snapshot);
    Places places;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Point p = snapshot.position(mesh, v);
      places[{std::round(p.x), std::round(p.y)}] = p.z;
    }
    return places;
  }

  FaceSet faces(const char* revision = "") { return face_set(whole(repository_->snapshot({}, revision))); }

  /// Splits the triangles whose middle lies at most half a cell from a place; returns how many.
  static std::size_t split_near(Patch& patch, double x, double y) {
    auto& mesh = patch.mesh();
    std::vector<Patch::Mesh::FaceHandle> found;
    for (const auto f : mesh.all_faces()) {
      const auto middle = mesh.calc_face_centroid(f);
      if (std::abs(middle[0] - x) < 0.5 && std::abs(middle[1] - y) < 0.5) found.push_back(f);
    }
    for (const auto f : found) mesh.split(f, mesh.calc_face_centroid(f));
    return found.size();
  }

  void expect_whole() { EXPECT_TRUE(repository_->verify({}).ok()); }

  Painted repository_{painted_grid(kCells)};
};

constexpr InBox kLeft{{-1, -1, -9}, {10.5, 50, 9}};

TEST_F(RevertInRegion, VerticesInsideGoBackAndAllOthersStay) {
  const Places before = heights();
  ASSERT_GT(edit([](Patch& patch) {
              for (const auto v : patch.mesh().vertices()) patch.mesh().point(v)[2] += 0.5;
            }).vertices_moved,
            1000U);
  const Places lifted = heights();
  const CommitReport report = revert("2", kLeft);
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(report.vertices_moved, 11U * (kCells + 1));
  for (const auto& [place, z] : heights()) EXPECT_EQ(z, (place.first < 10.5 ? before : lifted).at(place));
  EXPECT_TRUE(revert("2", kLeft).nothing_changed);
  EXPECT_FALSE(revert("2", WholeMesh{}).nothing_changed);
  EXPECT_TRUE(heights() == before);
  expect_whole();
}

TEST_F(RevertInRegion, AVertexCountsWhereItWasAndWhereItIs) {
  (void)edit([](Patch& patch) {
    for (const auto v : patch.mesh().vertices())
      if (patch.mesh().point(v)[0] < 0.5 && patch.mesh().point(v)[1] < 0.5) patch.mesh().point(v)[2] += 3;
  });
  const InSphere was{{0, 0, 0}, 0.5}, is{{0, 0, 3}, 0.5}, beside{{0, 0, 1.5}, 0.5};
  EXPECT_TRUE(revert("2", beside).nothing_changed);
  EXPECT_EQ(revert("2", was).vertices_moved, 1U);
  ASSERT_EQ(repository_->revert("3", {}, message("again")).vertices_moved, 1U);
  EXPECT_EQ(revert("2", is).vertices_moved, 1U);
  EXPECT_TRUE(faces() == faces("1"));
}

TEST_F(RevertInRegion, OfReplacedFacesTheIslandsThatAreMetGoBackWhole) {
  std::size_t left = 0, right = 0;
  (void)edit([&](Patch& patch) {
    left = split_near(patch, 5.5, 5.5);
    right = split_near(patch, 30.5, 30.5);
  });
  ASSERT_GT(left, 0U);
  ASSERT_GT(right, 0U);
  const CommitReport report = revert("2", InBox{{5.4, 5.4, -9}, {5.6, 5.6, 9}});
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(report.vertices_removed, left);
  EXPECT_EQ(report.faces_removed, 3 * left);
  EXPECT_EQ(report.faces_added, left);
  (void)revert("2", InBox{{30.4, 30.4, -9}, {30.6, 30.6, 9}});
  EXPECT_EQ(repository_->snapshot().info().faces, repository_->snapshot({}, "1").info().faces);
  expect_whole();
}

TEST_F(RevertInRegion, WhatWasDeletedComesBackWithItsPolygonsAndValues) {
  (void)edit([](Patch& patch) {
    auto& mesh = patch.mesh();
    for (const auto f : mesh.all_faces()) {
      const auto middle = mesh.calc_face_centroid(f);
      if ((middle[0] < 4 && middle[1] < 4) || (middle[0] > 36 && middle[1] > 36)) mesh.delete_face(f, true);
    }
  });
  const std::uint64_t whole_faces = repository_->snapshot({}, "1").info().faces;
  const std::uint64_t left = repository_->snapshot().info().faces;
  (void)revert("2", InBox{{1, 1, -9}, {2, 2, 9}});
  EXPECT_EQ(repository_->snapshot().info().faces, whole_faces - (whole_faces - left) / 2);
  (void)revert("2", InBox{{38, 38, -9}, {39, 39, 9}});
  EXPECT_TRUE(faces() == faces("1"));
  const Snapshot first = repository_->snapshot({}, "1"), now = repository_->snapshot();
  (void)repository_->export_mesh(first, repository_ / "first.ply", {});
  (void)repository_->export_mesh(now, repository_ / "now.ply", {});
  EXPECT_EQ(records(first, mesh_file::read_mesh(repository_ / "first.ply")),
            records(now, mesh_file::read_mesh(repository_ / "now.ply")));
  expect_whole();
}

TEST_F(RevertInRegion, ValuesInsideGoBack) {
  (void)edit([](Patch& patch) {
    for (double& value : patch.attribute("heat")->values) value += 1;
    for (double& value : patch.attribute("flags")->values) value += 1;
  });
  const CommitReport report = revert("2", kLeft);
  EXPECT_TRUE(report.conflicts.empty());
  EXPECT_EQ(report.vertices_moved, 0U);
  const Snapshot first = repository_->snapshot({}, "1"), now = repository_->snapshot();
  const RegionMesh was = whole(first), is = whole(now);
  ASSERT_EQ(was.points, is.points);
  std::size_t back = 0;
  for (std::size_t a = 0; a < was.attributes.size(); ++a) {
    const auto& [info, before] = was.attributes[a];
    const auto& after = is.attributes[a].values;
    if (info.name == "heat")
      for (std::size_t v = 0; v < before.size(); ++v) {
        const bool inside = now.position(is, v).x < 10.5;
        back += inside;
        EXPECT_NEAR(after[v], before[v] + (inside ? 0 : 1), 1e-4);
      }
    if (info.name == "flags")
      for (std::size_t f = 0; f < before.size(); ++f) {
        const bool met =
            std::ranges::any_of(is.faces[f], [&](std::uint32_t v) { return now.position(is, v).x < 10.5; });
        EXPECT_EQ(after[f], before[f] + (met ? 0 : 1));
      }
  }
  EXPECT_EQ(back, 11U * (kCells + 1));
  expect_whole();
}

TEST_F(RevertInRegion, NamedChartsGoBackWithTheirBorders) {
  (void)edit([](Patch& patch) {
    for (const auto v : patch.mesh().vertices()) patch.mesh().point(v)[2] += 0.5;
  });
  const RegionMesh lifted = whole(repository_->snapshot());
  std::set<std::uint32_t> of_chart;
  for (std::size_t f = 0; f < lifted.faces.size(); ++f)
    if (lifted.charts[lifted.chart_of_face[f]] == ChartId(2))
      of_chart.insert(lifted.faces[f].begin(), lifted.faces[f].end());
  EXPECT_EQ(revert("2", OfCharts{{ChartId(2)}}).vertices_moved, of_chart.size());
  EXPECT_THROW((void)revert("2", OfCharts{{ChartId(777)}}), Error);
  expect_whole();
}

TEST_F(RevertInRegion, AChartThatTheVersionRemovedCanBeNamed) {
  const auto id = repository_->snapshot().find({{NearestTo{{0, 0, 0}}}, 0}).front();
  const CommitReport cut = edit([&](Patch& patch) {
    auto& mesh = patch.mesh();
    for (const auto f : mesh.all_faces())
      if (mesh.property(patch.chart_property(), f) == id.value) mesh.delete_face(f, true);
  });
  ASSERT_EQ(cut.removed, std::vector<ChartId>{id});
  const CommitReport report = revert("2", OfCharts{{id}});
  EXPECT_EQ(report.faces_added, cut.faces_removed);
  EXPECT_TRUE(faces() == faces("1"));
  expect_whole();
}

TEST_F(RevertInRegion, AVertexWithoutFacesThatMayHaveMovedSinceIsAConflict) {
  (void)edit([](Patch& patch) {
    (void)patch.mesh().add_vertex({3, 3, 2});
    (void)patch.mesh().add_vertex({4, 3, 2});
  });
  (void)edit([](Patch& patch) {
    std::vector<Patch::Mesh::VertexHandle> loose;
    for (const auto v : patch.mesh().vertices())
      if (patch.mesh().is_isolated(v)) loose.push_back(v);
    ASSERT_EQ(loose.size(), 2U);
    patch.mesh().point(loose[0])[2] += 1;
    patch.mesh().delete_vertex(loose[1], false);
  });
  const CommitReport report = repository_->revert("v2", {}, message("back"));
  EXPECT_FALSE(report.conflicts.empty()) << "the one that moved would stay";
  ASSERT_FALSE(report.conflict_places.empty());
  EXPECT_EQ(report.conflict_places[0].what, "a vertex that one side moved was removed by the other");
}

TEST_F(RevertInRegion, LaterEditsOutsideAreNoConflict) {
  (void)edit([](Patch& patch) {
    for (const auto v : patch.mesh().vertices()) patch.mesh().point(v)[2] += 0.5;
  });
  (void)edit([](Patch& patch) {
    for (const auto v : patch.mesh().vertices())
      if (patch.mesh().point(v)[0] > 10.5) patch.mesh().point(v)[2] += 0.5;
  });
  EXPECT_FALSE(repository_->revert("2", {}, message("all")).conflicts.empty());
  EXPECT_EQ(revert("2", kLeft).vertices_moved, 11U * (kCells + 1));
  EXPECT_FALSE(revert("2", InBox{{10.8, 0, -9}, {12.2, 1, 9}}).conflicts.empty());
}

}  // namespace
}  // namespace ramcdb::test
