#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

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
  float angle = 0;                       ///< of the corner, in quadrants
  Vec normal;                            ///< unit normal at the pivot
};

/// The axes that come after axis i are kAxes[i], kAxes[i + 1] and, again, i = kAxes[i + 2].
inline constexpr std::array<int, 5> kAxes{1, 2, 0, 1, 2};

/// What a new vertex is guessed from, apart from weights.
struct FanVectors {
  std::array<Vec, 6> vectors;  ///< a, b, c, d, N x a, N x b of FanPrediction
  float reach = 0;             ///< |a| + |b|
  int main_axis = 0;           ///< that of the largest component of N
  std::size_t fan_class = 0, plane_class = 0;

  FanVectors(const DenseSurface& surface, const FanPlace& place);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return kAxes[static_cast<std::size_t>(main_axis + k)]; }
};

/// The height along `main_axis` of the plane through `at` with some normal, over the coordinates x and y of the other
/// axes, in their order; nothing when it is too steep to tell.
[[nodiscard]] std::optional<float> plane_height(const Vec& normal, const Vec& at, int main_axis, float x, float y);

/// Guesses a new vertex from the fan around its pivot.
///
/// With P = pivot, a = current - P, b = next - P, c = behind_current - P, d = behind_next - P (zero when missing) and
/// the unit normal N, the guess is P + w1 a + w2 b + w3 c + w4 d + w5 N x a + w6 N x b. The weights depend on how many
/// edges are left, the angle that each of them gets, and which of c and d exist: 96 classes.
///
/// Coordinates are coded one after the other; the one that N mostly points along comes last, since the surface tells
/// most about it once the others are known: it is moved into the plane through the guess, and then by a weighted sum
/// of what the tangent planes at pivot, current and next say. Everything is relative to the pivot.
class FanPrediction {
 public:
  /// \param activity_scale multiplies lengths before they choose contexts
  FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place, float scale);

  /// The axis that is coded k-th, k = 0, 1, 2.
  [[nodiscard]] int axis(int k) const { return fan_.axis(k); }
  /// The guess for coordinate axis(k), less the pivot's. REQUIRES: the coordinates before it were given to known().
  [[nodiscard]] float guess(int k) const;
  /// Tells coordinate axis(k), less the pivot's, which guess(k) was made for.
  void known(int k, std::int32_t coordinate);

  /// Contexts of coordinate axis(k): how well predictions went around here (0..15), and how long edges are (0..9).
  [[nodiscard]] int activity(int k) const { return k < 2 ? tangential_activity_ : normal_activity_; }
  [[nodiscard]] int edge_size() const { return edge_size_; }

 private:
  void choose_contexts(float scale);
  [[nodiscard]] float plane_shift(std::uint32_t vertex, const Vec& at, float from) const;

  const DenseSurface& surface_;
  const FanPlace& place_;
  FanVectors fan_;
  const PlaneWeights& plane_weights_;
  Vec guess_;
  int tangential_activity_ = 0, normal_activity_ = 0, edge_size_ = 0;
  std::array<float, 2> known_{};  ///< the first two coordinates
  std::array<float, 2> miss_{};   ///< coordinate less guess, not rounded, of the first two axes
};

// ---- definitions: of the innermost loop, so in the header ----

namespace dense_predictor_detail {

inline std::size_t fan_class_of(const FanPlace& place) {
  const float degrees = 90 * place.angle / (static_cast<float>(place.edges_left) + 1);
  constexpr std::array<float, 7> kLimits{36, 46, 54, 62, 70, 82, 98};
  std::size_t angle_class = 0;
  for (const float limit : kLimits) angle_class += degrees >= limit;
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
  reach = std::sqrt(squared_length(a)) + std::sqrt(squared_length(b));
}

inline FanPrediction::FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place,
                                    float scale)
    : surface_(surface), place_(place), fan_(surface, place), plane_weights_(tables.plane[fan_.plane_class]) {
  const FanWeights& weights = tables.fan[fan_.fan_class];
  for (std::size_t i = 0; i < weights.size(); ++i)
    guess_ = guess_ + fan_.vectors[i] * (weights[i] * dense_predictor_detail::kWeightUnit);
  choose_contexts(scale);
}

inline void FanPrediction::choose_contexts(float scale) {
  float tangential = 0, normal = 0, count = 0;
  const auto consult = [&](std::uint32_t v, float weight) {
    if (v == kNone || surface_[v].tangential < 0) return;
    tangential += weight * surface_[v].tangential;
    normal += weight * surface_[v].normal_miss;
    count += weight;
  };
  consult(place_.pivot, 2);
  consult(place_.current, 2);
  consult(place_.next, 2);
  consult(place_.behind_current, 1);
  consult(place_.behind_next, 1);

  constexpr int kUnknown = DenseModels::kActivities - 1;
  tangential_activity_ = normal_activity_ = kUnknown;
  if (count > 0) {
    const float mean = 4 * scale / count;
    tangential_activity_ = std::min(kUnknown - 1, half_octave(tangential * mean));
    normal_activity_ = std::min(kUnknown - 1, half_octave(normal * mean));
  }
  edge_size_ = std::clamp(half_octave(fan_.reach * scale) / 2 - 1, 0, DenseModels::kEdgeSizes - 1);
}

inline float FanPrediction::guess(int k) const {
  float value = guess_[axis(k)];
  if (k == 2) {
    const Vec& n = place_.normal;
    value -= (n[axis(0)] * miss_[0] + n[axis(1)] * miss_[1]) / n[fan_.main_axis];
    const std::array<float, 3> shifts{plane_shift(place_.pivot, {}, value),
                                      plane_shift(place_.current, fan_.vectors[0], value),
                                      plane_shift(place_.next, fan_.vectors[1], value)};
    for (std::size_t i = 0; i < shifts.size(); ++i)
      value += shifts[i] * (plane_weights_[i] * dense_predictor_detail::kWeightUnit);
  }
  // Weights of a hostile table and vast lattices end here; no coordinate lies beyond.
  constexpr auto kLimit = static_cast<float>(kMaxLatticeCoordinate);
  return std::clamp(value, -kLimit, kLimit);
}

inline void FanPrediction::known(int k, std::int32_t coordinate) {
  if (k < 2) {
    const auto at = static_cast<std::size_t>(k);
    known_[at] = static_cast<float>(coordinate);
    miss_[at] = known_[at] - guess_[axis(k)];
  }
}

/// How far above `from` the tangent plane at a vertex, which is at `at`, passes, never more than the fan's reach; 0
/// when it does not tell.
inline float FanPrediction::plane_shift(std::uint32_t vertex, const Vec& at, float from) const {
  const auto height = plane_height(surface_[vertex].normal, at, fan_.main_axis, known_[0], known_[1]);
  return height ? std::clamp(*height - from, -fan_.reach, fan_.reach) : 0;
}

inline std::optional<float> plane_height(const Vec& normal, const Vec& at, int main_axis, float x, float y) {
  const float up = normal[main_axis];
  if (!(up * up * 16 > squared_length(normal))) return std::nullopt;
  const int first = kAxes[static_cast<std::size_t>(main_axis)], second = kAxes[static_cast<std::size_t>(main_axis) + 1];
  return at[main_axis] - (normal[first] * (x - at[first]) + normal[second] * (y - at[second])) / up;
}

}  // namespace ramcdb::codec
