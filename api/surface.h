#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// In place of the number of a vertex, corner or face where there is none.
inline constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

/// A surface to match: polygons over points. Faces may share vertices or not (a soup).
struct Surface {
  std::span<const LatticePoint> points;
  std::span<const std::uint32_t> corners;  ///< vertices, face after face
  std::span<const std::uint32_t> firsts;   ///< where each face begins in `corners`, and the end of the last

  [[nodiscard]] std::uint32_t face_count() const { return static_cast<std::uint32_t>(firsts.size() - 1); }
  [[nodiscard]] std::uint32_t size(std::uint32_t face) const { return firsts[face + 1] - firsts[face]; }
  /// Corner i of a face, modulo its size.
  [[nodiscard]] std::uint32_t corner(std::uint32_t face, std::uint32_t i) const {
    return firsts[face] + i % size(face);
  }
  [[nodiscard]] LatticePoint point(std::uint32_t face, std::uint32_t i) const {
    return points[corners[corner(face, i)]];
  }
  [[nodiscard]] std::span<const std::uint32_t> vertices(std::uint32_t face) const {
    return corners.subspan(firsts[face], size(face));
  }
};

/// The corners of a triangle surface.
class TriangleCorners {
 public:
  explicit TriangleCorners(std::span<const Triangle> faces);
  /// Valid as long as this and `points` are.
  [[nodiscard]] Surface over(std::span<const LatticePoint> points) const { return {points, corners_, firsts_}; }

 private:
  std::vector<std::uint32_t> corners_, firsts_;
};

/// The corners around every vertex of a surface, ascending.
class Rings {
 public:
  /// `surface` is copied, what it spans must outlive this.
  explicit Rings(const Surface& surface);

  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return std::span(corners_).subspan(firsts_[vertex], degree(vertex));
  }
  [[nodiscard]] std::uint32_t degree(std::uint32_t vertex) const { return firsts_[vertex + 1] - firsts_[vertex]; }
  [[nodiscard]] std::uint32_t face(std::uint32_t corner) const { return face_[corner]; }
  /// The following corner of the same face.
  [[nodiscard]] std::uint32_t next(std::uint32_t corner) const {
    const std::uint32_t f = face_[corner];
    return corner + 1 == surface_.firsts[f + 1] ? surface_.firsts[f] : corner + 1;
  }
  [[nodiscard]] std::uint32_t previous(std::uint32_t corner) const {
    const std::uint32_t f = face_[corner];
    return corner == surface_.firsts[f] ? surface_.firsts[f + 1] - 1 : corner - 1;
  }
  /// How many faces pass from vertex a to b, counted up to two, and the corner at a of one of them.
  struct Passes {
    std::uint32_t count = 0, corner = kNowhere;
  };
  [[nodiscard]] Passes passes(std::uint32_t a, std::uint32_t b) const;

 private:
  Surface surface_;
  std::vector<std::uint32_t> firsts_, corners_, face_;
};

}  // namespace ramcdb::detail
