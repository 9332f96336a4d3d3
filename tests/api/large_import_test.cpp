#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <string>

#include "tests/api/blobs_of.h"
#include "tests/api/painted_grid.h"
#include "tests/api/temp_repository.h"
#include "tests/db/child_process.h"

namespace ramcdb::test {
namespace {

constexpr std::uint64_t kLittle = 1 << 16;   ///< bytes: blocks are then as small as charts allow
constexpr std::uint64_t kSeveral = 5 << 20;  ///< bytes: two good blocks at a time, of charts of 50 faces

/// A repository to import into.
class Imports {
 public:
  Imports() { Repository::create(folder_ / "r.ramcdb"); }

  [[nodiscard]] Repository repository() const { return Repository::open(folder_ / "r.ramcdb"); }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  ImportReport import(const std::string& file, const std::string& name, std::optional<std::uint64_t> memory,
                      const std::function<void(ImportOptions&)>& change = {}) const {
    ImportOptions options;
    options.name = name;
    options.chart_faces = 50;
    options.bits = 14;
    options.memory = memory;
    options.threads = 2;
    if (change) change(options);
    return repository().import(folder_ / file, options);
  }
  ImportReport import(const TestMesh& mesh, const std::string& name, std::optional<std::uint64_t> memory,
                      const std::function<void(ImportOptions&)>& change = {}) const {
    write_test_mesh(mesh, folder_ / "input.ply");
    return import("input.ply", name, memory, change);
  }

  [[nodiscard]] std::vector<std::string> problems() const {
    std::vector<std::string> problems;
    for (const auto& problem : repository().verify({}).problems)
      problems.push_back(problem.kind + " " + problem.object + ": " + problem.text);
    return problems;
  }
  /// What lies in the repository's folder.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "r.ramcdb"))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  TempFolder folder_;
};

struct LargeMesh {
  const char* name;
  TestMesh mesh;
};

/// Every second vertex of a soup is named by other faces, too: no order in them at all.
TestMesh tangle() {
  TestMesh mesh = sphere(1500);
  std::uint32_t x = 1;
  for (std::size_t f = 0; f < mesh.faces.size(); f += 3)
    for (std::uint32_t& v : mesh.faces[f])
      v = (x = x * 1664525 + 1013904223) % static_cast<std::uint32_t>(mesh.positions.size());
  return mesh;
}

TestMesh only_vertices() {
  TestMesh mesh = sphere(3000);
  mesh.faces.clear();
  return mesh;
}

/// One face of ten gone, one of ten turned over.
TestMesh torn() {
  TestMesh mesh = torus(4000), out{mesh.positions, {}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (f % 10 == 3) continue;
    if (f % 10 == 7) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    out.faces.push_back(mesh.faces[f]);
  }
  return out;
}

/// Sheets that meet along lines of edges, three and four at a time, and in single vertices.
TestMesh sheets() {
  constexpr std::uint32_t kSide = 40;
  TestMesh mesh;
  const auto add = [&](const std::function<Point(double, double)>& place) {
    std::vector<std::uint32_t> vertex;
    for (std::uint32_t y = 0; y <= kSide; ++y)
      for (std::uint32_t x = 0; x <= kSide; ++x) {
        const Point p = place(x, y);
        const auto found = std::find(mesh.positions.begin(), mesh.positions.end(), p);
        vertex.push_back(static_cast<std::uint32_t>(found - mesh.positions.begin()));
        if (found == mesh.positions.end()) mesh.positions.push_back(p);
      }
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
        mesh.faces.push_back({vertex[a], vertex[a + 1], vertex[b + 1]});
        mesh.faces.push_back({vertex[a], vertex[b + 1], vertex[b]});
      }
  };
  add([](double x, double y) { return Point{x, y, 0}; });
  add([](double x, double y) { return Point{x, 20, y}; });
  add([](double x, double y) { return Point{x, 20 + y, y}; });
  add([](double x, double y) { return Point{20, x, 7 + y}; });
  return mesh;
}

std::vector<LargeMesh> large_meshes() {
  return {{"sphere", sphere(6000)},
          {"genus3", genus3(6000)},
          {"terrain", terrain(60, 50)},
          {"components", several_components()},
          {"boxes", boxes(300)},
          {"scan", scan(6000)},
          {"moebius", moebius()},
          {"two cubes on an edge", two_cubes_sharing_edge()},
          {"hourglass", hourglass()},
          {"three faces on an edge", three_faces_one_edge()},
          {"degenerate and duplicate", degenerate_and_duplicate_faces()},
          {"isolated vertices", isolated_vertices()},
          {"only vertices", only_vertices()},
          {"torn", torn()},
          {"sheets", sheets()},
          {"tangle", tangle()}};
}

void expect_same_mesh(const Snapshot& snapshot, const TestMesh& mesh) {
  const auto expected = snapped(snapshot.lattice(), mesh.positions);
  const RegionMesh got = whole(snapshot);
  EXPECT_EQ(face_set(got), face_set(expected, mesh.faces));
  const auto sorted = [](std::vector<LatticePoint> points) {
    std::sort(points.begin(), points.end());
    return points;
  };
  EXPECT_EQ(sorted(got.points), sorted(expected)) << "no vertex is lost or doubled";
}

void expect_same_counts(const MeshInfo& a, const MeshInfo& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.polygons, b.polygons);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.boundary_loops, b.boundary_loops);
  EXPECT_EQ(a.isolated_vertices, b.isolated_vertices);
  EXPECT_EQ(a.degenerate_faces, b.degenerate_faces);
  EXPECT_EQ(a.duplicate_faces, b.duplicate_faces);
  EXPECT_EQ(a.nonmanifold_edges, b.nonmanifold_edges);
  EXPECT_EQ(a.nonmanifold_vertices, b.nonmanifold_vertices);
  EXPECT_EQ(a.inconsistent_edges, b.inconsistent_edges);
}

