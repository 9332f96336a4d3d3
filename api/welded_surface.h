#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/surface.h"

namespace ramcdb::detail {

/// A surface whose vertices were joined where they are one.
struct WeldedSurface {
  std::vector<std::uint32_t> node;     ///< per vertex of the surface
  std::vector<LatticePoint> points;    ///< per node
  std::vector<std::uint32_t> corners;  ///< the surface's, as nodes
  std::span<const std::uint32_t> firsts;

  [[nodiscard]] Surface surface() const { return {points, corners, firsts}; }
};

/// Joins vertices that lie on one point and, where ids are given, have equal ones.
/// \param ids per vertex; may be empty
[[nodiscard]] WeldedSurface weld_by_place(const Surface& surface, std::span<const std::uint32_t> ids = {});

}  // namespace ramcdb::detail
