#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "api/mesh_file/mesh_file.h"
#include "tests/api/mesh_file/files.h"
#include "tests/support/meshes.h"

/// Welding and cutting polygons into triangles.
namespace ramcdb::test {
namespace {

using mesh_file::MeshData;

TEST(Weld, EqualPositionsBecomeOneVertex) {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {0, 1, 0}, {std::nextafter(1.0, 2.0), 0, 0}};
  mesh.vertex_ids = {10, 11, 12, 13, 14, 15};
  mesh.corners = {0, 1, 2, 3, 4, 5};
  mesh.soup = true;
  mesh_file::weld_exact(mesh);
  EXPECT_EQ(mesh.positions, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {std::nextafter(1.0, 2.0), 0, 0}}));
  EXPECT_EQ(mesh.vertex_ids, (std::vector<std::uint64_t>{10, 11, 12, 15}));
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_FALSE(mesh.soup);
}

AttributeInfo info(const char* name, AttributeOf of, NumberType type, std::uint8_t components) {
  AttributeInfo made;
  made.name = name;
  made.of = of;
  made.type = type;
  made.components = components;
  return made;
}

TEST(Weld, AttributesStayWithTheirVertices) {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.corners = {0, 1, 3, 2, 4, 3};
  mesh.attributes = {{info("uv", AttributeOf::vertex, NumberType::float32, 2), {0, 1, 10, 11, 20, 21, 30, 31, 40, 41}},
                     {info("c", AttributeOf::corner, NumberType::float32, 1), {0, 1, 2, 3, 4, 5}},
                     {info("f", AttributeOf::face, NumberType::uint8, 1), {7, 8}}};
  mesh_file::weld_exact(mesh);
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(mesh.attributes[0].values, (std::vector<double>{0, 1, 10, 11, 30, 31}));
  EXPECT_EQ(mesh.attributes[1].values, (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(mesh.attributes[2].values, (std::vector<double>{7, 8}));
}

TEST(Weld, ASoupBecomesTheMeshItCameFrom) {
  const TestMesh mesh = shuffled(sphere(3000), 7);
  MeshData soup;
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) {
      soup.corners.push_back(static_cast<std::uint32_t>(soup.positions.size()));
      soup.positions.push_back(mesh.positions[v]);
    }
  mesh_file::weld_exact(soup);
  EXPECT_EQ(soup.positions.size(), mesh.positions.size());
  const auto faces = triangles(soup);
  ASSERT_EQ(faces.size(), mesh.faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(soup.positions[faces[f][c]], mesh.positions[mesh.faces[f][c]]);
  const auto once = bits(soup.positions);
  mesh_file::weld_exact(soup);
  EXPECT_EQ(bits(soup.positions), once);
}

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

using Outline = std::vector<std::pair<double, double>>;

/// The outline, anti-clockwise, on a plane somewhere in space.
MeshData on_plane(const Outline& outline, int plane) {
  static constexpr Point kOrigin[] = {{0, 0, 0}, {1000, -2000, 500}, {0, 5, 0}};
  static constexpr Point kX[] = {{1, 0, 0}, {0.36, 0.48, -0.8}, {0, 0, 1}};
  static constexpr Point kY[] = {{0, 1, 0}, {-0.8, 0.6, 0}, {1, 0, 0}};
  MeshData mesh;
  for (const auto& [x, y] : outline) {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = kOrigin[plane][a] + x * kX[plane][a] + y * kY[plane][a];
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(p);
  }
  mesh.face_sizes = {static_cast<std::uint32_t>(outline.size())};
  return mesh;
}

/// Cuts the only polygon. Triangles that all turn the way the polygon does and whose edges add up to its outline cover
/// it once; edges add up when each vertex keeps its edges, which clipping ensures, and the area is checked.
void expect_cut(const MeshData& before, double least_area = 0) {
  Point normal;
  const auto at = [&](std::size_t i) { return before.positions[before.corners[i % before.corners.size()]]; };
  for (std::size_t i = 0; i < before.corners.size(); ++i) {
    const Point n = cross(at(i) - at(0), at(i + 1) - at(0));
    for (int a = 0; a < 3; ++a) normal[a] += n[a];
  }
  const mesh_file::Triangulation cut = mesh_file::triangulate(before);
  EXPECT_EQ(cut.polygons, before.corners.size() > 3 ? 1U : 0U);
  EXPECT_EQ(cut.fans, 0U);
  EXPECT_EQ(cut.face, std::vector<std::uint32_t>(before.corners.size() - 2, 0));
  ASSERT_EQ(cut.corners.size(), before.corners.size() - 2);
  const double length = std::sqrt(dot(normal, normal));
  double sum = 0;
  for (const Triangle& t : cut.corners) {
    ASSERT_LT(*std::max_element(t.begin(), t.end()), before.corners.size());
    const Point a = at(t[0]), b = at(t[1]), c = at(t[2]);
    const double area = dot(cross(b - a, c - a), normal) / length;
    EXPECT_GE(area, least_area) << t[0] << ' ' << t[1] << ' ' << t[2];
    sum += area;
  }
  EXPECT_NEAR(sum, length, 1e-9 * length);
}

void expect_cut_everywhere(const Outline& outline, double least_area = 1e-12) {
  for (int plane = 0; plane < 3; ++plane)
    for (std::size_t turn = 0; turn < std::min<std::size_t>(outline.size(), 12); ++turn) {
      Outline turned(outline.begin() + static_cast<std::ptrdiff_t>(turn), outline.end());
      turned.insert(turned.end(), outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(turn));
      // Corners on straight lines may lie a rounding error to either side on a slanted plane.
      expect_cut(on_plane(turned, plane), plane == 1 ? -1e-9 : least_area);
    }
}

TEST(Triangulate, ConcaveOutlines) {
  expect_cut_everywhere({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  expect_cut_everywhere({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}});
  expect_cut_everywhere({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}});
  expect_cut_everywhere({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}});  // straight corners
  expect_cut_everywhere({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 0}, {3, 0}, {3, 2}, {0, 2}});  // a gate
  expect_cut_everywhere({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});                          // an M
}