TEST(LargeImport, InManyBlocksGivesTheSameMeshAndCounts) {
  for (const LargeMesh& family : large_meshes()) {
    SCOPED_TRACE(family.name);
    const Imports imports;
    const MeshInfo in_core = imports.import(family.mesh, "in core", {}).info;
    const MeshInfo large = imports.import(family.mesh, "large", kLittle).info;
    expect_same_mesh(imports.repository().snapshot("large"), family.mesh);
    EXPECT_THAT(imports.problems(), testing::IsEmpty());
    expect_same_counts(large, in_core);
  }
}

TEST(LargeImport, IsTheSameForAnyOrderOfTheFileAndAnyNumberOfThreads) {
  for (const auto& [memory, faces] : {std::pair(kLittle, 8000), std::pair(kSeveral, 30'000)}) {
    SCOPED_TRACE(memory);
    const Imports imports;
    const TestMesh mesh = scan(static_cast<std::size_t>(faces));
    (void)imports.import(mesh, "as it is", memory);
    (void)imports.import(shuffled(mesh, 7), "shuffled", memory);
    (void)imports.import(mesh, "on one thread", memory, [](ImportOptions& options) { options.threads = 1; });
    (void)imports.import(mesh, "on eight", memory, [](ImportOptions& options) { options.threads = 8; });
    const auto expected = blobs_of(imports.repository(), "as it is");
    EXPECT_EQ(blobs_of(imports.repository(), "on one thread"), expected);
    EXPECT_EQ(blobs_of(imports.repository(), "on eight"), expected);
    EXPECT_EQ(blobs_of(imports.repository(), "shuffled"), expected);
    expect_same_mesh(imports.repository().snapshot("shuffled"), mesh);
    EXPECT_THAT(imports.problems(), testing::IsEmpty());
  }
}

TEST(LargeImport, CutsChartsAboutAsWellAsInCore) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "sanitizers look at smaller meshes; how well these are cut, the released build tells";
#endif
  const TestMesh mesh = scan(150'000);
  const auto wires = [](const MeshInfo& info) {
    return static_cast<double>(info.bytes.wires) / static_cast<double>(info.bytes.payload);
  };
  // One block of charts of 500 faces at a time, two of charts of 200.
  for (const auto& [chart_faces, memory] : {std::pair(500U, 6 << 20), std::pair(200U, 18 << 20)}) {
    SCOPED_TRACE(chart_faces);
    const Imports imports;
    const auto options = [of = chart_faces](ImportOptions& o) { o.chart_faces = of; };
    const MeshInfo in_core = imports.import(mesh, "in core", {}, options).info;
    const MeshInfo large = imports.import(mesh, "large", memory, options).info;
    EXPECT_NE(large.wires, in_core.wires) << "it was cut in several blocks";
    EXPECT_LT(wires(large), 1.1 * wires(in_core));
    EXPECT_LT(large.chart_faces.p95, 1.1 * in_core.chart_faces.p95);
    EXPECT_LT(static_cast<double>(large.charts), 1.1 * static_cast<double>(in_core.charts));
  }
}

TEST(LargeImport, TakesEveryFormatThatIsReadInPieces) {
  const Imports imports;
  const TestMesh mesh = torus(3000);
  for (const char* file : {"a.ply", "a.obj", "a.stl"}) {
    SCOPED_TRACE(file);
    write_test_mesh(mesh, imports / file);
    const MeshInfo in_core = imports.import(file, std::string("in core ") + file, {}).info;
    const ImportReport large = imports.import(file, std::string("large ") + file, kLittle);
    EXPECT_EQ(large.info.vertices, mesh.positions.size()) << "a soup is welded";
    EXPECT_EQ(large.vertices_welded, file == std::string("a.stl") ? 3 * mesh.faces.size() - mesh.positions.size() : 0);
    EXPECT_EQ(large.info.lattice, in_core.lattice);
    EXPECT_EQ(large.measured_error, imports.import(file, std::string("again ") + file, {}).measured_error);
    expect_same_mesh(imports.repository().snapshot(std::string("large ") + file), {mesh.positions, mesh.faces});
  }
  EXPECT_THAT(imports.problems(), testing::IsEmpty());
}

/// Per vertex its place and its values.
std::vector<std::vector<double>> painted_vertices(const Snapshot& snapshot) {
  const RegionMesh mesh = snapshot.read_with_attributes(snapshot.find({{WholeMesh{}}, 0}));
  std::vector<std::vector<double>> vertices;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const LatticePoint p = mesh.points[v];
    vertices.push_back({double(p.x), double(p.y), double(p.z)});
    for (const Attribute& attribute : mesh.attributes)
      for (std::size_t k = 0; k < attribute.info.components; ++k)
        vertices.back().push_back(attribute.values[v * attribute.info.components + k]);
  }
  std::ranges::sort(vertices);
  return vertices;
}

mesh_file::MeshData painted_scan(std::size_t faces) {
  const TestMesh mesh = scan(faces);
  mesh_file::MeshData data;
  data.positions = mesh.positions;
  for (const Triangle& t : mesh.faces) data.corners.insert(data.corners.end(), t.begin(), t.end());
  Attribute color{{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}};
  Attribute normal{{"normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal, {}, {}}, {}};
  Attribute quality{{"quality", AttributeOf::vertex, NumberType::float64, 1, Meaning::other, {}, {}}, {}};
  for (std::size_t v = 0; v < data.positions.size(); ++v) {
    const double number = static_cast<double>(v);
    color.values.insert(color.values.end(), {double(v % 256), double(v / 256 % 256), double(v / 65536)});
    normal.values.insert(normal.values.end(), {double{0.6F}, 0.0, v % 2 ? double{0.8F} : -double{0.8F}});
    quality.values.push_back(number / 3);
  }
  data.attributes = {color, normal, quality};
  return data;
}

TEST(LargeImport, KeepsAttributesOfVertices) {
  for (const char* file : {"painted.ply", "welded.ply"}) {
    const Imports imports;
    mesh_file::MeshData data = painted_scan(3000);
    const bool weld = std::string_view(file) == "welded.ply";
    if (weld)  // a vertex twice with other values: those of the first stay
      for (const std::uint32_t v : {5U, 70U}) {
        data.corners[data.corners.size() - v] = static_cast<std::uint32_t>(data.positions.size());
        data.positions.push_back(data.positions[data.corners[v]]);
        for (Attribute& attribute : data.attributes)
          for (std::size_t k = 0; k < attribute.info.components; ++k) attribute.values.push_back(double(k));
      }
    write_data(data, imports / file);
    for (const auto& [name, memory] : {std::pair("large", std::optional(kLittle)), {"core", std::nullopt}}) {
      const ImportReport report =
          imports.import(file, name, memory, [&](ImportOptions& options) { options.weld = weld; });
      ASSERT_EQ(report.info.attributes.size(), 3U);
      EXPECT_EQ(report.info.attributes[2].info, data.attributes[2].info);
    }
    EXPECT_EQ(painted_vertices(imports.repository().snapshot("large")),
              painted_vertices(imports.repository().snapshot("core")));
    EXPECT_THAT(imports.problems(), testing::IsEmpty());
  }
}

/// A grid of polygons with attributes of every kind, and places that are not manifold: a quad twice, a quad that stands
/// on an edge, and a triangle on the diagonal of another.
mesh_file::MeshData ugly_polygons() {
  mesh_file::MeshData mesh = painted_grid(40);
  const auto add = [&](std::initializer_list<std::uint32_t> face) {
    mesh.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
    for (Attribute& attribute : mesh.attributes)
      for (std::size_t k = 0; k < attribute.info.components; ++k) {
        if (attribute.info.of == AttributeOf::face) attribute.values.push_back(3);
        for (std::size_t c = 0; attribute.info.of == AttributeOf::corner && c < face.size(); ++c)
          attribute.values.push_back(0.5);
      }
  };
  const auto vertex = [&](double x, double y, double z) {
    mesh.positions.push_back({x, y, z});
    for (Attribute& attribute : mesh.attributes)
      for (std::size_t k = 0; attribute.info.of == AttributeOf::vertex && k < attribute.info.components; ++k)
        attribute.values.push_back(k == 2 ? 1 : 0);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  };
  std::size_t first = 0;
  for (std::size_t f = 0; f < 900; first += mesh.face_sizes[f++]) {
    if (mesh.face_sizes[f] != 4 || f % 40 != 7) continue;
    const std::array<std::uint32_t, 4> quad{mesh.corners[first], mesh.corners[first + 1], mesh.corners[first + 2],
                                            mesh.corners[first + 3]};
    const Point p = mesh.positions[quad[0]], q = mesh.positions[quad[2]];
    if (f % 80 == 7) add({quad[1], quad[2], quad[3], quad[0]});
    add({quad[0], quad[1], vertex(q.x, p.y, 5), vertex(p.x, p.y, 5)});
    add({quad[0], quad[2], vertex(p.x, q.y, 4)});
  }
  (void)vertex(3, 3, 9);
  return mesh;
}

TEST(LargeImport, KeepsPolygonsAndAttributesOfAllKinds) {
  const mesh_file::MeshData mesh = ugly_polygons();
  for (const std::uint64_t memory : {kLittle, kSeveral}) {
    const Imports imports;
    write_data(mesh, imports / "in.ply");
    std::vector<MeshInfo> infos;
    for (const auto& [name, bytes] : {std::pair("large", std::optional(memory)), {"core", std::nullopt}}) {
      infos.push_back(imports.import("in.ply", name, bytes).info);
      const Snapshot snapshot = imports.repository().snapshot(name);
      (void)imports.repository().export_mesh(snapshot, imports / "out.ply", {});
      const mesh_file::MeshData out = mesh_file::read_mesh(imports / "out.ply");
      EXPECT_EQ(out.positions.size(), mesh.positions.size());
      EXPECT_TRUE(records(snapshot, out) == records(snapshot, mesh)) << name;
    }
    expect_same_counts(infos[0], infos[1]);
    EXPECT_GT(infos[0].nonmanifold_edges, 20U);
    EXPECT_GT(infos[0].duplicate_faces, 5U);
    EXPECT_THAT(imports.problems(), testing::IsEmpty());
  }
}

/// The same faces, with their values, in another order.
mesh_file::MeshData faces_backwards(const mesh_file::MeshData& mesh) {
  mesh_file::MeshData out = mesh;
  out.face_sizes.clear();
  out.corners.clear();
  const auto is_of_vertices = [](const Attribute& attribute) { return attribute.info.of == AttributeOf::vertex; };
  for (Attribute& attribute : out.attributes)
    if (!is_of_vertices(attribute)) attribute.values.clear();
  const auto take = [&](std::size_t a, std::size_t first, std::size_t count) {
    const std::size_t components = mesh.attributes[a].info.components;
    const auto begin = mesh.attributes[a].values.begin() + static_cast<std::ptrdiff_t>(first * components);
    auto& to = out.attributes[a].values;
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count * components));
  };
  std::size_t end = mesh.corners.size();
  for (std::size_t f = mesh.face_sizes.size(); f-- > 0; end -= mesh.face_sizes[f]) {
    const std::size_t first = end - mesh.face_sizes[f];
    out.face_sizes.push_back(mesh.face_sizes[f]);
    for (std::size_t c = first; c < end; ++c) out.corners.push_back(mesh.corners[c]);
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
      if (mesh.attributes[a].info.of == AttributeOf::face) take(a, f, 1);
      if (mesh.attributes[a].info.of == AttributeOf::corner) take(a, first, end - first);
    }
  }
  return out;
}

