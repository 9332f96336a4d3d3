#include "codec/dense_predictor.h"

#include <algorithm>

#include "codec/dense_models.h"

namespace ramcdb::codec {

namespace {

std::size_t fan_class_of(const FanPlace& place) {
  const double degrees = 90 * place.angle / (place.edges_left + 1.0);
  constexpr std::array<double, 7> kLimits{36, 46, 54, 62, 70, 82, 98};
  std::size_t angle_class = 0;
  while (angle_class < kLimits.size() && degrees >= kLimits[angle_class]) ++angle_class;
  return ((std::min(place.edges_left, 3u) - 1) * 8 + angle_class) * 4 + 2 * (place.behind_current != kNone) +
         (place.behind_next != kNone);
}

std::size_t plane_class_of(const FanPlace& place, bool pivot_on_border) {
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

FanVectors::FanVectors(const DenseSurface& surface, const FanPlace& place)
    : main_axis(axis_of_largest(place.normal)),
      fan_class(fan_class_of(place)),
      plane_class(plane_class_of(place, surface.on_border(place.pivot))) {
  const LatticePoint pivot = surface[place.pivot].position;
  const auto from_pivot = [&](std::uint32_t v) { return v == kNone ? Vec{} : difference(surface[v].position, pivot); };
  const Vec a = from_pivot(place.current), b = from_pivot(place.next);
  vectors = {a,
             b,
             from_pivot(place.behind_current),
             from_pivot(place.behind_next),
             cross(place.normal, a),
             cross(place.normal, b)};
  reach = std::sqrt(squared_length(a)) + std::sqrt(squared_length(b));
}

FanPrediction::FanPrediction(const DenseSurface& surface, const CoderTables& tables, const FanPlace& place,
                             double scale)
    : surface_(surface),
      place_(place),
      fan_(surface, place),
      plane_weights_(tables.plane[fan_.plane_class]),
      guess_(difference(surface[place.pivot].position, {})) {
  const FanWeights& weights = tables.fan[fan_.fan_class];
  for (std::size_t i = 0; i < weights.size(); ++i) guess_ = guess_ + fan_.vectors[i] * (weights[i] * kWeightUnit);
  choose_contexts(scale);
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
  edge_size_ = std::clamp(half_octave(fan_.reach * scale) / 2 - 1, 0, DenseModels::kEdgeSizes - 1);
}

double FanPrediction::guess(int k) const {
  double value = guess_[axis(k)];
  if (k == 2) {
    const Vec& n = place_.normal;
    value -= (n[axis(0)] * miss_[0] + n[axis(1)] * miss_[1]) / n[fan_.main_axis];
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

/// How far above `from` the tangent plane at a vertex passes, never more than the fan's reach; 0 when it does not tell.
double FanPrediction::plane_shift(std::uint32_t vertex, double from) const {
  const std::optional<double> height = plane_height(surface_[vertex], fan_.main_axis, point_);
  return height ? std::clamp(*height - from, -fan_.reach, fan_.reach) : 0;
}

std::optional<double> plane_height(const DenseVertex& vertex, int main_axis, LatticePoint point) {
  const double up = vertex.normal[main_axis];
  if (!(up * up * 16 > squared_length(vertex.normal))) return std::nullopt;
  const int x = (main_axis + 1) % 3, y = (main_axis + 2) % 3;
  return vertex.position[main_axis] - (vertex.normal[x] * (static_cast<double>(point[x]) - vertex.position[x]) +
                                       vertex.normal[y] * (static_cast<double>(point[y]) - vertex.position[y])) /
                                          up;
}

}  // namespace ramcdb::codec
