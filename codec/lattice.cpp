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

LatticePoint Lattice::snap(const Point& p) const {
  LatticePoint i;
  for (int a = 0; a < 3; ++a) {
    const double steps = (p[a] - origin[a]) / step;
    const double below = std::floor(steps);
    const double offset = below + (steps - below >= 0.5 ? 1 : 0);  // floor(steps + 0.5) would round twice
    if (!std::isfinite(p[a]))
      throw Error(Errc::invalid_argument, "a coordinate is not a finite number", std::string(1, "xyz"[a]),
                  "give finite coordinates");
    if (!(offset >= -kMaxLatticeCoordinate && offset <= kMaxLatticeCoordinate))
      throw Error(Errc::limit_exceeded, "a coordinate is too far away for the mesh's lattice",
                  std::string(1, "xyz"[a]) + " = " + digits(p[a]), "stay within 2^30 steps of its origin");
    i[a] = static_cast<std::int32_t>(offset);
  }
  return i;
}

Point Lattice::position(LatticePoint i) const {
  return {origin.x + i.x * step, origin.y + i.y * step, origin.z + i.z * step};
}

}  // namespace ramcdb