TEST(LargeImport, OfPolygonsIsTheSameForAnyOrderOfTheFileAndAnyNumberOfThreads) {
  const mesh_file::MeshData mesh = painted_grid(60);
  const Imports imports;
  write_data(mesh, imports / "in.ply");
  write_data(faces_backwards(mesh), imports / "backwards.ply");
  const auto on = [](unsigned threads) { return [=](ImportOptions& options) { options.threads = threads; }; };
  (void)imports.import("in.ply", "as it is", kLittle, on(2));
  (void)imports.import("in.ply", "on one thread", kLittle, on(1));
  (void)imports.import("in.ply", "on eight", kLittle, on(8));
  (void)imports.import("backwards.ply", "backwards", kLittle, on(2));
  const auto expected = blobs_of(imports.repository(), "as it is");
  EXPECT_EQ(blobs_of(imports.repository(), "on one thread"), expected);
  EXPECT_EQ(blobs_of(imports.repository(), "on eight"), expected);
  EXPECT_EQ(blobs_of(imports.repository(), "backwards"), expected);
}

/// Faces beside a far vertex lie in few cells of the curve: blocks end within one, but within no polygon.
TEST(LargeImport, KeepsPolygonsWholeWhereManyLieTogether) {
  mesh_file::MeshData mesh = painted_grid(40);
  mesh.attributes.clear();
  mesh.positions.push_back({1e7, 0, 0});
  const Imports imports;
  write_data(mesh, imports / "in.ply");
  const auto finely = [](ImportOptions& options) { options.bits = 30; };
  EXPECT_GT(imports.import("in.ply", "large", kLittle, finely).info.charts, 20U);
  const Snapshot snapshot = imports.repository().snapshot("large");
  (void)imports.repository().export_mesh(snapshot, imports / "out.ply", {});
  EXPECT_TRUE(records(snapshot, mesh_file::read_mesh(imports / "out.ply")) == records(snapshot, mesh));
  EXPECT_THAT(imports.problems(), testing::IsEmpty());
}