TEST(Triangulate, Combs) {
  for (const int teeth : {3, 20, 200}) {
    Outline comb{{0, -1}, {2.0 * teeth, -1}};
    for (int i = teeth; i-- > 0;) {
      comb.insert(comb.end(), {{2.0 * i + 1.5, 5}, {2.0 * i + 1, 0.1 + 0.3 * (i % 3)}});
      if (i == 0) comb.push_back({0.5, 5});
    }
    expect_cut_everywhere(comb, 0);
  }
}

TEST(Triangulate, Spirals) {
  Outline spiral;
  constexpr int kCorners = 400;
  const auto add = [&](int i, double width) {
    const double angle = i * 0.1, radius = 1 + i * 0.05 + width;
    spiral.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  };
  for (int i = 0; i < kCorners; ++i) add(i, 0.1);
  for (int i = kCorners; i-- > 0;) add(i, 0);
  expect_cut_everywhere(spiral);
}

TEST(Triangulate, RandomStars) {
  std::mt19937 random(5);  // the same numbers everywhere
  for (int round = 0; round < 200; ++round) {
    Outline star;
    const auto corners = 4 + random() % 60;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
      const double radius = 0.05 + static_cast<double>(random() % 1000) / 1000;
      star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    for (int plane = 0; plane < 3; ++plane) expect_cut(on_plane(star, plane));
  }
}

TEST(Triangulate, AHoleJoinedByAnEdgeThatIsWalkedTwice) {
  Outline square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Outline keyhole = square;
    keyhole.insert(keyhole.end(), {{0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
    std::rotate(keyhole.begin(), keyhole.begin() + static_cast<std::ptrdiff_t>(3 * turn), keyhole.end());
    for (int plane = 0; plane < 3; ++plane) expect_cut(on_plane(keyhole, plane), plane == 1 ? -1e-9 : 0);
  }
}

TEST(Triangulate, OtherPolygonsStayWhole) {
  MeshData mesh = on_plane({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {5, 5}}, 1);
  mesh.corners = {0, 1, 2, 0, 1, 2, 3, 4, 3, 2, 1, 0};
  mesh.face_sizes = {3, 4, 5};
  const auto cut = mesh_file::triangulate(mesh);
  EXPECT_EQ(cut.polygons, 2U);
  EXPECT_EQ(cut.fans, 0U);
  EXPECT_EQ(cut.face, (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 2}));
  EXPECT_EQ(cut.corners[0], (Triangle{0, 1, 2}));
  for (std::size_t t = 0; t < cut.corners.size(); ++t)
    for (const std::uint32_t c : cut.corners[t])
      EXPECT_EQ(cut.face[t], c < 3 ? 0U : c < 7 ? 1U : 2U) << "corners are those of the face that was cut";
}

TEST(Triangulate, TrianglesAreTheirCorners) {
  MeshData mesh = on_plane({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0);
  mesh.corners = {0, 1, 2, 3, 2, 1};
  mesh.face_sizes = {};
  const auto cut = mesh_file::triangulate(mesh);
  EXPECT_EQ(cut.corners, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(cut.face, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(cut.polygons, 0U);
}

TEST(Triangulate, PolygonsWithoutShapeTakeLittleTime) {
  // All corners in one place, on one line, and here and there: one triangle per corner more than two, in range.
  constexpr std::uint32_t kCorners = 10000;
  std::mt19937 random(1);
  for (int kind = 0; kind < 3; ++kind) {
    MeshData mesh;
    for (std::uint32_t i = 0; i < kCorners; ++i) {
      const double x = kind ? static_cast<double>(random() % 1000) : 0,
                   y = kind > 1 ? static_cast<double>(random() % 1000) : 0;
      mesh.positions.push_back({x, y, 0});
      mesh.corners.push_back(i);
    }
    mesh.face_sizes = {kCorners};
    const auto cut = mesh_file::triangulate(mesh);
    EXPECT_EQ(cut.polygons, 1U);
    EXPECT_EQ(cut.fans, kind > 1 ? 1U : 0U);
    EXPECT_EQ(cut.face.size(), kCorners - 2);
    ASSERT_EQ(cut.corners.size(), kCorners - 2);
    for (const Triangle& t : cut.corners) ASSERT_LT(*std::max_element(t.begin(), t.end()), kCorners);
  }
}

}  // namespace
}  // namespace ramcdb::test
