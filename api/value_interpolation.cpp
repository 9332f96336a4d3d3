#include "api/value_interpolation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

namespace ramcdb::detail {
namespace {

using Vector = std::array<double, 3>;

Vector vector_of(LatticePoint p) { return {double(p.x), double(p.y), double(p.z)}; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The closest of some points, by a tree of halves along the longest axis.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<std::pair<Vector, std::uint32_t>> points) : points_(std::move(points)) {
    axis_.resize(points_.size());
    build(0, points_.size());
  }

  [[nodiscard]] std::uint32_t find(const Vector& p) const {
    Best best;
    search(p, 0, points_.size(), best);
    return best.id;
  }

 private:
  struct Best {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t id = kNew;
  };

  // Recursion halves the range: depth is log2 of the number of points.
  void build(std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    Vector lo = points_[first].first, hi = lo;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], points_[i].first[a]);
        hi[a] = std::max(hi[a], points_[i].first[a]);
      }
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (hi[a] - lo[a] > hi[axis] - lo[axis]) axis = a;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [axis](const auto& x, const auto& y) {
      return std::pair(x.first[axis], x.second) < std::pair(y.first[axis], y.second);
    });
    axis_[middle] = static_cast<std::uint8_t>(axis);
    build(first, middle);
    build(middle + 1, last);
  }

  void search(const Vector& p, std::size_t first, std::size_t last, Best& best) const {
    if (first == last) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto& [point, id] = points_[middle];
    const Vector apart = minus(p, point);
    const double distance = dot(apart, apart);
    if (distance < best.distance || (distance == best.distance && id < best.id)) best = {distance, id};
    const double side = apart[axis_[middle]];
    const auto near = side < 0 ? std::pair(first, middle) : std::pair(middle + 1, last);
    const auto far = side < 0 ? std::pair(middle + 1, last) : std::pair(first, middle);
    search(p, near.first, near.second, best);
    if (side * side <= best.distance) search(p, far.first, far.second, best);
  }

  std::vector<std::pair<Vector, std::uint32_t>> points_;
  std::vector<std::uint8_t> axis_;
};

/// A place on a triangle: weights of its corners, which add up to 1.
struct Place {
  std::uint32_t face = kNew;
  Vector weights{};

  [[nodiscard]] std::uint32_t closest_corner() const {
    return static_cast<std::uint32_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  }
};

/// The closest point of a triangle. (Ericson, Real-Time Collision Detection, section 5.1.5)
Vector closest_weights(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

/// Finds places on the surface of a region: on the triangles around the vertex that is closest.
class SurfaceLocator {
 public:
  explicit SurfaceLocator(const RegionMesh& region) : region_(region), first_(region.points.size() + 1, 0) {
    for (const Triangle& t : region.faces)
      for (const std::uint32_t v : t) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    faces_.resize(3 * region.faces.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < region.faces.size(); ++f)
      for (const std::uint32_t v : region.faces[f]) faces_[next[v]++] = f;
    std::vector<std::pair<Vector, std::uint32_t>> points;
    for (std::uint32_t v = 0; v < region.points.size(); ++v)
      if (first_[v] != first_[v + 1]) points.emplace_back(vector_of(region.points[v]), v);
    if (!points.empty()) nearest_.emplace(std::move(points));
  }

  /// Without a face where the region has none.
  [[nodiscard]] Place find(const Vector& p) const {
    Place best;
    if (!nearest_) return best;
    double least = std::numeric_limits<double>::infinity();
    const std::uint32_t vertex = nearest_->find(p);
    for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
      const Triangle& t = region_.faces[faces_[i]];
      const Vector a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      const Vector weights = closest_weights(p, a, b, c);
      Vector apart = p;
      for (std::size_t k = 0; k < 3; ++k) apart[k] -= weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k];
      if (const double distance = dot(apart, apart); distance < least) {
        least = distance;
        best = {faces_[i], weights};
      }
    }
    if (best.face == kNew) best = {faces_[first_[vertex]], {1, 0, 0}};
    return best;
  }

 private:
  [[nodiscard]] Vector corner(const Triangle& t, std::size_t i) const { return vector_of(region_.points[t[i]]); }

  const RegionMesh& region_;
  std::vector<std::uint32_t> first_, faces_;  ///< faces around each vertex
  std::optional<NearestPoint> nearest_;
};

