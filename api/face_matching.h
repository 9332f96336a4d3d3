#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// A triangle surface to match: faces over points. Faces may share vertices or not (a soup).
struct Surface {
  std::span<const LatticePoint> points;
  std::span<const Triangle> faces;
};

/// For every face of the one surface the face of the other that is the same, and how far its corners are turned:
/// corner i of `from` is corner (i + turn) % 3 of face `face`.
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
/// three positions stand once in each surface are the same; from there the match walks over shared edges, in lock-step,
/// so that moved vertices are recognized by their neighbourhood; where no whole face stayed in place, single edges do.
/// Surfaces with equally many faces only.
[[nodiscard]] Matching match_faces(const Surface& from, const Surface& to);

}  // namespace ramcdb::detail
