#pragma once

#include <array>
#include <cstdint>

#include "chartify/chartify.h"

namespace ramcdb::chartify {

/// Three times the centroid of a face, exactly.
[[nodiscard]] std::array<std::int64_t, 3> corner_sum(const IndexedMesh& mesh, std::uint32_t face);

/// Where the faces and vertices of a mesh lie along a Hilbert curve through its box: cubes, 2^16 a side.
class HilbertCells {
 public:
  explicit HilbertCells(const IndexedMesh& mesh);

  [[nodiscard]] std::uint64_t key_of_face(std::uint32_t face) const { return key(corner_sum(mesh_, face)); }
  [[nodiscard]] std::uint64_t key_of_vertex(std::uint32_t vertex) const;

 private:
  [[nodiscard]] std::uint64_t key(const std::array<std::int64_t, 3>& sum) const;

  const IndexedMesh& mesh_;
  std::array<std::int64_t, 3> low_{};
  int shift_ = 0;
};

}  // namespace ramcdb::chartify
