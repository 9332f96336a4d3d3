#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

#include "tests/api/blobs_of.h"
#include "tests/api/face_records.h"
#include "tests/api/temp_repository.h"

/// The promises of import and export on meshes that people made: files of $RAMCDB_MESHES or ../shared/meshes, as far as
/// they are of a size that a test can take.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

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
      if (is_mesh && entry.file_size() <= largest_real_file()) files.push_back(entry.path());
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

/// Positions as numbers whose bits can be compared: as float32 where all of the file are, for text says of those only
/// what tells them apart.
std::vector<std::vector<double>> exact_records(const mesh_file::MeshData& mesh, bool floats,
                                               const std::vector<MeshInfo::Layer>& layers) {
  const auto number = [&](double x) {
    const double kept = floats ? static_cast<double>(static_cast<float>(x)) : x;
    return kept == 0 && std::signbit(kept) ? std::numeric_limits<double>::denorm_min() : kept;
  };
  return face_records(
      mesh,
      [&](const Point& p) {
        return Point{number(p.x), number(p.y), number(p.z)};
      },
      layers);
}

bool all_floats(const mesh_file::MeshData& mesh) {
  return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const Point& p) {
    const auto is_float = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
    return is_float(p.x) && is_float(p.y) && is_float(p.z);
  });
}

void expect_every_bit(const fs::path& file) {
  const TempFolder folder;
  Repository::create(folder / "r");
  Repository repository = Repository::open(folder / "r");
  ImportOptions options;
  options.name = "mesh";
  options.lossless = true;
  options.threads = 2;
  (void)repository.import(file, options);
  const Snapshot snapshot = repository.snapshot("mesh");
  // What nodes of glTF turn is no float32 any more; PLY, where it goes then, has no names of materials.
  const bool gltf = mesh_file::is_gltf(mesh_file::format_of(file));
  const bool soup = mesh_file::format_of(file) == mesh_file::Format::stl;
  const fs::path out = folder / ("out" + (soup || gltf ? ".ply" : file.extension().string()));
  (void)repository.export_mesh(snapshot, out, {});
  const mesh_file::MeshData before = mesh_file::read_mesh(file), after = mesh_file::read_mesh(out);
  const auto layers = gltf ? std::vector<MeshInfo::Layer>{} : snapshot.info().attributes;
  EXPECT_TRUE(exact_records(before, all_floats(before), layers) == exact_records(after, all_floats(before), layers))
      << "some bit differs";
  EXPECT_TRUE(repository.verify({}).ok());
}

/// A vertex of each kind that is there: at a non-manifold edge, at a border, at a seam of values, and inside. None that
/// shares its lattice point, which a triangle soup could not tell apart.
std::map<std::string, std::uint32_t> vertices_to_move(const RegionMesh& region) {
  std::map<LatticePoint, int> at;
  for (const LatticePoint p : region.points) ++at[p];
  std::map<std::string, std::uint32_t> found;
  const auto add = [&](const char* kind, std::uint32_t v) {
    if (at[region.points[v]] == 1) found.try_emplace(kind, v);
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : region.faces)
    for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax(t[i], t[(i + 1) % 3])];
  for (const auto& [edge, faces] : edges)
    add(faces == 1 ? "border" : faces == 2 ? "inside" : "non-manifold edge", edge.first);
  for (const Attribute& attribute : region.attributes) {
    if (attribute.info.of != AttributeOf::corner) continue;
    std::map<std::uint32_t, double> value;
    for (std::size_t c = 0; c < attribute.count(); ++c) {
      const double number = attribute.values[c * attribute.info.components];
      const auto it = value.emplace(region.faces[c / 3][c % 3], number).first;
      if (it->second != number) add("seam", it->first);
    }
  }
  return found;
}

/// A chart with the vertex, and a neighbour where there is one.
std::vector<ChartId> charts_with(const RegionMesh& region, const Snapshot& snapshot, std::uint32_t vertex) {
  for (std::size_t f = 0; f < region.faces.size(); ++f)
    for (const std::uint32_t v : region.faces[f])
      if (v == vertex) return snapshot.find({{OfCharts{{region.charts[region.chart_of_face[f]]}}}, 1});
  return region.charts;
}

