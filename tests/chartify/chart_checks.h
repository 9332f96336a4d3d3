#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chartify/chartify.h"
#include "tests/support/meshes.h"

/// What must hold for the charts of every mesh, and what tests of several subjects need.
namespace ramcdb::chartify::test {

/// The representative of a union of numbers; shortens the way there.
[[nodiscard]] std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i);

/// A test mesh on a lattice of 16 bits, in canonical order.
[[nodiscard]] IndexedMesh canonical(const ramcdb::test::TestMesh& mesh);

[[nodiscard]] std::vector<std::uint32_t> faces_of_charts(const Charts& charts);

/// Fails the running test unless every face and isolated vertex is in one chart, charts are numbered 0 .. count - 1 in
/// the order of their first faces, none is empty, and each is one piece or holds whole components.
void check_charts(const IndexedMesh& mesh, const Charts& charts);

/// Connected components over the edges that `chart_of_face` leaves whole, found without the code under test's helpers.
[[nodiscard]] std::vector<std::uint32_t> pieces(const IndexedMesh& mesh,
                                                const std::vector<std::uint32_t>& chart_of_face);

}  // namespace ramcdb::chartify::test
