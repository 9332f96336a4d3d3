#include "api/surface.h"

namespace ramcdb::detail {

TriangleCorners::TriangleCorners(std::span<const Triangle> faces) : firsts_{0} {
  corners_.reserve(3 * faces.size());
  for (const Triangle& t : faces) {
    corners_.insert(corners_.end(), t.begin(), t.end());
    firsts_.push_back(static_cast<std::uint32_t>(corners_.size()));
  }
}

Rings::Rings(const Surface& surface)
    : surface_(surface),
      firsts_(surface.points.size() + 2, 0),
      corners_(surface.corners.size()),
      face_(surface.corners.size()) {
  // Shifted by one while it counts and fills, so that each entry ends where its vertex begins.
  for (const std::uint32_t v : surface.corners) ++firsts_[v + 2];
  for (std::size_t v = 2; v < firsts_.size(); ++v) firsts_[v] += firsts_[v - 1];
  for (std::uint32_t c = 0; c < surface.corners.size(); ++c) corners_[firsts_[surface.corners[c] + 1]++] = c;
  firsts_.pop_back();
  for (std::uint32_t f = 0; f < surface.face_count(); ++f)
    for (std::uint32_t c = surface.firsts[f]; c < surface.firsts[f + 1]; ++c) face_[c] = f;
}

Rings::Passes Rings::passes(std::uint32_t a, std::uint32_t b) const {
  Passes found;
  const bool from_a = degree(a) <= degree(b);  // the hub of a fan would be searched once per spoke
  for (const std::uint32_t c : of(from_a ? a : b)) {
    const std::uint32_t begin = from_a ? c : previous(c);
    if (surface_.corners[begin] != a || surface_.corners[next(begin)] != b) continue;
    if (found.corner == kNowhere) found.corner = begin;
    if (++found.count == 2) break;
  }
  return found;
}

}  // namespace ramcdb::detail
