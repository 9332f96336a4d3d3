#pragma once

#include <cstdint>

/// Directions as points of the unit octahedron, unfolded into a square (Meyer et al., "On floating-point normal
/// vectors", 2010): x and y of the upper half (z >= 0) stand for themselves, those of the lower half are turned over
/// the edges of the square |x| + |y| = 1 into its corners. In whole numbers, 1 being kOctahedronUnit.
namespace ramcdb::codec {

inline constexpr std::int32_t kOctahedronUnit = 1 << 13;

/// A point of the unfolded square, -unit <= u, v <= unit; or, with u = v = kNoDirection, no direction: the vector 0.
/// The rim of the square stands for each of its directions twice: there the coordinate along it is not negative.
struct OctahedronPoint {
  static constexpr std::int32_t kNoDirection = -2 * kOctahedronUnit;

  std::int32_t u = 0, v = 0;

  [[nodiscard]] static constexpr OctahedronPoint none() { return {kNoDirection, kNoDirection}; }
  friend bool operator==(const OctahedronPoint&, const OctahedronPoint&) = default;
};

/// A vector of whole numbers with |x| + |y| + |z| = kOctahedronUnit; 0 for no direction.
struct OctahedronVector {
  std::int64_t x = 0, y = 0, z = 0;

  friend constexpr OctahedronVector operator+(OctahedronVector a, OctahedronVector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr OctahedronVector operator-(OctahedronVector a, OctahedronVector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

namespace octahedron_detail {

constexpr std::int32_t size(std::int32_t a) { return a < 0 ? -a : a; }

/// The same place on the other half.
constexpr OctahedronPoint turned_over(OctahedronPoint p) {
  const std::int32_t u = kOctahedronUnit - size(p.v), v = kOctahedronUnit - size(p.u);
  return {p.u < 0 ? -u : u, p.v < 0 ? -v : v};
}

}  // namespace octahedron_detail

/// Of the two points on the rim that are one direction, that which stands for it.
[[nodiscard]] constexpr OctahedronPoint without_twins(OctahedronPoint p) {
  using octahedron_detail::size;
  if (size(p.u) == kOctahedronUnit) p.v = size(p.v);
  if (size(p.v) == kOctahedronUnit) p.u = size(p.u);
  return p;
}

/// That `p` is on the square, or no direction.
[[nodiscard]] constexpr bool in_octahedron_square(OctahedronPoint p) {
  using octahedron_detail::size;
  return p == OctahedronPoint::none() || (size(p.u) <= kOctahedronUnit && size(p.v) <= kOctahedronUnit);
}

[[nodiscard]] constexpr bool is_octahedron_point(OctahedronPoint p) {
  return in_octahedron_square(p) && without_twins(p) == p;
}

[[nodiscard]] constexpr bool in_lower_half(OctahedronPoint p) {
  return octahedron_detail::size(p.u) + octahedron_detail::size(p.v) > kOctahedronUnit;
}

/// Undoes the unfolding. `p` is a point of the square, on its rim of either kind.
[[nodiscard]] constexpr OctahedronVector octahedron_vector(OctahedronPoint p) {
  if (p == OctahedronPoint::none()) return {};
  const std::int64_t z = kOctahedronUnit - octahedron_detail::size(p.u) - octahedron_detail::size(p.v);
  if (z < 0) p = octahedron_detail::turned_over(p);
  return {p.u, p.v, z};
}

/// The point in the direction of a vector of numbers up to 2^40, rounded towards the axes; none() for 0.
[[nodiscard]] constexpr OctahedronPoint octahedron_point(OctahedronVector d) {
  const auto size = [](std::int64_t a) { return a < 0 ? -a : a; };
  const std::int64_t sum = size(d.x) + size(d.y) + size(d.z);
  if (sum == 0) return OctahedronPoint::none();
  const OctahedronPoint p{static_cast<std::int32_t>(d.x * kOctahedronUnit / sum),
                          static_cast<std::int32_t>(d.y * kOctahedronUnit / sum)};
  return without_twins(d.z < 0 ? octahedron_detail::turned_over(p) : p);
}

/// `p` as seen from `guess`: where that is on the lower half, with both halves changed for each other, so that places
/// near the guess are near it in the square, too. Its own inverse, but for twins on the rim.
[[nodiscard]] constexpr OctahedronPoint seen_from(OctahedronPoint guess, OctahedronPoint p) {
  if (guess == OctahedronPoint::none() || p == OctahedronPoint::none() || !in_lower_half(guess)) return p;
  return octahedron_detail::turned_over(p);
}

}  // namespace ramcdb::codec
