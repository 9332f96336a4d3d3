#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>

namespace ramcdb {

/// A point in model units.
struct Point {
  double x = 0, y = 0, z = 0;

  double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Point&, const Point&) = default;
};

/// A point of a mesh's integer lattice; only `Lattice` converts it to and from model units.
struct LatticePoint {
  std::int32_t x = 0, y = 0, z = 0;

  std::int32_t& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  std::int32_t operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

/// Lattice coordinates stay within +-kMaxLatticeCoordinate, so that differences fit int32 and sums of a few
/// coordinates never overflow. Snapping refuses more.
inline constexpr std::int32_t kMaxLatticeCoordinate = (1 << 30) - 1;

/// A closed box of lattice points; empty when lo > hi on the x axis, as a new one is.
struct LatticeBox {
  LatticePoint lo{1, 1, 1};
  LatticePoint hi{0, 0, 0};

  [[nodiscard]] bool empty() const { return lo.x > hi.x; }
  void add(LatticePoint p) {
    if (empty()) {
      lo = hi = p;
      return;
    }
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  }
  void add(const LatticeBox& other) {
    if (other.empty()) return;
    add(other.lo);
    add(other.hi);
  }
  [[nodiscard]] bool contains(LatticePoint p) const {
    for (int a = 0; a < 3; ++a)
      if (p[a] < lo[a] || p[a] > hi[a]) return false;
    return !empty();
  }
  friend bool operator==(const LatticeBox&, const LatticeBox&) = default;
};

/// A triangle as three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// The integer grid of one mesh: p = origin + i * step, evaluated in double precision. Positions are snapped to it
/// once, on entry; everything inside the repository is integers.
///
/// Decimal fractions are no doubles: 7 * 0.001 is not the double that "0.007" reads as. A lattice of them has a whole
/// number of steps per unit instead, p = (origin * steps_per_unit + i) / steps_per_unit with a whole first product:
/// then each p is the double that is nearest to the decimal number.
struct Lattice {
  Point origin;
  double step = 1;
  double steps_per_unit = 0;  ///< not 0: step is 1 / steps_per_unit, and origin a multiple of it

  /// Nearest lattice point (halves round up). Throws limit_exceeded outside +-kMaxLatticeCoordinate and
  /// invalid_argument for coordinates that are not finite.
  [[nodiscard]] LatticePoint snap(const Point& p) const;
  [[nodiscard]] std::int32_t snap(double coordinate, int axis) const;

  /// The model position of a lattice point.
  [[nodiscard]] Point position(LatticePoint i) const;

  friend bool operator==(const Lattice&, const Lattice&) = default;
};

}  // namespace ramcdb
