#include "api/decimation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/meshes.h"

/// Fewer faces, the same borders, and a trace of where everything came from.
namespace ramcdb::test {
namespace {

using detail::decimate_faces;
using detail::DecimatedFaces;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::map<Edge, int> faces_at_edges(std::span<const Triangle> faces) {
  std::map<Edge, int> count;
  for (const Triangle& t : faces)
    for (std::size_t i = 0; i < 3; ++i) ++count[std::minmax(t[i], t[(i + 1) % 3])];
  return count;
}

/// Vertices of edges that have not two faces.
std::set<std::uint32_t> border_of(std::span<const Triangle> faces) {
  std::set<std::uint32_t> border;
  for (const auto& [edge, count] : faces_at_edges(faces))
    if (count != 2) border.insert({edge.first, edge.second});
  return border;
}

void expect_sound(const TestMesh& mesh, const DecimatedFaces& out) {
  ASSERT_EQ(out.faces.size(), out.source_face.size());
  EXPECT_TRUE(std::ranges::is_sorted(out.kept));
  EXPECT_TRUE(std::ranges::adjacent_find(out.source_face, std::ranges::greater_equal{}) == out.source_face.end());
  for (std::size_t f = 0; f < out.faces.size(); ++f) {
    ASSERT_LT(out.source_face[f], mesh.faces.size());
    for (const std::uint32_t v : out.faces[f]) EXPECT_TRUE(std::ranges::binary_search(out.kept, v));
    // A corner that is an old one stands where it stood, but for faces of which none is left.
    const Triangle &now = out.faces[f], &was = mesh.faces[out.source_face[f]];
    for (std::size_t i = 0; i < 3; ++i) {
      if (now[i] == was[i]) continue;
      const bool elsewhere = std::ranges::count(was, now[i]) > 0;
      EXPECT_FALSE(elsewhere && std::ranges::equal(now, was)) << f;
    }
  }
  for (const std::uint32_t v : border_of(mesh.faces)) EXPECT_TRUE(std::ranges::binary_search(out.kept, v)) << v;
}

struct DecimatedShape {
  const char* name;
  TestMesh (*make)();
};

class DecimationOf : public testing::TestWithParam<DecimatedShape> {};

TEST_P(DecimationOf, HalvesTheFacesAndKeepsTheBorder) {
  const TestMesh mesh = GetParam().make();
  const std::vector<bool> none(mesh.positions.size(), false);
  const DecimatedFaces out = decimate_faces(mesh.positions, mesh.faces, none, mesh.faces.size() / 2);
  expect_sound(mesh, out);
  EXPECT_LE(out.faces.size(), mesh.faces.size() / 2 + 1);
  const auto before = faces_at_edges(mesh.faces), after = faces_at_edges(out.faces);
  for (const auto& [edge, count] : before)
    if (count != 2) {
      EXPECT_EQ(after.count(edge) ? after.at(edge) : 0, count);
    }
  for (const auto& [edge, count] : after)
    if (count != 2) {
      EXPECT_TRUE(before.count(edge));
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, DecimationOf,
                         testing::Values(DecimatedShape{"Scan", [] { return scan(6000); }},
                                         DecimatedShape{"Genus3", [] { return genus3(4000); }},
                                         DecimatedShape{"Terrain", [] { return terrain(40, 50); }}),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(Decimation, LockedVerticesStayAndNoNewEdgeJoinsTwo) {
  const TestMesh mesh = terrain(40, 40);
  std::vector<bool> locked(mesh.positions.size());
  for (std::size_t v = 0; v < locked.size(); v += 3) locked[v] = true;
  const DecimatedFaces out = decimate_faces(mesh.positions, mesh.faces, locked, 10);
  expect_sound(mesh, out);
  EXPECT_LT(out.faces.size(), mesh.faces.size());
  const auto border = border_of(mesh.faces);
  const auto stays = [&](std::uint32_t v) { return locked[v] || border.contains(v); };
  const auto before = faces_at_edges(mesh.faces), after = faces_at_edges(out.faces);
  for (std::uint32_t v = 0; v < locked.size(); ++v)
    if (locked[v]) {
      EXPECT_TRUE(std::ranges::binary_search(out.kept, v));
    }
  for (const auto& [edge, count] : after)
    if (stays(edge.first) && stays(edge.second)) {
      EXPECT_TRUE(before.contains(edge));
    }
}

TEST(Decimation, WhatOpenMeshDoesNotTakeStaysAsItIs) {
  for (const TestMesh& mesh : {degenerate_and_duplicate_faces(), three_faces_one_edge(), moebius(), hourglass()}) {
    const std::vector<bool> none(mesh.positions.size(), false);
    expect_sound(mesh, decimate_faces(mesh.positions, mesh.faces, none, 1));
  }
  const TestMesh loose = isolated_vertices();
  const DecimatedFaces out = decimate_faces(loose.positions, loose.faces,
                                            std::vector<bool>(loose.positions.size(), false), loose.faces.size() / 4);
  std::vector<bool> used(loose.positions.size());
  for (const Triangle& t : loose.faces)
    for (const std::uint32_t v : t) used[v] = true;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) {
      EXPECT_TRUE(std::ranges::binary_search(out.kept, v));
    }
}

TEST(Decimation, NothingToDoGivesTheMeshBack) {
  const TestMesh mesh = scan(1000);
  const std::vector<bool> none(mesh.positions.size(), false);
  const DecimatedFaces out = decimate_faces(mesh.positions, mesh.faces, none, mesh.faces.size());
  EXPECT_EQ(out.faces, mesh.faces);
  EXPECT_EQ(out.kept.size(), mesh.positions.size());
  EXPECT_TRUE(decimate_faces({}, {}, {}, 0).faces.empty());
}

TEST(Decimation, FarFromTheOriginItIsTheSame) {
  const TestMesh near = terrain(30, 30);
  TestMesh far = near;
  for (Point& p : far.positions) p = {p.x + 4194304, p.y + 8388608, p.z};
  // On a grid that both places hold exactly.
  TestMesh base = far;
  for (Point& p : base.positions) p = {p.x - 4194304, p.y - 8388608, p.z};
  const std::vector<bool> none(near.positions.size(), false);
  EXPECT_EQ(decimate_faces(far.positions, far.faces, none, 400).faces,
            decimate_faces(base.positions, base.faces, none, 400).faces);
}

}  // namespace
}  // namespace ramcdb::test
