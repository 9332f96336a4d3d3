#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "api/disjoint_sets.h"
#include "ramcdb/edit_transaction.h"
#include "ramcdb/patch.h"
#include "tests/api/whole_surface.h"

/// Components and boundary loops, which no chart knows alone.
namespace ramcdb::test {
namespace {

using Counts = std::pair<std::uint64_t, std::uint64_t>;  ///< components, boundary loops

/// Counted on the whole mesh.
Counts plainly_counted(std::size_t vertices, const std::vector<Triangle>& faces) {
  detail::DisjointSets surface(vertices), border(vertices);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> passes;
  for (const Triangle& t : faces)
    for (std::size_t i = 0; i < 3; ++i) {
      surface.join(t[i], t[(i + 1) % 3]);
      ++passes[std::minmax(t[i], t[(i + 1) % 3])];
    }
  std::set<std::uint32_t> components, loops, on_border;
  for (const Triangle& t : faces) components.insert(surface.root(t[0]));
  for (const auto& [edge, count] : passes) {
    if (count != 1 || edge.first == edge.second) continue;
    border.join(edge.first, edge.second);
    on_border.insert(edge.first);
  }
  for (const std::uint32_t v : on_border) loops.insert(border.root(v));
  return {components.size(), loops.size()};
}

Counts said_by(const Repository& repository) {
  const MeshInfo info = repository.snapshot().info();
  return {info.components, info.boundary_loops};
}

Counts truth(const Repository& repository) {
  const RegionMesh mesh = whole(repository.snapshot());
  return plainly_counted(mesh.points.size(), mesh.faces);
}

std::map<const char*, TestMesh> families() {
  return {{"sphere", sphere(3000)},
          {"torus", torus(3000)},
          {"genus 3", genus3(3000)},
          {"terrain", terrain(30, 40)},
          {"scan", scan(4000)},
          {"boxes", boxes(60)},
          {"several components", several_components()},
          {"moebius", moebius()},
          {"two cubes", two_cubes_sharing_edge()},
          {"hourglass", hourglass()},
          {"three faces at an edge", three_faces_one_edge()},
          {"degenerate and duplicate", degenerate_and_duplicate_faces()},
          {"isolated vertices", isolated_vertices()}};
}

TEST(SurfaceCounts, AreThoseOfTheWholeMeshHoweverItIsCut) {
  for (const auto& [name, mesh] : families())
    for (const std::uint32_t chart_faces : {15U, 400U, 100000U}) {
      SCOPED_TRACE(std::string(name) + " by " + std::to_string(chart_faces));
      TempRepository repository(mesh, chart_faces);
      EXPECT_EQ(said_by(*repository), plainly_counted(mesh.positions.size(), mesh.faces));
      const MeshInfo& imported = repository.import_report().info;
      EXPECT_EQ(Counts(imported.components, imported.boundary_loops), said_by(*repository));
      EXPECT_TRUE(repository->verify({}).ok());
    }
}

TEST(SurfaceCounts, AreThoseOfRealMeshes) {
  const auto folder = meshes_folder();
  if (!folder) GTEST_SKIP() << "no real meshes here";
  int taken = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    if (!entry.is_regular_file() || entry.file_size() > 500'000) continue;
    const TempFolder scratch;
    Repository::create(scratch / "r.ramcdb");
    Repository repository = Repository::open(scratch / "r.ramcdb");
    ImportOptions options;
    options.chart_faces = 300;
    try {
      (void)repository.import(entry.path(), options);
    } catch (const Error&) {
      continue;  // not a mesh
    }
    SCOPED_TRACE(entry.path().string());
    EXPECT_EQ(said_by(repository), truth(repository));
    ++taken;
  }
  EXPECT_GT(taken, 0);
}

/// Takes faces out of the whole mesh.
template <class Wanted>
void remove_faces(TempRepository& repository, const Wanted& wanted) {
  EditTransaction edit = repository->begin_edit();
  Patch& patch = edit.checkout(kAll);
  Patch::Mesh& mesh = patch.mesh();
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  for (const auto f : mesh.faces()) {
    Patch::Mesh::Point center(0, 0, 0);
    for (const auto v : mesh.fv_range(f)) center += mesh.point(v) / 3;
    if (wanted(center)) mesh.delete_face(f, true);
  }
  mesh.garbage_collection();
  ASSERT_TRUE(edit.commit(message("less")).conflicts.empty());
}

TEST(SurfaceCounts, FollowEdits) {
  TempRepository repository(sphere(4000), 300);
  EXPECT_EQ(said_by(*repository), Counts(1, 0));
  remove_faces(repository, [](const auto& p) { return p[2] > 0.95; });
  EXPECT_EQ(said_by(*repository), Counts(1, 1));
  remove_faces(repository, [](const auto& p) { return std::abs(p[0]) < 0.1; });
  EXPECT_EQ(said_by(*repository), truth(*repository));
  EXPECT_EQ(said_by(*repository), Counts(2, 2));
  EXPECT_EQ(repository->snapshot({}, "1").info().components, 1);
  EXPECT_TRUE(repository->verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
