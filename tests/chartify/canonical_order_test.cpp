#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "chartify/chartify.h"
#include "chartify/hilbert_cells.h"
#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"

namespace ramcdb::chartify::test {
namespace {

using ramcdb::test::TestMesh;

bool is_permutation_of_numbers(std::vector<std::uint32_t> numbers, std::size_t count) {
  std::vector<std::uint32_t> expected(count);
  std::iota(expected.begin(), expected.end(), 0U);
  std::sort(numbers.begin(), numbers.end());
  return numbers == expected;
}

class CanonicalOrder : public testing::TestWithParam<Family> {
 protected:
  CanonicalOrder() : input_(on_lattice(GetParam().make())), canonical_(canonical_order(input_)) {}
  IndexedMesh input_;
  CanonicalMesh canonical_;
};

TEST_P(CanonicalOrder, KeepsEveryVertexAndFace) {
  EXPECT_EQ(canonical_.mesh.positions.size(), input_.positions.size());
  EXPECT_EQ(canonical_.mesh.faces.size(), input_.faces.size());
  EXPECT_TRUE(is_permutation_of_numbers(canonical_.source_vertex, input_.positions.size()));
  EXPECT_TRUE(is_permutation_of_numbers(canonical_.source_face, input_.faces.size()));
}

TEST_P(CanonicalOrder, SourcesLeadBackToTheInput) {
  const IndexedMesh& mesh = canonical_.mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    ASSERT_EQ(mesh.positions[v], input_.positions[canonical_.source_vertex[v]]);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Triangle back{};
    for (std::size_t i = 0; i < 3; ++i) back[i] = canonical_.source_vertex[mesh.faces[f][i]];
    Triangle source = input_.faces[canonical_.source_face[f]];
    bool same = false;
    for (int turn = 0; turn < 3; ++turn, std::rotate(source.begin(), source.begin() + 1, source.end()))
      same = same || back == source;
    ASSERT_TRUE(same) << "face " << f << " is another one, or turned over";
  }
}

TEST_P(CanonicalOrder, FacesRunAlongTheCurveSmallestCornerFirst) {
  const IndexedMesh& mesh = canonical_.mesh;
  const HilbertCells cells(mesh);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& t = mesh.faces[f];
    ASSERT_LE(mesh.positions[t[0]], mesh.positions[t[1]]);
    ASSERT_LE(mesh.positions[t[0]], mesh.positions[t[2]]);
    ASSERT_LE(cells.key_of_face(f == 0 ? 0 : f - 1), cells.key_of_face(f));
  }
}

TEST_P(CanonicalOrder, VerticesByFirstFaceAndIsolatedOnesLast) {
  const IndexedMesh& mesh = canonical_.mesh;
  std::uint32_t named = 0;
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) {
      ASSERT_LE(v, named);
      named = std::max(named, v + 1);
    }
  const HilbertCells cells(mesh);
  for (std::uint32_t v = named + 1; v < mesh.positions.size(); ++v)
    ASSERT_LE(cells.key_of_vertex(v - 1), cells.key_of_vertex(v));
}

TEST_P(CanonicalOrder, DoesNotDependOnTheOrderOfTheInput) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    const CanonicalMesh again = canonical_order(on_lattice(ramcdb::test::shuffled(GetParam().make(), seed)));
    EXPECT_EQ(again.mesh.positions, canonical_.mesh.positions) << "seed " << seed;
    EXPECT_EQ(again.mesh.faces, canonical_.mesh.faces) << "seed " << seed;
  }
}

TEST_P(CanonicalOrder, OfACanonicalMeshIsItself) {
  const CanonicalMesh again = canonical_order(canonical_.mesh);
  EXPECT_EQ(again.mesh.positions, canonical_.mesh.positions);
  EXPECT_EQ(again.mesh.faces, canonical_.mesh.faces);
}

INSTANTIATE_TEST_SUITE_P(Families, CanonicalOrder, testing::ValuesIn(all_families()),
                         [](const auto& family) { return std::string(family.param.name); });

TEST(CanonicalOrderTies, DuplicateAndDegenerateFacesAreKept) {
  const IndexedMesh input{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {9, 9, 9}},
                          {{0, 1, 2}, {1, 2, 0}, {0, 2, 1}, {1, 1, 2}, {2, 2, 2}, {0, 1, 2}}};
  const CanonicalMesh canonical = canonical_order(input);
  std::vector<Triangle> faces = canonical.mesh.faces;
  ASSERT_EQ(faces.size(), 6U);
  EXPECT_EQ(canonical.source_vertex.back(), 3U);
  const auto degenerate = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  EXPECT_EQ(std::count_if(faces.begin(), faces.end(), degenerate), 2);
  const auto is_upper = [&](const Triangle& t) {
    return Triangle{canonical.source_vertex[t[0]], canonical.source_vertex[t[1]], canonical.source_vertex[t[2]]} ==
           Triangle{0, 1, 2};
  };
  EXPECT_EQ(std::count_if(faces.begin(), faces.end(), is_upper), 3);
}

/// Two tetrahedra whose bases lie on the same positions with other vertices: their neighbours tell them apart.
TEST(CanonicalOrderTies, NeighboursTellFacesOnEqualPositionsApart) {
  const TestMesh mesh{{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {0, 0, 6}, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {1, 1, 9}},
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {6, 4, 7}}};
  const CanonicalMesh canonical = canonical_order(on_lattice(mesh));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const CanonicalMesh again = canonical_order(on_lattice(ramcdb::test::shuffled(mesh, seed)));
    EXPECT_EQ(again.mesh.positions, canonical.mesh.positions) << "seed " << seed;
    EXPECT_EQ(again.mesh.faces, canonical.mesh.faces) << "seed " << seed;
  }
}

/// A face of three vertices on one point can be turned by nothing but its neighbours.
TEST(CanonicalOrderTies, NeighboursTurnAFaceOnOnePoint) {
  const TestMesh mesh{{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                      {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 5}}};
  const CanonicalMesh canonical = canonical_order(on_lattice(mesh));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const CanonicalMesh again = canonical_order(on_lattice(ramcdb::test::shuffled(mesh, seed)));
    EXPECT_EQ(again.mesh.positions, canonical.mesh.positions) << "seed " << seed;
    EXPECT_EQ(again.mesh.faces, canonical.mesh.faces) << "seed " << seed;
  }
}

}  // namespace
}  // namespace ramcdb::chartify::test
