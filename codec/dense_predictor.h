#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "codec/dense_models.h"
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
  std::uint32_t angle = 0;               ///< of the corner, of corner_angle()
  Vec normal;                            ///< unit normal at the pivot
};

/// The axes that come after axis i are kAxes[i], kAxes[i + 1] and, again, i = kAxes[i + 2].
inline constexpr std::array<int, 5> kAxes{1, 2, 0, 1, 2};

/// What a new vertex is guessed from, apart from weights.
struct FanVectors {
  std::array<Vec, 6> vectors;  ///< a, b, c, d, N x a, N x b of FanPrediction
  float reach = 0;             ///< the coordinates of a and b, all sizes added
  int main_axis = 0;           ///< that of the largest component of N
  std::size_t fan_class = 0, plane_class = 0;

  FanVectors(const DenseSurface& surface, const FanPlace& place);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return kAxes[static_cast<std::size_t>(main_axis + k)]; }
};

/// A plane as heights along a main axis over the coordinates x and y of the other axes, in their order.
struct HeightPlane {
  float base = 0, slope_x = 0, slope_y = 0;
  bool tells = false;  ///< whether it is flat enough to say anything

  HeightPlane(const Vec& normal, const Vec& at, int main_axis);
  [[nodiscard]] float height(float x, float y) const { return base - (slope_x * x + slope_y * y); }
};

/// Guesses a new vertex from the fan around its pivot.
///
/// With P = pivot, a = current - P, b = next - P, c = behind_current - P, d = behind_next - P (zero when missing) and
/// the unit normal N, the guess is P + w1 a + w2 b + w3 c + w4 d + w5 N x a + w6 N x b. The weights depend on how many
/// edges are left, the angle that each of them gets, and which of c and d exist: 96 classes.
///
/// Coordinates are coded one after the other; the one that N mostly points along comes last, since the surface tells
/// most about it once the others are known: it is moved into the plane through the guess, and then by a weighted sum
/// of what the tangent planes at pivot, current and next say. Everything is relative to the pivot.
///
/// Two numbers choose the models of a coordinate: how much predictions missed around here, and how much the guess is in
/// doubt: how far parallelograms would have it elsewhere or, for the last coordinate, how far the planes disagree.
class FanPrediction {
 public:
  /// \param scale multiplies lengths before they choose contexts
  FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place, float scale);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return fan_.axis(k); }
  struct Guess {
    float coordinate;   ///< less the pivot's
    std::size_t doubt;  ///< below MissModels::kDoubts
  };
  /// The guess for coordinate axis(k), k = 0, 1.
  [[nodiscard]] Guess first_guess(int k) const;
  /// The guess for coordinate axis(2), when those before are x and y, less the pivot's.
  [[nodiscard]] Guess last_guess(float x, float y) const;
  /// How well predictions of coordinate axis(k) went around here, below MissModels::kActivities.
  [[nodiscard]] std::size_t activity(int k) const { return k < 2 ? tangential_activity_ : normal_activity_; }

 private:
  void choose_activities(const DenseSurface& surface, const FanPlace& place);
  [[nodiscard]] std::size_t doubt(float apart) const {
    return std::min<std::size_t>(MissModels::kDoubts - 1, half_octave(apart * (2 * scale_)));
  }

  FanVectors fan_;
  const PlaneWeights& plane_weights_;
  Vec guess_, doubt_;
  float scale_;
  std::size_t tangential_activity_ = 0, normal_activity_ = 0;
  HeightPlane through_guess_;
  std::array<HeightPlane, 3> planes_;  ///< at pivot, current and next
};

// ---- definitions: of the innermost loop, so in the header ----

namespace dense_predictor_detail {

inline std::size_t fan_class_of(const FanPlace& place) {
  const std::uint32_t degrees = 90 * place.angle, parts = kWholeTurn / 4 * (std::min(place.edges_left, 63U) + 1);
  constexpr std::array<std::uint32_t, 7> kLimits{36, 46, 54, 62, 70, 82, 98};
  std::size_t angle_class = 0;
  for (const std::uint32_t limit : kLimits) angle_class += degrees >= limit * parts;
  return ((std::min(place.edges_left, 3u) - 1) * 8 + angle_class) * 4 + 2 * (place.behind_current != kNone) +
         (place.behind_next != kNone);
}

inline std::size_t plane_class_of(const FanPlace& place, bool pivot_on_border) {
  return (std::min(place.edges_left, 2u) - 1) * 8 + 4 * (place.behind_current != kNone) +
         2 * (place.behind_next != kNone) + pivot_on_border;
}

inline int axis_of_largest(Vec v) {
  const float x = std::abs(v[0]), y = std::abs(v[1]), z = std::abs(v[2]);
  if (x >= y) return x >= z ? 0 : 2;
  return y >= z ? 1 : 2;
}

inline constexpr float kWeightUnit = 1.0F / 128;

inline Vec weighted(const FanVectors& fan, const FanWeights& weights) {
  Vec sum;
  for (std::size_t i = 0; i < weights.size(); ++i) sum = sum + fan.vectors[i] * (weights[i] * kWeightUnit);
  return sum;
}

}  // namespace dense_predictor_detail