/// Moves a vertex in a checked-out file of the mesh's own format, as a program would that knows no more than the file.
void expect_the_edit(Repository& repository, const fs::path& out, std::uint32_t vertex) {
  const Snapshot before = repository.snapshot();
  const RegionMesh was = whole(before);
  const std::vector<ChartId> charts = charts_with(was, before, vertex);
  const RegionMesh region = before.read_with_attributes(charts);
  const auto in_region = std::find(region.keys.begin(), region.keys.end(), was.keys[vertex]) - region.keys.begin();
  const Point origin = repository.checkout_file(before, charts, out, {}).local_origin;

  mesh_file::MeshData data = mesh_file::read_mesh(out);
  LatticePoint to = was.points[vertex];
  to.z += 300;
  Point target = before.position(to);
  for (int a = 0; a < 3; ++a) target[a] -= origin[a];
  const auto stands_at = [&](const Point& p) {
    return before.lattice().snap({p.x + origin.x, p.y + origin.y, p.z + origin.z}) == was.points[vertex];
  };
  if (data.soup) {
    for (Point& p : data.positions)
      if (stands_at(p)) p = target;
  } else {
    ASSERT_EQ(data.positions.size(), region.points.size());
    ASSERT_TRUE(stands_at(data.positions[static_cast<std::size_t>(in_region)]));
    data.positions[static_cast<std::size_t>(in_region)] = target;
  }
  const bool is_gltf = mesh_file::is_gltf(mesh_file::format_of(out));
  write_data(data, out, is_gltf ? mesh_file::Scalar::float32 : mesh_file::Scalar::float64);

  const CommitReport report = repository.commit_file(out, message("one vertex"));
  EXPECT_EQ(report.values_changed, 0U);
  const Snapshot after = repository.snapshot();
  const RegionMesh is = whole(after);
  std::multiset<LatticePoint> found(is.points.begin(), is.points.end());
  std::multiset<LatticePoint> expected;
  for (std::size_t v = 0; v < was.points.size(); ++v) expected.insert(v == vertex ? to : was.points[v]);
  if (!data.soup) {
    EXPECT_EQ(report.vertices_moved, 1U);
    EXPECT_TRUE(found == expected) << "other vertices moved";
  }
  EXPECT_TRUE(found.contains(to));
}

/// Calls `check` with every real mesh; those that must be refused, and no others, throw.
template <class Check>
void for_each_mesh(const char* done, Check&& check) {
  const std::vector<fs::path> files = mesh_files();
  if (files.empty()) GTEST_SKIP() << "no folder of real meshes: set RAMCDB_MESHES";
  std::size_t taken = 0;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    try {
      check(file);
      EXPECT_FALSE(must_be_refused(file));
      ++taken;
    } catch (const Error& e) {
      EXPECT_TRUE(must_be_refused(file)) << e.what();
      std::printf("refused: %s\n", e.what());
    }
  }
  std::printf("%zu of %zu meshes of up to %ju bytes %s\n", taken, files.size(), largest_real_file(), done);
  EXPECT_GT(taken, 0U);
}

TEST(RealMeshes, GoInAndComeOut) { for_each_mesh("went in and came out", expect_the_round_trip); }

TEST(RealMeshes, ComeOutBitByBit) { for_each_mesh("came out bit by bit", expect_every_bit); }

TEST(RealMeshes, AreEditedWhereverTheyAreUgly) {
  std::map<std::string, int> edits;
  for_each_mesh("were edited", [&](const fs::path& file) {
    const TempFolder folder;
    Repository::create(folder / "r");
    Repository repository = Repository::open(folder / "r");
    ImportOptions options;
    options.name = "mesh";
    options.chart_faces = 1000;
    options.threads = 2;
    (void)repository.import(file, options);
    for (const auto& [kind, vertex] : vertices_to_move(whole(repository.snapshot()))) {
      SCOPED_TRACE(kind);
      expect_the_edit(repository, folder / (kind + file.extension().string()), vertex);
      ++edits[kind];
    }
    EXPECT_TRUE(repository.verify({}).ok());
  });
  for (const auto& [kind, count] : edits) std::printf("%s: a vertex moved in %d meshes\n", kind.c_str(), count);
}

}  // namespace
}  // namespace ramcdb::test
