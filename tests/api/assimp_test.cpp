#include <cstdlib>
#include <fstream>

#include "tests/api/temp_repository.h"

// Checked-out files that go through a real program, assimp's command line, from format to format and back. It splits
// vertices, adds normals and materials, reorders, and drops ids; skipped where it is not installed.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;
using mesh_file::MeshData;

/// Formats on the way: what assimp calls them, and the file's extension.
struct Hop {
  const char *format, *extension;
};
using Way = std::vector<Hop>;

constexpr Hop kObj{"obj", ".obj"}, kPly{"ply", ".ply"}, kBinaryPly{"plyb", ".ply"}, kStl{"stl", ".stl"},
    kBinaryStl{"stlb", ".stl"}, kGlb{"glb2", ".glb"};

const std::vector<Way>& ways() {
  static const std::vector<Way> all{{kObj, kPly},
                                    {kObj, kBinaryPly},
                                    {kBinaryStl, kPly},
                                    {kStl, kBinaryPly},
                                    {kGlb, kPly},
                                    {kObj, kGlb, kBinaryStl, kPly},
                                    {kObj},
                                    {kBinaryStl},
                                    {kGlb}};
  return all;
}

std::string name_of(const Way& way) {
  std::string name = "ply";
  for (const Hop& hop : way) name += std::string("-") + hop.format;
  return name;
}

bool assimp_is_there() { return std::system("assimp version >/dev/null 2>&1") == 0; }

class Assimp : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!assimp_is_there()) GTEST_SKIP() << "assimp-utils is not installed";
  }

  /// Checks charts out and sends them on their way; `edit` is called with the first file that assimp wrote.
  template <class Edit>
  void send(TempRepository& repository, const std::vector<ChartId>& charts, const Way& way, Edit&& edit) {
    const std::string name = name_of(way) + std::to_string(++sent_);
    const fs::path out = repository / (name + ".ply");
    (void)repository->checkout_file(repository->snapshot(), charts, out, {});
    fs::path file = out;
    for (std::size_t i = 0; i < way.size(); ++i) {
      const fs::path next = repository / (name + "-" + std::to_string(i) + way[i].extension);
      const std::string command = "assimp export '" + file.string() + "' '" + next.string() + "' -f" + way[i].format +
                                  " >'" + (repository / "assimp.log").string() + "' 2>&1";
      ASSERT_EQ(std::system(command.c_str()), 0) << command;
      file = next;
      if (i == 0) edit(file);
    }
    fs::rename(out.string() + ".ramcdb.json", file.string() + ".ramcdb.json");
    file_ = file;
  }

  fs::path file_;  ///< as it came back

 private:
  unsigned sent_ = 0;
};

/// Of the region, a vertex of no other chart and a face with no vertex of another.
std::uint32_t vertex_inside(const RegionMesh& region) {
  std::uint32_t v = 0;
  while (region.keys[v].where != VertexKey::Where::chart) ++v;
  return v;
}
Triangle face_inside(const RegionMesh& region) {
  return *std::ranges::find_if(region.faces, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return region.keys[v].where == VertexKey::Where::chart; });
  });
}

TEST_F(Assimp, ChangesNothing) {
  TempRepository repository(scan(8000), 400);
  for (const Way& way : ways()) {
    SCOPED_TRACE(name_of(way));
    send(repository, {ChartId(3), ChartId(4), ChartId(9)}, way, [](const fs::path&) {});
    EXPECT_TRUE(repository->status_file(file_).clean());
    EXPECT_TRUE(repository->commit_file(file_, message("same")).nothing_changed);
  }
  EXPECT_EQ(repository->resolve("HEAD"), VersionId(1));
}

TEST_F(Assimp, BringsAMoveBack) {
  TempRepository repository(scan(8000), 400);
  for (const Way& way : ways()) {
    SCOPED_TRACE(name_of(way));
    const Snapshot before = repository->snapshot();
    const RegionMesh region = before.read({ChartId(3), ChartId(4)});
    const LatticePoint from = region.points[vertex_inside(region)];
    LatticePoint to = from;
    to.z += 40;
    send(repository, region.charts, way, [&](const fs::path& file) {
      MeshData mesh = mesh_file::read_mesh(file);
      for (Point& p : mesh.positions)
        if (before.lattice().snap(p) == from) p = before.position(to);
      write_data(mesh, file, mesh_file::Scalar::float32);
    });
    const CommitReport report = repository->commit_file(file_, message("moved"));
    EXPECT_EQ(report.vertices_moved, 1U);
    EXPECT_EQ(report.faces_added + report.faces_removed, 0U);
    RegionMesh expected = whole(before);
    std::ranges::replace(expected.points, from, to);
    EXPECT_TRUE(face_set(whole(repository->snapshot())) == face_set(expected));
  }
  EXPECT_TRUE(repository->verify({}).ok());
}

TEST_F(Assimp, BringsAHoleBack) {
  TempRepository repository(scan(8000), 400);
  for (const Way& way : ways()) {
    SCOPED_TRACE(name_of(way));
    const Snapshot before = repository->snapshot();
    const RegionMesh region = before.read({ChartId(3), ChartId(4)});
    const FaceSet gone = face_set(region.points, {face_inside(region)});
    send(repository, region.charts, way, [&](const fs::path& file) {
      MeshData mesh = mesh_file::read_mesh(file);
      const std::vector<LatticePoint> points = snapped(before.lattice(), mesh.positions);
      for (std::size_t c = 0; c + 2 < mesh.corners.size(); c += 3) {
        const Triangle t{mesh.corners[c], mesh.corners[c + 1], mesh.corners[c + 2]};
        if (face_set(points, {t}) != gone) continue;
        const auto first = mesh.corners.begin() + static_cast<std::ptrdiff_t>(c);
        mesh.corners.erase(first, first + 3);
        break;
      }
      mesh.attributes.clear();
      write_data(mesh, file, mesh_file::Scalar::float32);
    });
    const CommitReport report = repository->commit_file(file_, message("a hole"));
    EXPECT_EQ(report.faces_removed, 1U);
    EXPECT_EQ(report.faces_added + report.vertices_moved + report.vertices_added + report.vertices_removed, 0U);
    FaceSet expected = face_set(whole(before));
    expected.erase(std::ranges::find(expected, gone.front()));
    EXPECT_TRUE(face_set(whole(repository->snapshot())) == expected);
  }
  EXPECT_TRUE(repository->verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
