#include "chartify/face_mover.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>
#include <set>

#include "chartify/growth.h"
#include "tests/chartify/chart_checks.h"
#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"

namespace ramcdb::chartify::test {
namespace {

/// What a chart is as a surface, counted from its faces one by one.
struct Shape {
  std::size_t pieces = 0;   ///< over edges
  std::int64_t euler = 0;   ///< fans - edges + faces: of the surface with its pinches pulled apart
  std::size_t pinches = 0;  ///< fans of the chart's faces beyond one per vertex

  /// What FaceMover promises: the same surface, no new pinch. Growth may leave a pinch, which a move may undo.
  [[nodiscard]] bool is_kept_by(const Shape& after) const {
    return after.pieces == pieces && after.euler == euler && after.pinches <= pinches;
  }
};
std::ostream& operator<<(std::ostream& out, const Shape& shape) {
  return out << shape.pieces << " pieces, Euler characteristic " << shape.euler << ", " << shape.pinches << " pinches";
}

/// A mesh in few charts, whose faces may be moved. A vertex with several fans of the mesh counts as several.
class Moves {
 public:
  explicit Moves(const ramcdb::test::TestMesh& test_mesh)
      : mesh(canonical_order(on_lattice(test_mesh)).mesh),
        twins(find_twins(mesh, group_half_edges(mesh))),
        neighbours(find_neighbours(twins)),
        limits(static_cast<std::uint32_t>(mesh.faces.size() / 6 + 1)),
        partition(grow_charts(mesh, neighbours, find_components(neighbours, limits.target), 2, nullptr)),
        mover(twins, limits, partition),
        vertex_of(join_corners([](std::uint32_t) { return true; })) {}

  [[nodiscard]] Shape shape_of(std::uint32_t chart) const {
    const auto inside = [&](std::uint32_t f) { return partition.chart_of_face[f] == chart; };
    const std::vector<std::uint32_t> fan_of = join_corners(inside);
    std::vector<std::uint32_t> piece(mesh.faces.size());
    std::iota(piece.begin(), piece.end(), 0U);
    std::set<std::uint32_t> vertices, fans, pieces;
    std::int64_t edges = 0, faces = 0;
    for (HalfEdge h = 0; h < twins.size(); ++h) {
      if (!inside(face_of(h))) continue;
      faces += h % 3 == 0;
      const bool joined = twins[h] != kNoTwin && inside(face_of(twins[h]));
      edges += !joined || h < twins[h];
      if (joined) piece[root_of(piece, face_of(h))] = root_of(piece, face_of(twins[h]));
      vertices.insert(vertex_of[h]);
      fans.insert(fan_of[h]);
    }
    for (std::uint32_t f = 0; f < piece.size(); ++f)
      if (inside(f)) pieces.insert(root_of(piece, f));
    return {pieces.size(), static_cast<std::int64_t>(fans.size()) - edges + faces, fans.size() - vertices.size()};
  }

  IndexedMesh mesh;
  std::vector<HalfEdge> twins;
  Neighbours neighbours;
  SizeLimits limits;
  Partition partition;
  FaceMover mover;
  std::vector<std::uint32_t> vertex_of;  ///< fan of the mesh that a half-edge starts in

 private:
  /// Joins the corners at the two ends of every edge between faces that are both inside.
  template <class Inside>
  [[nodiscard]] std::vector<std::uint32_t> join_corners(Inside&& inside) const {
    std::vector<std::uint32_t> corner(twins.size());
    std::iota(corner.begin(), corner.end(), 0U);
    for (HalfEdge h = 0; h < twins.size(); ++h)
      if (twins[h] != kNoTwin && inside(face_of(h)) && inside(face_of(twins[h])))
        corner[root_of(corner, h)] = root_of(corner, next_in_face(twins[h]));
    for (HalfEdge h = 0; h < corner.size(); ++h) corner[h] = root_of(corner, h);
    return corner;
  }
};

struct Tally {
  std::size_t moved = 0, refused_rightly = 0, refused_too_much = 0;
};

/// Moves border faces at random wherever the mover lets it, so that charts get ragged, and looks at every move.
Tally move_at_random(Moves& moves, unsigned seed, int attempts) {
  std::mt19937 random(seed);
  Tally tally;
  for (int i = 0; i < attempts; ++i) {
    const auto face = static_cast<std::uint32_t>(random() % moves.mesh.faces.size());
    const std::uint32_t beside = moves.mover.neighbour(face, static_cast<std::uint32_t>(random() % 3));
    const std::uint32_t from = moves.mover.chart(face), to = beside == kNone ? kNone : moves.mover.chart(beside);
    if (from == kNone || to == kNone || from == to) continue;
    const Shape donor = moves.shape_of(from), taker = moves.shape_of(to);
    const bool allowed = moves.mover.keeps_shape(face, to);
    moves.mover.move(face, to);
    const Shape donor_after = moves.shape_of(from), taker_after = moves.shape_of(to);
    if (allowed) {
      EXPECT_TRUE(donor.is_kept_by(donor_after)) << "face " << face << " from " << donor << " to " << donor_after;
      EXPECT_TRUE(taker.is_kept_by(taker_after)) << "face " << face << " from " << taker << " to " << taker_after;
      ++tally.moved;
    } else {
      const bool kept = donor.is_kept_by(donor_after) && taker.is_kept_by(taker_after);
      ++(kept ? tally.refused_too_much : tally.refused_rightly);
      moves.mover.move(face, from);
    }
  }
  return tally;
}

class FaceMoverOn : public testing::TestWithParam<Family> {};

TEST_P(FaceMoverOn, KeepsTheShapeOfBothCharts) {
  Moves moves(GetParam().make());
  const Tally tally = move_at_random(moves, 7, 12'000);
  EXPECT_GT(tally.moved, 300U);
  EXPECT_GT(tally.refused_rightly, 40U);
  EXPECT_EQ(tally.refused_too_much, 0U);
}

std::vector<Family> families_to_move_on() {
  namespace make = ramcdb::test;
  return {{"Sphere", [] { return make::sphere(300); }},
          {"Torus", [] { return make::torus(300); }},
          {"Genus3", [] { return make::genus3(400); }},
          {"Terrain", [] { return make::terrain(12, 12); }},
          {"Strip", [] { return make::terrain(2, 60); }},
          {"Scan", [] { return make::scan(300); }},
          {"Moebius", make::moebius},
          {"Hourglass", make::hourglass},
          {"ThreeFacesOneEdge", make::three_faces_one_edge},
          {"DegenerateAndDuplicate", make::degenerate_and_duplicate_faces}};
}

INSTANTIATE_TEST_SUITE_P(Families, FaceMoverOn, testing::ValuesIn(families_to_move_on()),
                         [](const auto& family) { return std::string(family.param.name); });

}  // namespace
}  // namespace ramcdb::chartify::test