inline FanVectors::FanVectors(const DenseSurface& surface, const FanPlace& place)
    : main_axis(dense_predictor_detail::axis_of_largest(place.normal)),
      fan_class(dense_predictor_detail::fan_class_of(place)),
      plane_class(dense_predictor_detail::plane_class_of(place, surface.on_border(place.pivot))) {
  const DenseVertex& pivot = surface[place.pivot];
  const auto from_pivot = [&](std::uint32_t v) { return v == kNone ? Vec{} : difference(surface[v], pivot); };
  const Vec a = from_pivot(place.current), b = from_pivot(place.next);
  vectors = {a,
             b,
             from_pivot(place.behind_current),
             from_pivot(place.behind_next),
             cross(place.normal, a),
             cross(place.normal, b)};
  reach = extent(a) + extent(b);
}

inline HeightPlane::HeightPlane(const Vec& normal, const Vec& at, int main_axis) {
  const float up = normal[main_axis];
  tells = up * up * 16 > squared_length(normal);
  if (!tells) return;
  const int first = kAxes[static_cast<std::size_t>(main_axis)], second = kAxes[static_cast<std::size_t>(main_axis) + 1];
  const float steepness = 1 / up;
  slope_x = normal[first] * steepness;
  slope_y = normal[second] * steepness;
  base = at[main_axis] + (slope_x * at[first] + slope_y * at[second]);
}

inline FanPrediction::FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place,
                                    float scale)
    : fan_(surface, place),
      plane_weights_(tables.plane[fan_.plane_class]),
      guess_(dense_predictor_detail::weighted(fan_, tables.fan[fan_.fan_class])),
      scale_(scale),
      through_guess_(place.normal, guess_, fan_.main_axis),
      planes_{HeightPlane(surface[place.pivot].normal, {}, fan_.main_axis),
              HeightPlane(surface[place.current].normal, fan_.vectors[0], fan_.main_axis),
              HeightPlane(surface[place.next].normal, fan_.vectors[1], fan_.main_axis)} {
  const auto& [a, b, c, d, across_a, across_b] = fan_.vectors;
  if (place.behind_current != kNone) doubt_ = distances(guess_, a - c);
  if (place.edges_left == 1) {
    doubt_ = larger(doubt_, distances(guess_, a + b));
    if (place.behind_next != kNone) doubt_ = larger(doubt_, distances(guess_, b - d));
  }
  choose_activities(surface, place);
}

inline void FanPrediction::choose_activities(const DenseSurface& surface, const FanPlace& place) {
  float tangential = 0, normal = 0, count = 0;
  const auto consult = [&](std::uint32_t v, float weight) {
    if (v == kNone || surface[v].tangential < 0) return;
    tangential += weight * surface[v].tangential;
    normal += weight * surface[v].normal_miss;
    count += weight;
  };
  consult(place.pivot, 2);
  consult(place.current, 2);
  consult(place.next, 2);
  consult(place.behind_current, 1);
  consult(place.behind_next, 1);

  constexpr std::size_t kUnknown = MissModels::kActivities - 1;
  tangential_activity_ = normal_activity_ = kUnknown;
  if (count > 0) {
    const float mean = 4 * scale_ / count;
    tangential_activity_ = std::min<std::size_t>(kUnknown - 1, half_octave(tangential * mean));
    normal_activity_ = std::min<std::size_t>(kUnknown - 1, half_octave(normal * mean));
  }
}

namespace dense_predictor_detail {

/// Weights of a hostile table and vast lattices end here; no coordinate lies beyond.
inline float on_lattice(float coordinate) {
  constexpr auto kLimit = static_cast<float>(kMaxLatticeCoordinate);
  return std::clamp(coordinate, -kLimit, kLimit);
}

}  // namespace dense_predictor_detail

inline FanPrediction::Guess FanPrediction::first_guess(int k) const {
  return {dense_predictor_detail::on_lattice(guess_[axis(k)]), doubt(doubt_[axis(k)])};
}

inline FanPrediction::Guess FanPrediction::last_guess(float x, float y) const {
  const float from = through_guess_.height(x, y);
  float moved = from, least = 0, most = 0;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    // How far above the plane passes, never more than the fan's reach; 0 when it does not tell.
    const float shift = planes_[i].tells ? std::clamp(planes_[i].height(x, y) - from, -fan_.reach, fan_.reach) : 0;
    moved += shift * (plane_weights_[i] * dense_predictor_detail::kWeightUnit);
    least = i == 0 ? shift : std::min(least, shift);
    most = i == 0 ? shift : std::max(most, shift);
  }
  return {dense_predictor_detail::on_lattice(moved), doubt(most - least)};
}

}  // namespace ramcdb::codec
