#pragma once

#include <cstdint>
#include <span>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {

/// What looking for ears takes is counted, for all polygons of a mesh together.
class CutSteps {
 public:
  /// For so many corners more.
  void add(std::uint64_t corners) { left += kStepsPerCorner * corners; }

  std::uint64_t left = kMostSteps;

 private:
  /// It takes quadratic time, in polygons without ears cubic: hostile ones beyond all this become fans.
  static constexpr std::uint64_t kMostSteps = std::uint64_t{1} << 32, kStepsPerCorner = 64;
};

/// `triangulate` of some of a mesh's faces; `face_sizes` is empty when all are triangles.
[[nodiscard]] Triangulation triangulate(std::span<const Point> positions, std::span<const std::uint32_t> corners,
                                        std::span<const std::uint32_t> face_sizes, CutSteps& steps);
/// Of all of them.
[[nodiscard]] inline Triangulation triangulate(std::span<const Point> positions, std::span<const std::uint32_t> corners,
                                               std::span<const std::uint32_t> face_sizes) {
  CutSteps steps;
  return triangulate(positions, corners, face_sizes, steps);
}

}  // namespace ramcdb::mesh_file
