#include "api/mesh_file/triangulate.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "ramcdb/error.h"

namespace ramcdb::mesh_file {
namespace {

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Cuts one polygon into triangles: repeatedly the first corner that turns left and has no other corner inside its
/// ear. Where no ear is left (a polygon that crosses itself, touches itself, or is without area) a corner goes that
/// turns neither way, and where there is none of these either, the first.
class EarClipper {
 public:
  /// The polygon of `size` corners from position `begin` of `corners` on.
  EarClipper(std::span<const Point> positions, std::span<const std::uint32_t> corners, std::size_t begin,
             std::uint32_t size, std::uint64_t& steps)
      : positions_(positions), corners_(corners), left_(size), steps_(steps) {
    std::iota(left_.begin(), left_.end(), static_cast<std::uint32_t>(begin));
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

  const Point& at(std::size_t i) const { return positions_[corners_[left_[i % left_.size()]]]; }

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

  std::span<const Point> positions_;
  std::span<const std::uint32_t> corners_;
  std::vector<std::uint32_t> left_;  ///< positions in corners_
  Point normal_;
  std::uint64_t& steps_;
};

}  // namespace

Triangulation triangulate(std::span<const Point> positions, std::span<const std::uint32_t> corners,
                          std::span<const std::uint32_t> face_sizes, CutSteps& steps) {
  if (corners.size() > 0xffffffffU)
    throw Error(Errc::limit_exceeded, "the mesh has more than 2^32 - 1 corners of faces", "", "split it");
  Triangulation cut;
  const std::size_t faces = face_sizes.empty() ? corners.size() / 3 : face_sizes.size();
  cut.corners.reserve(corners.size() - 2 * faces);
  cut.face.reserve(corners.size() - 2 * faces);
  steps.add(corners.size());
  std::size_t begin = 0;
  for (std::size_t f = 0; f < faces; ++f) {
    const std::uint32_t size = face_sizes.empty() ? 3 : face_sizes[f];
    if (size == 3) {
      const auto c = static_cast<std::uint32_t>(begin);
      cut.corners.push_back({c, c + 1, c + 2});
    } else {
      cut.fans += !EarClipper(positions, corners, begin, size, steps.left).clip(cut.corners);
      ++cut.polygons;
    }
    cut.face.resize(cut.corners.size(), static_cast<std::uint32_t>(f));
    begin += size;
  }
  return cut;
}

Triangulation triangulate(const MeshData& mesh) { return triangulate(mesh.positions, mesh.corners, mesh.face_sizes); }

std::vector<Triangle> triangles_of(const MeshData& mesh, const Triangulation& cut) {
  std::vector<Triangle> faces;
  faces.reserve(cut.corners.size());
  for (const Triangle& t : cut.corners) faces.push_back({mesh.corners[t[0]], mesh.corners[t[1]], mesh.corners[t[2]]});
  return faces;
}

}  // namespace ramcdb::mesh_file
