#pragma once

#include <cstdint>
#include <vector>

#include "api/surface.h"

namespace ramcdb::detail {

/// A surface renumbered so that neighbours have near numbers: vertices along a curve through space, faces by their
/// first vertices. Equal things keep their order, and faces their corners'.
struct LocalOrder {
  std::vector<std::uint32_t> vertex, face;  ///< what each vertex and face was before
  std::vector<LatticePoint> points;
  std::vector<std::uint32_t> corners, firsts;

  [[nodiscard]] Surface surface() const { return {points, corners, firsts}; }
};

/// Whether so many faces have vertices far apart in memory that walking over them waits for memory above all.
[[nodiscard]] bool is_scattered(const Surface& surface);
[[nodiscard]] LocalOrder in_local_order(const Surface& surface);

}  // namespace ramcdb::detail
