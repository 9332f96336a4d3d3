#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "ramcdb/error.h"
#include "ramcdb/geometry.h"

namespace ramcdb {

namespace {

/// The shortest text of a number, in no locale.
std::string digits(double x) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

}  // namespace

std::int32_t Lattice::snap(double coordinate, int axis) const {
  const double steps = (coordinate - origin[axis]) / step;
  const double below = std::floor(steps);
  const double offset = below + (steps - below >= 0.5 ? 1 : 0);  // floor(steps + 0.5) would round twice
  if (!std::isfinite(coordinate))
    throw Error(Errc::invalid_argument, "a coordinate is not a finite number", std::string(1, "xyz"[axis]),
                "give finite coordinates");
  if (!(offset >= -kMaxLatticeCoordinate && offset <= kMaxLatticeCoordinate))
    throw Error(Errc::limit_exceeded, "a coordinate is too far away for the mesh's lattice",
                std::string(1, "xyz"[axis]) + " = " + digits(coordinate), "stay within 2^30 steps of its origin");
  return static_cast<std::int32_t>(offset);
}

LatticePoint Lattice::snap(const Point& p) const { return {snap(p.x, 0), snap(p.y, 1), snap(p.z, 2)}; }

Point Lattice::position(LatticePoint i) const {
  if (steps_per_unit != 0) {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = (std::floor(origin[a] * steps_per_unit + 0.5) + i[a]) / steps_per_unit;
    return p;
  }
  return {origin.x + i.x * step, origin.y + i.y * step, origin.z + i.z * step};
}

}  // namespace ramcdb
