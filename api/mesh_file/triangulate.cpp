#include <algorithm>
#include <span>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {
namespace {

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Looking for ears takes quadratic time, in polygons without ears cubic. So many comparisons are for all polygons of a
/// mesh together (and kStepsPerCorner more each); hostile ones beyond become fans.
constexpr std::uint64_t kMostSteps = std::uint64_t{1} << 32, kStepsPerCorner = 64;

/// Cuts one polygon into triangles: repeatedly the first corner that turns left and has no other corner inside its
/// ear. Where no ear is left (a polygon that crosses itself, touches itself, or is without area) a corner goes that
/// turns neither way, and where there is none of these either, the first.
class EarClipper {
 public:
  EarClipper(const std::vector<Point>& positions, std::span<const std::uint32_t> polygon, std::uint64_t& steps)
      : positions_(positions), left_(polygon.begin(), polygon.end()), steps_(steps) {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Point n = cross(at(i) - at(0), at(i + 1) - at(0));
      normal_ = {normal_.x + n.x, normal_.y + n.y, normal_.z + n.z};
    }
  }

  /// False when the steps ran out and the rest became a fan.
  bool clip(std::vector<std::uint32_t>& corners) {
    std::size_t from = 0;
    while (left_.size() > 3) {
      if (!steps_) {
        fan(corners);
        return false;
      }
      const std::size_t ear = find_ear(from);
      cut(ear, corners);
      from = ear ? ear - 1 : 0;
    }
    corners.insert(corners.end(), left_.begin(), left_.end());
    return true;
  }

 private:
  const Point& at(std::size_t i) const { return positions_[left_[i % left_.size()]]; }

  /// Positive where corner i turns left, with its neighbours.
  double turn(std::size_t i) const {
    const Point &a = at(i + left_.size() - 1), &b = at(i), &c = at(i + 1);
    return dot(cross(b - a, c - b), normal_);
  }

  std::size_t find_ear(std::size_t from) const {
    const std::size_t n = left_.size();
    for (std::size_t k = 0; k < n; ++k)
      if (is_ear((from + k) % n)) return (from + k) % n;
    for (std::size_t k = 0; k < n; ++k)
      if (turn((from + k) % n) == 0) return (from + k) % n;
    return from % n;
  }

  /// Whether corner i with its two neighbours is a triangle that nothing else of the polygon lies in.
  bool is_ear(std::size_t i) const {
    const std::size_t n = left_.size();
    const bool turns_left = turn(i) > 0;
    steps_ -= std::min<std::uint64_t>(steps_, turns_left ? n : 1);
    if (!turns_left) return false;
    const Point &a = at(i + n - 1), &b = at(i), &c = at(i + 1);
    for (std::size_t j = i + 2; j < i + n - 1; ++j) {
      const Point& p = at(j);
      if (p == a || p == b || p == c) continue;
      if (dot(cross(b - a, p - a), normal_) >= 0 && dot(cross(c - b, p - b), normal_) >= 0 &&
          dot(cross(a - c, p - c), normal_) >= 0)
        return false;
    }
    return true;
  }

  void fan(std::vector<std::uint32_t>& corners) const {
    for (std::size_t i = 2; i < left_.size(); ++i) corners.insert(corners.end(), {left_[0], left_[i - 1], left_[i]});
  }

  void cut(std::size_t ear, std::vector<std::uint32_t>& corners) {
    const std::size_t n = left_.size();
    corners.insert(corners.end(), {left_[(ear + n - 1) % n], left_[ear], left_[(ear + 1) % n]});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
  }

  const std::vector<Point>& positions_;
  std::vector<std::uint32_t> left_;
  Point normal_;
  std::uint64_t& steps_;
};

}  // namespace

std::uint64_t triangulate(MeshData& mesh) {
  if (mesh.face_sizes.empty()) return 0;
  std::uint64_t cut = 0, fanned = 0, steps = kMostSteps + kStepsPerCorner * mesh.corners.size();
  std::vector<std::uint32_t> corners;
  corners.reserve(mesh.corners.size());
  std::size_t begin = 0;
  for (const std::uint32_t size : mesh.face_sizes) {
    const auto polygon = std::span(mesh.corners).subspan(begin, size);
    if (size == 3)
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    else
      fanned += !EarClipper(mesh.positions, polygon, steps).clip(corners);
    cut += size > 3;
    begin += size;
  }
  mesh.corners = std::move(corners);
  mesh.face_sizes.clear();
  if (fanned) mesh.dropped.push_back({"outlines of polygons that take too long to cut (made fans)", fanned});
  return cut;
}

}  // namespace ramcdb::mesh_file
