#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ramcdb/geometry.h"

/// Arithmetic of the dense coder. Encoder and decoder must round alike on every machine, so only + - * / and sqrt are
/// used, which IEEE 754 fixes to the last bit, and comparisons; no angle functions, no fused multiply-add.
namespace ramcdb::codec {

struct Vec {
  double x = 0, y = 0, z = 0;

  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double squared_length(Vec a) { return dot(a, a); }

/// From one lattice point to another. Coordinates stay below 2^30, so this is exact.
inline Vec difference(LatticePoint to, LatticePoint from) {
  return {static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y), static_cast<double>(to.z - from.z)};
}

/// `v` at length one, or `otherwise` when it has no length.
inline Vec unit_or(Vec v, Vec otherwise) {
  const double squared = squared_length(v);
  return squared > 0 ? v * (1 / std::sqrt(squared)) : otherwise;
}

/// The size of x >= 0 in half octaves: 0 below 1, then 1 for [1, 1.5), 2 for [1.5, 2), 3 for [2, 3) ...
inline int half_octave(double x) {
  if (!(x >= 1)) return 0;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return static_cast<int>(bits >> 51) - 2 * 1023 + 1;
}

/// The nearest whole number, halves up. REQUIRES: |x| < 2^31.
inline std::int32_t round_half_up(double x) {
  const double up = x + 0.5;
  const auto whole = static_cast<std::int64_t>(up);
  return static_cast<std::int32_t>(whole - (up < static_cast<double>(whole) ? 1 : 0));
}

/// The angle, in quadrants [0, 4), by which `from` must turn counter-clockwise about `normal` to point along `to`; 0
/// when one of them has no length. Its size is that in space, the normal only decides which way round. The polynomial
/// is within 0.005 quadrants of the true angle, which is all that an order of corners needs.
inline double corner_angle(Vec from, Vec to, Vec normal) {
  const double lengths = squared_length(from) * squared_length(to);
  if (!(lengths > 0)) return 0;
  const double c = dot(from, to) / std::sqrt(lengths);
  const double c2 = c * c;
  const double s = c2 < 1 ? std::sqrt(1 - c2) : 0;
  const double ac = c < 0 ? -c : c;
  const double u = 2 * (s / (s + ac)) - 1;
  const double t = 0.5 + u * (0.31831 + 0.18169 * (u * u));
  const double half_turn = c >= 0 ? t : 2 - t;  // in [0, 2]
  const double angle = dot(normal, cross(from, to)) < 0 ? 4 - half_turn : half_turn;
  return angle < 4 ? angle : 0;
}

namespace dense_math_detail {

/// 512 (1 - c |c|) for c the cosine of k/16 quadrants, k = 1 .. 31, rounded.
inline constexpr std::array<std::uint16_t, 31> kLimits{5,   19,  43,  75,  114, 158, 206, 256,  306, 354, 398,
                                                       437, 469, 493, 507, 512, 517, 531, 555,  587, 626, 670,
                                                       718, 768, 818, 866, 910, 949, 981, 1005, 1019};
inline constexpr auto kSixteenth = [] {
  std::array<std::uint8_t, 1025> table{};
  for (std::size_t i = 0, k = 0; i < table.size(); ++i) {
    while (k < kLimits.size() && i >= kLimits[k]) ++k;
    table[i] = static_cast<std::uint8_t>(k);
  }
  return table;
}();

}  // namespace dense_math_detail

/// Which sixteenth of a quadrant, 0 to 63, corner_angle() of the same lies in, but for those near a limit: without
/// roots, from the square of its cosine alone. What the queue of corners needs, which are turned to more often than
/// coded.
inline std::uint32_t corner_sixteenth(Vec from, Vec to, Vec normal) {
  const double lengths = squared_length(from) * squared_length(to);
  if (!(lengths > 0)) return 0;
  const double d = dot(from, to);
  const double place = 512 - 512 * (d * (d < 0 ? -d : d) / lengths);
  const std::uint32_t sixteenth = dense_math_detail::kSixteenth[static_cast<std::size_t>(place < 0      ? 0
                                                                                         : place > 1024 ? 1024
                                                                                                        : place)];
  return dot(normal, cross(from, to)) < 0 ? 63 - sixteenth : sixteenth;
}

}  // namespace ramcdb::codec
