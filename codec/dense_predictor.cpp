#include "codec/dense_predictor.h"

#include <algorithm>

#include "codec/dense_models.h"

namespace ramcdb::codec {

namespace {

std::size_t fan_class(const FanPlace& place) {
  const double degrees = 90 * place.angle / (place.edges_left + 1.0);
  constexpr std::array<double, 7> kLimits{36, 46, 54, 62, 70, 82, 98};
  std::size_t angle_class = 0;
  while (angle_class < kLimits.size() && degrees >= kLimits[angle_class]) ++angle_class;
  return ((std::min(place.edges_left, 3u) - 1) * 8 + angle_class) * 4 + 2 * (place.behind_current != kNone) +
         (place.behind_next != kNone);
}

std::size_t plane_class(const FanPlace& place, bool pivot_on_border) {
  return (std::min(place.edges_left, 2u) - 1) * 8 + 4 * (place.behind_current != kNone) +
         2 * (place.behind_next != kNone) + pivot_on_border;
}

int axis_of_largest(Vec v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  if (x >= y) return x >= z ? 0 : 2;
  return y >= z ? 1 : 2;
}

constexpr double kWeightUnit = 1.0 / 128;

}  // namespace

FanPrediction::FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place,
                             double scale)
    : surface_(surface),
      place_(place),
      plane_weights_(tables.plane[plane_class(place, surface.on_border(place.pivot))]),
      main_axis_(axis_of_largest(place.normal)) {
  predict(tables);
  choose_contexts(scale);
}

void FanPrediction::predict(const CoderTables& tables) {
  const LatticePoint pivot = surface_[place_.pivot].position;
  const auto from_pivot = [&](std::uint32_t v) { return v == kNone ? Vec{} : difference(surface_[v].position, pivot); };
  const Vec a = from_pivot(place_.current), b = from_pivot(place_.next);
  const std::array<Vec, 6> vectors{a,
                                   b,
                                   from_pivot(place_.behind_current),
                                   from_pivot(place_.behind_next),
                                   cross(place_.normal, a),
                                   cross(place_.normal, b)};
  const FanWeights& weights = tables.fan[fan_class(place_)];
  guess_ = difference(pivot, {});
  for (std::size_t i = 0; i < vectors.size(); ++i) guess_ = guess_ + vectors[i] * (weights[i] * kWeightUnit);
  reach_ = std::sqrt(squared_length(a)) + std::sqrt(squared_length(b));
}

void FanPrediction::choose_contexts(double scale) {
  double tangential = 0, normal = 0, count = 0;
  const auto consult = [&](std::uint32_t v, double weight) {
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
    const double mean = 4 * scale / count;
    tangential_activity_ = std::min(kUnknown - 1, half_octave(tangential * mean));
    normal_activity_ = std::min(kUnknown - 1, half_octave(normal * mean));
  }
  edge_size_ = std::clamp(half_octave(reach_ * scale) / 2 - 1, 0, DenseModels::kEdgeSizes - 1);
}

double FanPrediction::guess(int k) const {
  double value = guess_[axis(k)];
  if (k == 2) {
    const Vec& n = place_.normal;
    value -= (n[axis(0)] * miss_[0] + n[axis(1)] * miss_[1]) / n[main_axis_];
    const std::array<double, 3> shifts{plane_shift(place_.pivot, value), plane_shift(place_.current, value),
                                       plane_shift(place_.next, value)};
    for (std::size_t i = 0; i < shifts.size(); ++i) value += shifts[i] * (plane_weights_[i] * kWeightUnit);
  }
  // Weights of a hostile table and vast lattices end here; no coordinate lies beyond.
  constexpr double kLimit = kMaxLatticeCoordinate;
  return std::clamp(value, -kLimit, kLimit);
}

void FanPrediction::known(int k, std::int32_t coordinate) {
  if (k < 2) miss_[static_cast<std::size_t>(k)] = coordinate - guess(k);
  point_[axis(k)] = coordinate;
}

/// How far above `from` the tangent plane at a vertex passes over the two known coordinates; 0 when it is too steep to
/// tell, and never more than the fan's reach.
double FanPrediction::plane_shift(std::uint32_t vertex, double from) const {
  const DenseVertex& v = surface_[vertex];
  const double up = v.normal[main_axis_];
  if (!(up * up * 16 > squared_length(v.normal))) return 0;
  const int x = axis(0), y = axis(1);
  const double height = v.position[main_axis_] - (v.normal[x] * (static_cast<double>(point_[x]) - v.position[x]) +
                                                  v.normal[y] * (static_cast<double>(point_[y]) - v.position[y])) /
                                                     up;
  return std::clamp(height - from, -reach_, reach_);
}

}  // namespace ramcdb::codec
