#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::detail {

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

/// For every face of the one surface the face of the other that is the same, and how far its corners are turned:
/// corner i of `from` is corner (i + turn) % size of face `face`.
struct FaceMatch {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t face = kNone;
  std::uint32_t turn = 0;
};

struct Matching {
  std::vector<FaceMatch> matches;  ///< per face of `from`
  std::uint64_t unmatched = 0;
  std::uint32_t first_unmatched = FaceMatch::kNone;
};

/// Finds which faces of two surfaces are the same when one was renumbered, and some of its vertices moved. Faces whose
/// positions stand once in each surface are the same; from there the match walks over shared edges, in lock-step,
/// so that moved vertices are recognized by their neighbourhood; where no whole face stayed in place, single edges do.
/// Surfaces with equally many faces only.
[[nodiscard]] Matching match_faces(const Surface& from, const Surface& to);

}  // namespace ramcdb::detail
