#include "tests/fuzz/coder_input.h"

#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"

namespace ramcdb::fuzz {

const std::vector<Chart>& charts() {
  namespace samples = codec::testing;
  static const std::vector<Chart> all = [] {
    std::vector<Chart> made{{}, samples::one_triangle(), samples::wheel(12, false), samples::wheel(9, true)};
    for (const samples::TestMesh& mesh :
         {samples::torus(9, 6, 900), samples::sphere(2, 1000000), samples::terrain(7, 30, 1)}) {
      made.push_back(samples::cut(mesh));
      made.push_back(samples::cut(mesh, samples::random_region(mesh, 50, 3, 7)));
      made.push_back(made.back());
      made.back().positions.push_back({4, 5, 6});  // isolated
    }
    made.push_back(samples::triangle_soup(12));
    return made;
  }();
  return all;
}

void require_valid(std::span<const LatticePoint> positions, std::span<const Triangle> faces) {
  for (const Triangle& face : faces)
    for (const std::uint32_t v : face) require(v < positions.size(), "a face of a vertex that is none");
  for (const LatticePoint p : positions)
    for (int a = 0; a < 3; ++a)
      require(p[a] >= -kMaxLatticeCoordinate && p[a] <= kMaxLatticeCoordinate, "a vertex off the lattice");
}

}  // namespace ramcdb::fuzz
