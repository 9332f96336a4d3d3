#pragma once

#include <array>
#include <cstdint>

#include "chartify/chartify.h"

namespace ramcdb::chartify {

/// Three times the centroid of a face, exactly.
[[nodiscard]] inline std::array<std::int64_t, 3> corner_sum(const IndexedMesh& mesh, std::uint32_t face) {
  std::array<std::int64_t, 3> sum{};
  for (const std::uint32_t v : mesh.faces[face]) {
    const LatticePoint p = mesh.positions[v];
    sum[0] += p.x;
    sum[1] += p.y;
    sum[2] += p.z;
  }
  return sum;
}

/// A Hilbert curve through a box of lattice points: cubes, 2^16 a side.
class HilbertCurve {
 public:
  explicit HilbertCurve(const LatticeBox& box);

  /// Where a triangle's middle is. REQUIRES: inside the box
  [[nodiscard]] std::uint64_t key(LatticePoint a, LatticePoint b, LatticePoint c) const {
    return key({std::int64_t{a.x} + b.x + c.x, std::int64_t{a.y} + b.y + c.y, std::int64_t{a.z} + b.z + c.z});
  }
  /// Of a point, times 3.
  [[nodiscard]] std::uint64_t key(const std::array<std::int64_t, 3>& sum) const;

 private:
  std::array<std::int64_t, 3> low_{};
  int shift_ = 0;
};

/// Where the faces and vertices of a mesh lie along a Hilbert curve through its box.
class HilbertCells {
 public:
  explicit HilbertCells(const IndexedMesh& mesh);

  [[nodiscard]] std::uint64_t key_of_face(std::uint32_t face) const { return curve_.key(corner_sum(mesh_, face)); }
  [[nodiscard]] std::uint64_t key_of_vertex(std::uint32_t vertex) const {
    const LatticePoint p = mesh_.positions[vertex];
    return curve_.key(p, p, p);
  }

 private:
  const IndexedMesh& mesh_;
  HilbertCurve curve_;
};

}  // namespace ramcdb::chartify