/// Writes the value at a place, from those of the three corners of its face.
void blend(const AttributeInfo& info, const std::array<const double*, 3>& corners, const Place& place,
           std::span<double> value) {
  const double* closest = corners[place.closest_corner()];
  const bool absent = std::ranges::any_of(corners, [](const double* v) { return std::isnan(*v); });
  if (!is_float(info.type) || info.meaning == Meaning::material || info.meaning == Meaning::group || absent) {
    std::copy_n(closest, value.size(), value.begin());
    return;
  }
  double length = 0;
  for (std::size_t k = 0; k < value.size(); ++k) {
    value[k] = 0;
    for (std::size_t i = 0; i < 3; ++i) value[k] += place.weights[i] * corners[i][k];
    length += value[k] * value[k];
  }
  const auto as_kept = [&](double v) { return info.type == NumberType::float32 ? double(static_cast<float>(v)) : v; };
  const double scale = info.meaning == Meaning::normal && length > 0 ? 1 / std::sqrt(length) : 1;
  for (double& v : value) v = as_kept(v * scale);
}

class Interpolation {
 public:
  Interpolation(const RegionMesh& region, EditedRegion& edited) : region_(region), edited_(edited), surface_(region) {}

  std::uint64_t run() {
    for (std::size_t a = 0; a < region_.attributes.size(); ++a) {
      switch (region_.attributes[a].info.of) {
        case AttributeOf::vertex:
          fill_vertices(a);
          break;
        case AttributeOf::corner:
          fill_corners(a);
          break;
        case AttributeOf::face:
          fill_faces(a);
      }
    }
    return count_;
  }

 private:
  [[nodiscard]] std::span<double> value(std::size_t a, std::size_t at) {
    const std::size_t components = region_.attributes[a].info.components;
    return std::span(edited_.mesh.attributes[a].values).subspan(at * components, components);
  }
  [[nodiscard]] const double* given(std::size_t a, std::size_t at) const {
    return region_.attributes[a].values.data() + at * region_.attributes[a].info.components;
  }
  [[nodiscard]] static bool is_open(std::span<const double> value) {
    return std::ranges::all_of(value, [](double v) { return std::isnan(v); });
  }

  void fill_vertices(std::size_t a) {
    for (std::size_t v = 0; v < edited_.vertex_source.size(); ++v) {
      if (edited_.vertex_source[v] != kNew || !is_open(value(a, v))) continue;
      const Place place = surface_.find(vector_of(edited_.mesh.points[v]));
      if (place.face == kNew) continue;
      const Triangle& t = region_.faces[place.face];
      blend(region_.attributes[a].info, {given(a, t[0]), given(a, t[1]), given(a, t[2])}, place, value(a, v));
      ++count_;
    }
  }

  [[nodiscard]] Vector centre(std::size_t f) const {
    Vector sum{};
    for (const std::uint32_t v : edited_.mesh.faces[f])
      for (std::size_t k = 0; k < 3; ++k) sum[k] += vector_of(edited_.mesh.points[v])[k] / 3;
    return sum;
  }

  /// Corners look a little towards the middle of their face, so that at a seam they find its own side.
  void fill_corners(std::size_t a) {
    for (std::size_t f = 0; f < edited_.face_source.size(); ++f) {
      if (edited_.face_source[f] != kNew) continue;
      const Vector middle = centre(f);
      for (std::size_t i = 0; i < 3; ++i) {
        if (!is_open(value(a, 3 * f + i))) continue;
        Vector p = vector_of(edited_.mesh.points[edited_.mesh.faces[f][i]]);
        for (std::size_t k = 0; k < 3; ++k) p[k] += (middle[k] - p[k]) / 16;
        const Place place = surface_.find(p);
        if (place.face == kNew) continue;
        const std::size_t corner = 3 * std::size_t{place.face};
        blend(region_.attributes[a].info, {given(a, corner), given(a, corner + 1), given(a, corner + 2)}, place,
              value(a, 3 * f + i));
        ++count_;
      }
    }
  }

  void fill_faces(std::size_t a) {
    for (std::size_t f = 0; f < edited_.face_source.size(); ++f) {
      if (edited_.face_source[f] != kNew || !is_open(value(a, f))) continue;
      const Place place = surface_.find(centre(f));
      if (place.face == kNew) continue;
      std::copy_n(given(a, place.face), region_.attributes[a].info.components, value(a, f).begin());
      ++count_;
    }
  }

  const RegionMesh& region_;
  EditedRegion& edited_;
  SurfaceLocator surface_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::uint64_t interpolate_new(const RegionMesh& region, EditedRegion& edited) {
  const auto is_new = [](std::uint32_t source) { return source == kNew; };
  if (region.attributes.empty() ||
      (std::ranges::none_of(edited.vertex_source, is_new) && std::ranges::none_of(edited.face_source, is_new)))
    return 0;
  return Interpolation(region, edited).run();
}

}  // namespace ramcdb::detail
