#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chartify/chartify.h"

namespace ramcdb::chartify {

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// The faces beyond the three edges of every face, kNone where nobody is adjacent (find_twins says when).
using Neighbours = std::vector<std::uint32_t>;
[[nodiscard]] Neighbours find_neighbours(const IndexedMesh& mesh);

/// Which chart a face belongs to, and how many faces a chart has. Faces of no chart (kNone) are left alone.
struct Partition {
  std::vector<std::uint32_t> chart_of_face;
  std::vector<std::uint32_t> sizes;

  [[nodiscard]] std::uint32_t add_chart() {
    sizes.push_back(0);
    return static_cast<std::uint32_t>(sizes.size() - 1);
  }
};

/// Connected components, numbered by their first faces.
struct Components {
  std::vector<std::uint32_t> component_of_face;
  std::vector<std::uint32_t> sizes;
};
[[nodiscard]] Components find_components(const Neighbours& neighbours);

/// Numbers charts in the order of their first faces and drops empty ones.
void renumber(Partition& partition);

/// Called between stages with the share that is done; may throw to cancel.
using Progress = std::function<void(double)>;

}  // namespace ramcdb::chartify
