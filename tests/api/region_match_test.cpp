#include "api/region_match.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "tests/api/edited_region.h"

/// Regions that come back from any program.
namespace ramcdb::test {
namespace {

using detail::FaceMatch;
using detail::match_region;
using detail::RegionFaces;
using detail::RegionMatch;

struct Named {
  std::string name;
  TestMesh mesh;
};

std::vector<Named> manifold_meshes() {
  return {{"sphere", sphere(1200)},
          {"torus", torus(1000)},
          {"genus3", genus3(1500)},
          {"terrain", terrain(24, 17)},
          {"scan", scan(3000)},
          {"boxes", boxes(20)},
          {"components", several_components()}};
}

std::vector<Named> ugly_meshes() {
  return {{"moebius", moebius()},
          {"two cubes", two_cubes_sharing_edge()},
          {"hourglass", hourglass()},
          {"three sheets", three_faces_one_edge()},
          {"degenerate", degenerate_and_duplicate_faces()},
          {"isolated", isolated_vertices()}};
}

std::vector<Named> all_meshes() {
  std::vector<Named> all = manifold_meshes();
  for (Named& mesh : ugly_meshes()) all.push_back(std::move(mesh));
  return all;
}

/// What must hold whatever was matched.
void expect_sound(const RegionFaces& faces, const EditedRegion& edited, const RegionMatch& match) {
  ASSERT_EQ(match.vertex.size(), edited.points.size());
  ASSERT_EQ(match.faces.size(), edited.face_count());
  std::set<std::uint32_t> vertices, survivors;
  for (const RegionMatch::Vertex& v : match.vertices)
    if (v.region != RegionMatch::kNone) {
      EXPECT_TRUE(vertices.insert(v.region).second) << "twice: " << v.region;
    }
  for (std::size_t w = 0; w < match.vertex.size(); ++w)
    EXPECT_EQ(edited.points[w], edited.points[match.vertices[match.vertex[w]].other]);
  for (std::size_t g = 0; g < match.faces.size(); ++g) {
    const FaceMatch found = match.faces[g];
    if (found.face == FaceMatch::kNone) continue;
    EXPECT_TRUE(survivors.insert(found.face).second) << "twice: " << found.face;
    const std::uint32_t first = faces.firsts()[found.face], size = faces.firsts()[found.face + 1] - first;
    ASSERT_EQ(size, edited.firsts[g + 1] - edited.firsts[g]);
    for (std::uint32_t i = 0; i < size; ++i)
      EXPECT_EQ(match.vertices[match.vertex[edited.corners[edited.firsts[g] + i]]].region,
                faces.vertices()[first + (i + found.turn) % size]);
  }
  EXPECT_EQ(match.faces_gone, faces.count() - survivors.size());
}

std::uint64_t survivors_of(const RegionMatch& match) {
  return static_cast<std::uint64_t>(
      std::count_if(match.faces.begin(), match.faces.end(), [](FaceMatch m) { return m.face != FaceMatch::kNone; }));
}

/// Exactly the faces survive that the edit left alone, and exactly their vertices are old.
void expect_true(const RegionMesh& region, const EditedRegion& edited, bool with_ids) {
  const RegionFaces faces(region);
  const RegionMatch match = match_region(region, faces, edited.other(with_ids));
  expect_sound(faces, edited, match);
  std::size_t wrong_faces = 0, wrong_vertices = 0;
  for (std::size_t g = 0; g < edited.face_count(); ++g) wrong_faces += match.faces[g].face != edited.face_was[g];
  for (std::size_t w = 0; w < edited.points.size(); ++w)
    wrong_vertices += match.vertices[match.vertex[w]].region != edited.vertex_was[w];
  EXPECT_EQ(wrong_faces, 0U);
  EXPECT_EQ(wrong_vertices, 0U);
}

/// All of the region is there; which of several alike faces each is does not matter.
void expect_all_survive(const RegionMesh& region, const EditedRegion& edited, bool with_ids, bool in_place) {
  const RegionFaces faces(region);
  const RegionMatch match = match_region(region, faces, edited.other(with_ids));
  expect_sound(faces, edited, match);
  EXPECT_TRUE(match.same_connectivity()) << survivors_of(match) << " of " << faces.count() << " faces, "
                                         << match.vertices_gone << " vertices gone";
  for (const RegionMatch::Vertex& v : match.vertices)
    if (in_place && v.region != RegionMatch::kNone && v.other != RegionMatch::kNone) {
      EXPECT_EQ(region.points[v.region], edited.points[v.other]);
    }
}

TEST(RegionMatch, ReorderedIsUnchanged) {
  for (const Named& m : all_meshes())
    for (const bool ids : {false, true}) {
      SCOPED_TRACE(m.name + (ids ? " with ids" : ""));
      const RegionMesh region = region_of(m.mesh);
      EditedRegion edited(region);
      expect_true(region, edited, ids);
      edited.shuffle(7);
      expect_all_survive(region, edited, ids, true);
    }
}

TEST(RegionMatch, AFileThatSplitsVerticesIsUnchanged) {
  for (const Named& m : all_meshes()) {
    SCOPED_TRACE(m.name);
    const RegionMesh region = region_of(m.mesh);
    EditedRegion edited(region);
    edited.explode();
    expect_all_survive(region, edited, false, true);
    expect_all_survive(region, edited, true, true);
    edited.shuffle(7);
    expect_all_survive(region, edited, false, true);
  }
}

TEST(RegionMatch, MovedInsideIsMoved) {
  for (const Named& m : {Named{"terrain", terrain(30, 22)}, Named{"scan", scan(4000)}}) {
    const RegionMesh region = region_of(m.mesh);
    EditedRegion moved(region);
    moved.move([&](std::uint32_t v) { return !region.outer_border[v]; });
    for (const bool shuffled : {false, true})
      for (const bool ids : {false, true}) {
        SCOPED_TRACE(m.name + (ids ? " ids" : "") + (shuffled ? " shuffled" : ""));
        EditedRegion edited = moved;
        if (shuffled) edited.shuffle(3);
        expect_true(region, edited, ids);
      }
    SCOPED_TRACE(m.name + " as a soup");
    moved.shuffle(4);
    moved.explode();
    expect_true(region, moved, false);
  }
}

TEST(RegionMatch, AllMovedInOrderIsMoved) {
  for (const Named& m : all_meshes()) {
    SCOPED_TRACE(m.name);
    const RegionMesh region = region_of(m.mesh);
    EditedRegion edited(region);
    edited.move([](std::uint32_t) { return true; });
    expect_true(region, edited, false);
  }
}

TEST(RegionMatch, AllMovedAndReorderedIsFoundByItsConnectivity) {
  const RegionMesh region = region_of(irregular(sphere(6000)));
  EditedRegion edited(region);
  edited.move([](std::uint32_t) { return true; });
  edited.shuffle(11);
  expect_true(region, edited, false);
  edited.explode();
  expect_true(region, edited, false);
}

TEST(RegionMatch, LocallyRemeshedKeepsTheRest) {
  for (const Named& m : manifold_meshes()) {
    const RegionMesh region = region_of(m.mesh);
    for (const double share : {0.01, 0.1, 0.3}) {
      EditedRegion remeshed(region);
      remeshed.remesh(share, 5);
      for (const bool shuffled : {false, true})
        for (const bool ids : {false, true}) {
          SCOPED_TRACE(m.name + " " + std::to_string(share) + (ids ? " ids" : "") + (shuffled ? " shuffled" : ""));
          EditedRegion edited = remeshed;
          if (shuffled) edited.shuffle(8);
          expect_true(region, edited, ids);
        }
      SCOPED_TRACE(m.name + " as a soup");
      remeshed.explode();
      expect_true(region, remeshed, false);
    }
  }
}

TEST(RegionMatch, MovedAndRemeshedAtOnce) {
  const RegionMesh region = region_of(scan(6000));
  EditedRegion edited(region);
  edited.remesh(0.01, 3);
  edited.move(
      [&](std::uint32_t v) { return edited.vertex_was[v] != kNew && !region.outer_border[edited.vertex_was[v]]; });
  expect_true(region, edited, true);
  edited.shuffle(5);
  const RegionFaces faces(region);
  const RegionMatch match = match_region(region, faces, edited.other(false));
  expect_sound(faces, edited, match);
  const auto untouched =
      edited.face_count() - static_cast<std::size_t>(std::count(edited.face_was.begin(), edited.face_was.end(), kNew));
  EXPECT_GT(survivors_of(match), untouched * 9 / 10);
  for (std::size_t g = 0; g < edited.face_count(); ++g)
    if (match.faces[g].face != FaceMatch::kNone) {
      EXPECT_EQ(match.faces[g].face, edited.face_was[g]);
    }
}

TEST(RegionMatch, FacesShiftedByOneAreNotMoved) {
  for (const Named& m : manifold_meshes()) {
    SCOPED_TRACE(m.name);
    const RegionMesh region = region_of(m.mesh);
    EditedRegion edited(region);
    std::vector<bool> gone(edited.face_count(), false);
    gone[2] = true;
    edited.remove_faces(gone);
    expect_true(region, edited, false);
    edited.add(Triangle{edited.triangle(0)[0], edited.triangle(20)[1], edited.triangle(30)[2]});
    expect_true(region, edited, false);
  }
}

/// A ring of triangles goes into itself when its faces are counted two further.
TEST(RegionMatch, AnOrderThatFitsByChanceIsNotBelieved) {
  TestMesh ring;
  constexpr std::uint32_t kAround = 50;
  for (std::uint32_t i = 0; i < 2 * kAround; ++i)
    ring.positions.push_back({double(i / 2 % 13), double(i * i % 101), double(i % 2)});
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1, c = (2 * i + 2) % (2 * kAround), d = (2 * i + 3) % (2 * kAround);
    ring.faces.push_back({a, c, b});
    ring.faces.push_back({b, c, d});
  }
  const RegionMesh region = region_of(ring);
  EditedRegion edited(region);
  EditedRegion shifted = edited;
  std::vector<bool> gone(edited.face_count(), false);
  gone[0] = gone[1] = true;
  shifted.remove_faces(gone);
  shifted.add(edited.triangle(0), 0);
  shifted.add(edited.triangle(1), 1);
  expect_true(region, shifted, false);
}

TEST(RegionMatch, AlikeComponentsThatChangePlacesInTheFileStayInPlace) {
  const RegionMesh region = region_of(boxes(12));
  EditedRegion edited(region);
  EditedRegion swapped = edited;
  swapped.corners.clear();
  swapped.firsts = {0};
  swapped.face_was.clear();
  for (const std::uint32_t box : {1U, 0U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U})
    for (std::uint32_t f = 12 * box; f < 12 * box + 12; ++f) swapped.add(edited.triangle(f), f);
  expect_true(region, swapped, false);
}

/// Any order of single triangles fits any other, and where they share points, none of these tells them apart.
TEST(RegionMatch, SingleTrianglesThatChangePlacesInTheFileStayInPlace) {
  TestMesh mesh;
  for (std::uint32_t f = 0; f < 6; ++f) {
    const double a = f / 2, b = f % 3 + 7, c = 20 + f % 2;
    mesh.positions.insert(mesh.positions.end(), {Point{a, 0, 0}, Point{b, 1, 0}, Point{c, 0, 5}});
    mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  const RegionMesh region = region_of(mesh);
  EditedRegion edited(region);
  std::rotate(edited.points.begin(), edited.points.begin() + 6, edited.points.end());
  expect_all_survive(region, edited, false, true);
}

TEST(RegionMatch, ATornVertexIsOneOfItsPieces) {
  const RegionMesh region = region_of(terrain(12, 9));
  for (const bool ids : {false, true}) {
    EditedRegion edited(region);
    const std::uint32_t v = edited.triangle(100)[0];
    const std::uint32_t copy = edited.add(edited.points[v]);
    edited.ids[copy] = edited.ids[v];
    edited.points[copy].z += ids ? 0 : 50;
    int faces = 0;
    for (std::size_t f = 0; f < edited.face_count() && faces < 2; ++f)
      for (std::uint32_t i = 0; i < 3; ++i)
        if (std::uint32_t& corner = edited.corners[edited.firsts[f] + i]; corner == v) {
          corner = copy;
          edited.face_was[f] = kNew;
          ++faces;
        }
    expect_true(region, edited, ids);
    edited.shuffle(2);
    expect_true(region, edited, ids);
  }
}

TEST(RegionMatch, OneVertexOfAnUglyMeshMoves) {
  for (const Named& m : ugly_meshes()) {
    const RegionMesh region = region_of(m.mesh);
    for (std::uint32_t v = 0; v < region.points.size(); v += 7) {
      SCOPED_TRACE(m.name + " vertex " + std::to_string(v));
      EditedRegion edited(region);
      edited.points[v].z += 90;
      edited.shuffle(v);
      expect_all_survive(region, edited, false, false);
      expect_true(region, EditedRegion(region), false);
    }
  }
}

TEST(RegionMatch, CoincidentVerticesStayApart) {
  TestMesh twice = sphere(300);
  const TestMesh once = twice;
  for (const Triangle& t : once.faces) {
    Triangle moved = t;
    for (std::uint32_t& v : moved) v += static_cast<std::uint32_t>(once.positions.size());
    twice.faces.push_back(moved);
  }
  twice.positions.insert(twice.positions.end(), once.positions.begin(), once.positions.end());
  const RegionMesh region = region_of(twice);
  EditedRegion edited(region);
  expect_true(region, edited, false);
  edited.shuffle(4);
  expect_all_survive(region, edited, false, true);
  expect_true(region, edited, true);
  edited.explode();
  expect_all_survive(region, edited, false, true);
  expect_true(region, edited, true);
}

TEST(RegionMatch, IdsThatToolsCopiedOrLeftBehind) {
  const RegionMesh region = region_of(scan(2000));
  EditedRegion copied(region);
  copied.remesh(0.1, 6);
  for (std::size_t w = 0; w < copied.points.size(); ++w)
    if (copied.vertex_was[w] == kNew) copied.ids[w] = copied.ids[w % 100];
  expect_true(region, copied, true);

  EditedRegion sorted(region);
  sorted.shuffle(9);
  for (std::size_t w = 0; w < sorted.ids.size(); ++w) sorted.ids[w] = region.keys[w].packed();
  expect_true(region, sorted, true);
}

/// A triangle beyond an open edge, whose third vertex, the last of the mesh, is in no other face of the region; charts
/// that are not in it may have that vertex, too.
struct Ear {
  TestMesh mesh = terrain(24, 17);
  std::array<std::uint32_t, 2> edge{};

  Ear() {
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const Triangle& t : mesh.faces)
      for (std::size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
    edge = *std::ranges::find_if(edges, [&](const auto& e) { return !edges.contains({e[1], e[0]}); });
    mesh.faces.push_back({edge[1], edge[0], static_cast<std::uint32_t>(mesh.positions.size())});
    mesh.positions.push_back({2, 3, 4});
  }
};

TEST(RegionMatch, IdsThatAToolLostSayNothing) {
  const RegionMesh region = region_of(irregular(scan(2000)));
  EditedRegion edited(region);
  edited.move([](std::uint32_t) { return true; });
  edited.ids.assign(edited.ids.size(), 0);
  expect_all_survive(region, edited, true, false);
}

TEST(RegionMatch, AVertexWithoutIdAmongOthersIsNew) {
  const Ear ear;
  const RegionMesh region = region_of(ear.mesh);
  EditedRegion edited(region);
  edited.points.back().x += 50;
  expect_all_survive(region, edited, false, false);
  edited.ids.back() = 0;
  edited.vertex_was.back() = edited.face_was.back() = kNew;
  expect_true(region, edited, true);
}

TEST(RegionMatch, AVertexElsewhereBesideFacesThatWentIsNew) {
  const Ear ear;
  const RegionMesh region = region_of(ear.mesh);
  EditedRegion edited(region);
  edited.points.back().x += 50;
  edited.vertex_was.back() = edited.face_was.back() = kNew;
  // One face stays beside each end of the edge, so that these are known, and not much else.
  std::vector<bool> gone(region.faces.size() - 1, false);
  for (const std::uint32_t end : ear.edge) {
    bool first = true;
    for (std::uint32_t f = 0; f < gone.size(); ++f) {
      const Triangle& t = region.faces[f];
      if (std::ranges::count(t, end) == 0) continue;
      gone[f] = gone[f] || !first;
      first = false;
    }
  }
  edited.remove_faces(gone);
  expect_true(region, edited, false);
}

TEST(RegionMatch, IsolatedVertices) {
  const RegionMesh region = region_of(isolated_vertices());
  const auto isolated = static_cast<std::uint32_t>(region.points.size() - 1);
  EditedRegion one_moved(region);
  one_moved.points[isolated].x += 9;
  expect_true(region, one_moved, false);

  EditedRegion one_less(region);
  one_less.points.pop_back();
  one_less.vertex_was.pop_back();
  const RegionFaces faces(region);
  EXPECT_EQ(match_region(region, faces, one_less.other(false)).vertices_gone, 1U);

  EditedRegion none(region);
  none.explode();
  const RegionMatch match = match_region(region, faces, none.other(false));
  EXPECT_EQ(match.vertices_gone, 0U) << "a soup cannot say anything of them";
  EXPECT_EQ(match.vertices.back(), (RegionMatch::Vertex{isolated, RegionMatch::kNone}));
}

TEST(RegionMatch, NewVerticesOfASoupAreOnePerPoint) {
  const RegionMesh region = region_of(terrain(10, 8));
  EditedRegion edited(region);
  edited.remesh(0.2, 3);
  const std::size_t vertices = edited.points.size();
  edited.explode();
  const RegionMatch match = match_region(region, RegionFaces(region), edited.other(false));
  EXPECT_EQ(match.vertices.size(), vertices);
}

TEST(RegionMatch, NothingInCommonIsAllNew) {
  const RegionMesh region = region_of(sphere(500));
  RegionMesh stranger = region_of(terrain(9, 14));
  for (LatticePoint& p : stranger.points) p.x += 1 << 20;
  const EditedRegion edited(stranger);
  const RegionFaces faces(region);
  const RegionMatch match = match_region(region, faces, edited.other(false));
  expect_sound(faces, edited, match);
  EXPECT_EQ(match.faces_gone, faces.count());
  EXPECT_EQ(match.vertices_gone, region.points.size());
  EXPECT_EQ(match.vertices.size(), edited.points.size());
}

/// A grid of quads, as a region keeps it.
RegionMesh quads() {
  RegionMesh region = region_of(terrain(12, 8));
  for (std::uint32_t f = 0; f < region.faces.size(); f += 2) {
    region.polygon_of_face.insert(region.polygon_of_face.end(), 2, f / 2);
    region.polygon_sizes.push_back(4);
    const std::uint32_t c = 3 * f;
    region.polygon_corners.insert(region.polygon_corners.end(), {c, c + 1, c + 2, c + 5});
  }
  return region;
}

TEST(RegionMatch, PolygonsAreComparedAsTheFileHasThem) {
  const RegionMesh region = quads();
  EditedRegion triangles(region);
  triangles.shuffle(3);
  EXPECT_TRUE(match_region(region, triangles.other(false)).match.same_connectivity());
  std::vector<bool> gone(triangles.face_count(), false);
  gone[5] = gone[17] = true;
  triangles.remove_faces(gone);
  const auto cut = match_region(region, triangles.other(false));
  EXPECT_TRUE(cut.faces.sizes().empty());
  EXPECT_EQ(cut.match.faces_gone, 2U);

  EditedRegion polygons(region);
  const RegionFaces faces(region);
  polygons.corners = faces.vertices();
  polygons.firsts = faces.firsts();
  const auto whole = match_region(region, polygons.other(false));
  EXPECT_FALSE(whole.faces.sizes().empty());
  EXPECT_TRUE(whole.match.same_connectivity());
  polygons.corners.resize(polygons.corners.size() - 4);
  polygons.firsts.pop_back();
  EXPECT_EQ(match_region(region, polygons.other(false)).match.faces_gone, 1U);
}

}  // namespace
}  // namespace ramcdb::test