TEST(LargeImport, KeepsPositionsToTheLastBit) {
  for (const bool wide : {false, true}) {
    const Imports imports;
    TestMesh mesh = scan(3000);
    for (Point& p : mesh.positions)
      for (int a = 0; a < 3; ++a) p[a] = wide ? p[a] / 3 : static_cast<float>(p[a]);
    const auto lossless = [](ImportOptions& options) { options.lossless = true; };
    (void)imports.import(mesh, "large", kLittle, lossless);
    const RegionMesh got = whole(imports.repository().snapshot("large"));
    const auto sorted = [](std::vector<Point> points) {
      std::ranges::sort(points, {}, [](const Point& p) { return std::tuple(p.x, p.y, p.z); });
      return points;
    };
    EXPECT_EQ(sorted(got.exact), sorted(mesh.positions)) << wide;
    EXPECT_THAT(imports.problems(), testing::IsEmpty());
  }
}

std::string text_of_error(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(LargeImport, RefusesWhatItCannotTakeUnlessMemoryIsLeftOpen) {
  const Imports imports;
  std::ofstream(imports / "group.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\ng left\nf 1 2 3\n";
  std::ofstream(imports / "color.obj") << "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nf 1 2 3\n";
  for (const char* file : {"group.obj", "color.obj"}) {
    EXPECT_THAT(text_of_error([&] { (void)imports.import(file, file, 1); }), testing::HasSubstr("--memory")) << file;
    EXPECT_EQ(text_of_error([&] { (void)imports.import(file, file, {}); }), "") << file;
  }
}

TEST(LargeImport, RefusesBrokenFilesInTheWordsOfOthers) {
  const Imports imports;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::vector<std::pair<const char*, std::string>> files = {
      {"cut off.ply", ply + "0 0 0\n1 0 0\n"},
      {"no such vertex.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"},
      {"not finite.ply", ply + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"},
      {"no such vertex.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"no vertex.obj", "# nothing\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n\n"},
      {"cut off.stl", "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\n" + std::string(300, ' ')},
  };
  for (const auto& [file, text] : files) {
    std::ofstream(imports / file, std::ios::binary) << text;
    const std::string in_core = text_of_error([&] { (void)imports.import(file, file, {}); });
    EXPECT_NE(in_core, "") << file;
    EXPECT_EQ(text_of_error([&] { (void)imports.import(file, file, 1); }), in_core);
  }
}

/// Reports of an import of a soup, in order: the first and the last of every stage and, in memory, all.
std::vector<std::size_t> reports_of_import(const Imports& imports, std::optional<std::uint64_t> memory) {
  std::vector<std::string> stages;
  std::vector<std::size_t> reports;
  std::size_t count = 0;
  (void)imports.import("a.stl", "first", memory, [&](ImportOptions& options) {
    options.dry_run = true;
    options.threads = 1;  // reports are the same every time
    options.progress = [&](std::string_view stage, double) {
      if (stages.empty() || stages.back() != stage) {
        stages.emplace_back(stage);
        if (count) reports.push_back(count - 1);
        reports.push_back(count);
      } else if (!memory) {
        reports.push_back(count);
      }
      ++count;
    };
  });
  if (memory) {
    EXPECT_GT(stages.size(), 7U);
  } else {
    EXPECT_THAT(stages, testing::ElementsAre("read", "weld", "snap", "sort", "chartify", "join", "encode", "store"));
  }
  std::ranges::sort(stages);
  stages.erase(std::unique(stages.begin(), stages.end()), stages.end());
  EXPECT_THAT(stages,
              testing::UnorderedElementsAre("read", "weld", "snap", "sort", "chartify", "join", "encode", "store"));
  return reports;
}

TEST(LargeImport, ThatIsCancelledAtAnyStageLeavesNothing) {
  const Imports imports;
  write_test_mesh(scan(1000), imports / "a.stl");
  for (const std::optional<std::uint64_t> memory : {std::optional<std::uint64_t>(), std::optional(kLittle)}) {
    for (const std::size_t stop : reports_of_import(imports, memory)) {
      std::size_t count = 0;
      const auto cancel = [&](ImportOptions& options) {
        options.threads = 1;
        options.progress = [&](std::string_view, double) {
          if (count++ == stop) throw Error(Errc::cancelled, "stopped");
        };
      };
      EXPECT_EQ(text_of_error([&] { (void)imports.import("a.stl", "first", memory, cancel); }), "stopped") << stop;
      EXPECT_TRUE(imports.repository().meshes().empty()) << stop;
    }
    EXPECT_THAT(imports.files(), testing::Not(testing::Contains(testing::HasSubstr("scratch"))));
  }
  EXPECT_THAT(imports.problems(), testing::IsEmpty());
}

TEST(LargeImport, ThatIsKilledWhileItStoresIsSwept) {
  const Imports imports;
  const TestMesh mesh = scan(60'000);
  write_test_mesh(mesh, imports / "a.ply");
  db::test::ChildProcess child([&] {
    (void)imports.import("a.ply", "first", kLittle, [](ImportOptions& options) {
      options.progress = [](std::string_view stage, double done) {
        if (stage == "store" && done > 0.5) ::raise(SIGKILL);
      };
    });
  });
  EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  EXPECT_TRUE(imports.repository().meshes().empty());
  std::ofstream(imports / "r.ramcdb" / "scratch-killed") << "left by a killed process";
  (void)imports.import("a.ply", "second", kLittle);
  EXPECT_THAT(imports.problems(), testing::IsEmpty());
  expect_same_mesh(imports.repository().snapshot("second"), mesh);
  EXPECT_THAT(imports.files(), testing::Not(testing::Contains(testing::HasSubstr("scratch"))));
}

}  // namespace
}  // namespace ramcdb::test
