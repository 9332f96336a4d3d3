#include <cstdio>
#include <map>

#include "tests/api/blobs_of.h"
#include "tests/api/face_records.h"
#include "tests/api/temp_repository.h"

/// The promises of import and export on meshes that people made: files of $RAMCDB_MESHES or ../shared/meshes, as far as
/// they are of a size that a test can take.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 6 << 20;

/// What is no triangle mesh of a format that is read, and has to be refused.
bool must_be_refused(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "toomanyvertices.stl";
}

std::vector<fs::path> mesh_files() {
  std::vector<fs::path> files;
  if (const auto folder = meshes_folder())
    for (const auto& entry : fs::recursive_directory_iterator(*folder)) {
      std::string kind = entry.path().extension().string();
      std::transform(kind.begin(), kind.end(), kind.begin(), [](char c) { return static_cast<char>(c | 0x20); });
      const bool is_mesh = kind == ".ply" || kind == ".obj" || kind == ".off" || kind == ".stl" || kind == ".glb";
      if (is_mesh && entry.file_size() <= kLargestFile) files.push_back(entry.path());
    }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_shared_vertices_agree(const Snapshot& snapshot) {
  std::map<VertexKey, LatticePoint> seen;
  for (const ChartId id : snapshot.find({{WholeMesh{}}, 0})) {
    const RegionMesh alone = snapshot.read({id});
    for (std::size_t v = 0; v < alone.keys.size(); ++v)
      if (alone.keys[v].where != VertexKey::Where::chart) {
        ASSERT_EQ(seen.emplace(alone.keys[v], alone.points[v]).first->second, alone.points[v]);
      }
  }
}

/// Polygons, attributes and references of the export are those of the import. (A soup is welded on the way.)
void expect_the_same_file(const Snapshot& snapshot, const mesh_file::MeshData& before,
                          const mesh_file::MeshData& after) {
  const MeshInfo info = snapshot.info();
  EXPECT_EQ(info.attributes.size(), before.attributes.size());
  EXPECT_EQ(after.attributes.size(), before.attributes.size());
  EXPECT_EQ(after.references, before.references);
  EXPECT_EQ(after.face_count(), before.face_count());
  if (!before.soup) {
    EXPECT_EQ(after.positions.size(), before.positions.size());
  }
  EXPECT_TRUE(face_records(before, snapshot.lattice(), info.attributes) ==
              face_records(after, snapshot.lattice(), info.attributes))
      << "faces or attributes differ";
}

void expect_the_round_trip(const fs::path& file) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  ImportOptions options;
  options.name = "mesh";
  options.threads = 2;
  const ImportReport report = repository.import(file, options);
  EXPECT_LE(report.measured_error, report.info.max_error * (1 + 1e-9));
  const Snapshot snapshot = repository.snapshot("mesh");
  EXPECT_TRUE(face_set_of_file(snapshot.lattice(), file) == face_set(whole(snapshot))) << "import";
  // STL would join vertices that share a lattice point.
  const bool soup = mesh_file::format_of(file) == mesh_file::Format::stl;
  const fs::path out = folder / ("out" + (soup ? ".ply" : file.extension().string()));
  EXPECT_TRUE(repository.export_mesh(snapshot, out, {}).left_out.empty());
  expect_the_same_file(snapshot, mesh_file::read_mesh(file), mesh_file::read_mesh(out));
  expect_shared_vertices_agree(snapshot);
  options.name = "again";
  options.lattice = snapshot.lattice();
  (void)repository.import(out, options);
  EXPECT_TRUE(blobs_of(repository, "mesh") == blobs_of(repository, "again")) << "blobs of a second import differ";
  EXPECT_TRUE(repository.verify({}).ok());
}

TEST(RealMeshes, GoInAndComeOut) {
  const std::vector<fs::path> files = mesh_files();
  if (files.empty()) GTEST_SKIP() << "no folder of real meshes: set RAMCDB_MESHES";
  std::size_t taken = 0;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    try {
      expect_the_round_trip(file);
      EXPECT_FALSE(must_be_refused(file));
      ++taken;
    } catch (const Error& e) {
      EXPECT_TRUE(must_be_refused(file)) << e.what();
      std::printf("refused: %s\n", e.what());
    }
  }
  std::printf("%zu of %zu meshes of up to %ju bytes went in and came out\n", taken, files.size(), kLargestFile);
  EXPECT_GT(taken, 0U);
}

}  // namespace
}  // namespace ramcdb::test
