#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "codec/dense_surface.h"
#include "codec/tables.h"

namespace ramcdb::codec {

/// Where a new vertex is about to appear: in the open corner of a pivot, next to the edge from `current` to the pivot.
struct FanPlace {
  std::uint32_t pivot = 0;
  std::uint32_t current = 0;             ///< the vertex before the pivot: the new vertex is in a face with both
  std::uint32_t next = 0;                ///< the vertex behind the pivot, on the far side of the corner
  std::uint32_t behind_current = kNone;  ///< third vertex of the decoded face at edge current-pivot, if there is one
  std::uint32_t behind_next = kNone;     ///< ... at edge pivot-next
  std::uint32_t edges_left = 1;          ///< edges still missing in the corner, this one included; >= 1
  double angle = 0;                      ///< of the corner, in quadrants
  Vec normal;                            ///< unit normal at the pivot
};

/// What a new vertex is guessed from, apart from weights.
struct FanVectors {
  std::array<Vec, 6> vectors;  ///< a, b, c, d, N x a, N x b of FanPrediction
  double reach = 0;            ///< |a| + |b|
  int main_axis = 0;           ///< that of the largest component of N
  std::size_t fan_class = 0, plane_class = 0;

  FanVectors(const DenseSurface& surface, const FanPlace& place);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return (main_axis + 1 + k) % 3; }
};

/// The height along `main_axis` of the tangent plane at a vertex over two known coordinates of `point`; nothing when it
/// is too steep to tell.
[[nodiscard]] std::optional<double> plane_height(const DenseVertex& vertex, int main_axis, LatticePoint point);

/// Guesses a new vertex from the fan around its pivot.
///
/// With P = pivot, a = current - P, b = next - P, c = behind_current - P, d = behind_next - P (zero when missing) and
/// the unit normal N, the guess is P + w1 a + w2 b + w3 c + w4 d + w5 N x a + w6 N x b. The weights depend on how many
/// edges are left, the angle that each of them gets, and which of c and d exist: 96 classes.
///
/// Coordinates are coded one after the other; the one that N mostly points along comes last, since the surface tells
/// most about it once the others are known: it is moved into the plane through the guess, and then by a weighted sum
/// of what the tangent planes at pivot, current and next say.
class FanPrediction {
 public:
  /// \param activity_scale multiplies lengths before they choose contexts
  FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place, double scale);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return fan_.axis(k); }
  /// The guess for coordinate axis(k). REQUIRES: the coordinates before it were given to known().
  [[nodiscard]] double guess(int k) const;
  /// Tells coordinate axis(k), which guess(k) was made for.
  void known(int k, std::int32_t coordinate);

  [[nodiscard]] LatticePoint point() const { return point_; }

  /// Contexts of coordinate axis(k): how well predictions went around here (0..15), and how long edges are (0..9).
  [[nodiscard]] int activity(int k) const { return k < 2 ? tangential_activity_ : normal_activity_; }
  [[nodiscard]] int edge_size() const { return edge_size_; }

 private:
  void choose_contexts(double scale);
  [[nodiscard]] double plane_shift(std::uint32_t vertex, double from) const;

  const DenseSurface& surface_;
  const FanPlace& place_;
  FanVectors fan_;
  const PlaneWeights& plane_weights_;
  Vec guess_;
  int tangential_activity_ = 0, normal_activity_ = 0, edge_size_ = 0;
  LatticePoint point_;
  std::array<double, 2> miss_{};  ///< coordinate less guess, not rounded, of the first two axes
};

}  // namespace ramcdb::codec
