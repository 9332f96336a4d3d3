#include <algorithm>
#include <numeric>
#include <tuple>

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
  /// \param first the polygon's first position in `mesh.corners`
  EarClipper(const MeshData& mesh, std::uint32_t first, std::uint32_t size, std::uint64_t& steps)
      : mesh_(mesh), left_(size), steps_(steps) {
    std::iota(left_.begin(), left_.end(), first);
    std::rotate(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(least_turn()), left_.end());
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Point n = cross(at(i) - at(0), at(i + 1) - at(0));
      normal_ = {normal_.x + n.x, normal_.y + n.y, normal_.z + n.z};
    }
  }

  /// False when the steps ran out and the rest became a fan.
  bool clip(std::vector<Triangle>& triangles) {
    std::size_t from = 0;
    while (left_.size() > 3) {
      if (!steps_) {
        fan(triangles);
        return false;
      }
      const std::size_t ear = find_ear(from);
      cut(ear, triangles);
      from = ear ? ear - 1 : 0;
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return true;
  }

 private:
  /// Polygons are cut alike wherever they begin: from the least sequence of positions on.
  [[nodiscard]] std::size_t least_turn() const {
    const auto key = [](const Point& p) { return std::tie(p.x, p.y, p.z); };
    std::size_t best = 0;
    for (std::size_t turn = 1; turn < left_.size(); ++turn)
      for (std::size_t i = 0; i < left_.size() && steps_ > 0; ++i, --steps_) {
        const Point &p = at(turn + i), &q = at(best + i);
        if (p == q) continue;
        if (key(p) < key(q)) best = turn;
        break;
      }
    return best;
  }
  const Point& at(std::size_t i) const { return mesh_.positions[mesh_.corners[left_[i % left_.size()]]]; }

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

  void fan(std::vector<Triangle>& triangles) const {
    for (std::size_t i = 2; i < left_.size(); ++i) triangles.push_back({left_[0], left_[i - 1], left_[i]});
  }

  void cut(std::size_t ear, std::vector<Triangle>& triangles) {
    const std::size_t n = left_.size();
    triangles.push_back({left_[(ear + n - 1) % n], left_[ear], left_[(ear + 1) % n]});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
  }

  const MeshData& mesh_;
  std::vector<std::uint32_t> left_;  ///< positions in mesh_.corners
  Point normal_;
  std::uint64_t& steps_;
};

}  // namespace

Triangulation triangulate(const MeshData& mesh) {
  Triangulation cut;
  cut.corners.reserve(mesh.corners.size() / 3);
  std::uint64_t steps = kMostSteps + kStepsPerCorner * mesh.corners.size();
  std::uint32_t first = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    if (size == 3) {
      cut.corners.push_back({first, first + 1, first + 2});
    } else {
      ++cut.polygons;
      cut.fans += !EarClipper(mesh, first, size, steps).clip(cut.corners);
    }
    cut.face.resize(cut.corners.size(), f);
    first += size;
  }
  return cut;
}

}  // namespace ramcdb::mesh_file
