#pragma once

#include <cstdint>
#include <span>

#include "api/region_match.h"

namespace ramcdb::detail {

/// How far float32 may put numbers off that are no larger than `largest`: its rounding, twice. A program may round on
/// reading and again on writing.
[[nodiscard]] double float32_loss(double largest);
/// The same for text of so many significant digits.
[[nodiscard]] double decimal_loss(int digits, double largest);
/// The same for the numbers that a file has in place of the original ones, both relative to its local origin: float32
/// or few digits, as the numbers themselves tell. 0 where the original numbers could have been written as they were.
[[nodiscard]] double coordinate_loss(std::span<const Point> original, std::span<const Point> written);

struct SnappedBack {
  std::uint64_t vertices = 0;
  double largest = 0;  ///< distance along an axis, model units
};

/// Puts vertices of the outer border that are no further than `tolerance` (model units, along each axis) from where the
/// region has them back there, to the last bit. Others stay.
/// \param positions, points per vertex of the other mesh that `match` is of, as in OtherMesh
SnappedBack snap_back_border(const RegionMesh& region, const Lattice& lattice, const RegionMatch& match,
                             double tolerance, std::span<Point> positions, std::span<LatticePoint> points);

}  // namespace ramcdb::detail
