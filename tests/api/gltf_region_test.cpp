#include <gmock/gmock.h>

#include "tests/api/temp_repository.h"

/// Regions as glTF, where 32-bit floats are enough, where they are with a translation, and where they are not.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

TestMesh far_away(double distance) {
  TestMesh mesh = terrain(30, 30);
  for (Point& p : mesh.positions) p = {p.x + distance, p.y - 3 * distance, p.z};
  return mesh;
}

CommitOptions message() {
  CommitOptions options;
  options.message = "moved";
  return options;
}

void check_out(TempRepository& repository, const fs::path& file) {
  const Snapshot snapshot = repository->snapshot();
  (void)repository->checkout_file(snapshot, snapshot.find({{WholeMesh{}}, 0}), file, {});
}

/// Moves a vertex in the file, keeping all else that the file says.
void move_vertex(const fs::path& file, std::size_t vertex, double by) {
  const auto mesh = mesh_file::read_mesh(file);
  auto positions = mesh.positions;
  positions[vertex].z += by;
  mesh_file::MeshOutput out;
  out.positions = positions;
  out.corners = mesh.corners;
  out.vertex_ids = mesh.vertex_ids;
  out.scalar = mesh_file::Scalar::float64;
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

TEST(GltfRegions, FarFromTheOriginTheFileSaysWhereFloatsBegin) {
  for (const double distance : {0.0, 1e7, 3e9})
    for (const char* name : {"a.glb", "a.gltf"}) {
      TempRepository repository(far_away(distance));
      const fs::path file = repository / name;
      check_out(repository, file);
      const auto written = mesh_file::read_mesh(file);
      EXPECT_EQ(written.vertex_ids.size(), written.positions.size());
      EXPECT_TRUE(repository->status_file(file).clean()) << distance << ' ' << name;
      const Lattice lattice = repository->snapshot().lattice();
      for (const Point& p : written.positions)
        for (int a = 0; a < 3; ++a)
          ASSERT_NEAR(p[a], lattice.position(lattice.snap(p))[a], 0.01 * lattice.step) << distance;
    }
}

TEST(GltfRegions, AMovedVertexIsCommitted) {
  TempRepository repository(far_away(0));
  const fs::path file = repository / "a.glb";
  check_out(repository, file);
  const double step = repository->snapshot().lattice().step;
  move_vertex(file, 17, 1024 * step);
  const CommitReport report = repository->commit_file(file, message());
  EXPECT_EQ(report.vertices_moved, 1U);
  EXPECT_TRUE(repository->status_file(file).clean());
}

TEST(GltfRegions, LatticesTooFineForFloatsAreRefused) {
  TempRepository repository(far_away(0), 500, 28);
  const fs::path file = repository / "a.glb";
  try {
    check_out(repository, file);
    ADD_FAILURE() << "written";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("glTF holds 32-bit floats, too coarse"));
    EXPECT_THAT(error.what(), testing::HasSubstr("write .ply, .obj or .off"));
  }
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace
}  // namespace ramcdb::test
