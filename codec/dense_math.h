#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "codec/vectors.h"
#include "ramcdb/geometry.h"

/// Arithmetic of the dense coder. Encoder and decoder must round alike on every machine, so only + - * / and sqrt of
/// 32-bit floats are used, which IEEE 754 fixes to the last bit, and comparisons; no angle functions, no fused
/// multiply-add. Vectors are four lanes that the compiler keeps in one register where there are such.
namespace ramcdb::codec {

class Vec {
 public:
  constexpr Vec() = default;
  constexpr Vec(float x, float y, float z) : lanes_{x, y, z, 0} {}
  /// The fourth lane is never looked at.
  explicit constexpr Vec(Float4 lanes) : lanes_(lanes) {}

  float operator[](int axis) const { return lanes_[axis]; }

  friend Vec operator+(Vec a, Vec b) { return Vec(a.lanes_ + b.lanes_); }
  friend Vec operator-(Vec a, Vec b) { return Vec(a.lanes_ - b.lanes_); }
  friend Vec operator*(Vec a, float s) { return Vec(a.lanes_ * Float4{s, s, s, s}); }
  friend float dot(Vec a, Vec b) {
    const Float4 products = a.lanes_ * b.lanes_;
    return products[0] + products[1] + products[2];
  }
  friend Vec cross(Vec a, Vec b) { return Vec(turned(a.lanes_ * turned(b.lanes_) - turned(a.lanes_) * b.lanes_)); }

  /// Per lane, how far apart they are.
  friend Vec distances(Vec a, Vec b) {
    const Float4 d = a.lanes_ - b.lanes_;
    return Vec(d < 0 ? -d : d);
  }
  [[nodiscard]] friend Vec larger(Vec a, Vec b) { return Vec(a.lanes_ > b.lanes_ ? a.lanes_ : b.lanes_); }

 private:
  /// y, z, x.
  static Float4 turned(Float4 v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }

  Float4 lanes_{};
};

inline float squared_length(Vec a) { return dot(a, a); }

/// The sizes of all coordinates together.
inline float extent(Vec a) { return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]); }

/// From one lattice point to another: exact below 2^24, rounded beyond.
inline Vec difference(Int4 to, Int4 from) { return Vec(__builtin_convertvector(to - from, Float4)); }
inline Vec difference(LatticePoint to, LatticePoint from) {
  return difference(Int4{to.x, to.y, to.z, 0}, Int4{from.x, from.y, from.z, 0});
}

/// `v` at length one, or `otherwise` when it has no length.
inline Vec unit_or(Vec v, Vec otherwise) {
  const float squared = squared_length(v);
  return squared > 0 ? v * (1 / std::sqrt(squared)) : otherwise;
}

/// The size of x >= 0 in half octaves: 0 below 1, then 1 for [1, 1.5), 2 for [1.5, 2), 3 for [2, 3) ...
inline std::size_t half_octave(float x) {
  if (!(x >= 1)) return 0;
  return (std::bit_cast<std::uint32_t>(x) >> 22) - (2 * 127 - 1);
}

/// floor(x + 1/2), the sum rounded. REQUIRES: |x| < 2^31.
inline std::int32_t round_half_up(float x) {
  const float up = x + 0.5F;
  const auto whole = static_cast<std::int32_t>(up);
  return whole - (up < static_cast<float>(whole) ? 1 : 0);
}

/// The number of a 16th of a quadrant, and where in it, from the square of a cosine.
namespace dense_math_detail {

/// 512 (1 - c |c|) for c the cosine of k/16 quadrants, k = 0 .. 31, rounded.
inline constexpr std::array<std::uint16_t, 33> kLimits{0,   5,   19,  43,  75,  114, 158, 206, 256,  306,  354,
                                                       398, 437, 469, 493, 507, 512, 517, 531, 555,  587,  626,
                                                       670, 718, 768, 818, 866, 910, 949, 981, 1005, 1019, 1025};
/// Angles in 1/1024 quadrant: exact at those limits, in between as if straight.
inline constexpr auto kAngles = [] {
  std::array<std::uint16_t, 1025> table{};
  for (std::size_t i = 0, k = 0; i < table.size(); ++i) {
    while (i >= kLimits[k + 1]) ++k;
    table[i] = static_cast<std::uint16_t>(64 * k + 32 * (2 * (i - kLimits[k]) + 1) / (kLimits[k + 1] - kLimits[k]));
  }
  return table;
}();

}  // namespace dense_math_detail

/// A whole turn of corner_angle().
inline constexpr std::uint32_t kWholeTurn = 4096;

/// The angle, in 1/1024 of a quadrant, by which `from` must turn counter-clockwise about `normal` to point along `to`;
/// 0 when one of them has no length. Its size is that in space, the normal only decides which way round. Without roots,
/// from the square of its cosine alone: good to a few degrees, which is all that an order of corners needs.
inline std::uint32_t corner_angle(Vec from, Vec to, Vec normal) {
  const float lengths = squared_length(from) * squared_length(to);
  if (!(lengths > 0)) return 0;
  const float d = dot(from, to);
  const float place = 512 - 512 * (d * std::abs(d) / lengths);
  const auto at = static_cast<std::size_t>(static_cast<int>(std::min(std::max(place, 0.0F), 1024.0F)));
  const std::uint32_t angle = dense_math_detail::kAngles[at];
  return angle ^ ((kWholeTurn - 1) * (dot(normal, cross(from, to)) < 0));  // a whole turn less that, or itself
}

}  // namespace ramcdb::codec
