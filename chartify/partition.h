#pragma once

#include <cstdint>
#include <vector>

#include "chartify/chartify.h"
#include "chartify/half_edge_twins.h"

namespace ramcdb::chartify {

/// The faces beyond the three edges of every face, kNone where nobody is adjacent (find_twins says when).
using Neighbours = std::vector<std::uint32_t>;
[[nodiscard]] Neighbours find_neighbours(const std::vector<HalfEdge>& twins);

/// Which chart a face belongs to, and how many faces a chart has. Faces of no chart (kNone) are left alone.
struct Partition {
  std::vector<std::uint32_t> chart_of_face;
  std::vector<std::uint32_t> sizes;

  [[nodiscard]] std::uint32_t add_chart() {
    sizes.push_back(0);
    return static_cast<std::uint32_t>(sizes.size() - 1);
  }
};

/// Sets of faces that are cut into charts each on its own; faces of no region (kNone) are left alone.
struct Regions {
  std::vector<std::uint32_t> region_of_face;
  std::vector<std::uint32_t> sizes;   ///< faces of each region
  std::vector<std::uint32_t> charts;  ///< how many charts each is to be cut into; 0: none
};

/// Connected components, numbered by their first faces; `charts` is size / target, rounded, and 0 for components of
/// less than half the target.
[[nodiscard]] Regions find_components(const Neighbours& neighbours, std::uint32_t target);

/// What hangs together within its chart, numbered by first faces; faces of no chart among themselves likewise.
struct Pieces {
  std::vector<std::uint32_t> piece_of_face;
  std::vector<std::uint32_t> sizes;
};
[[nodiscard]] Pieces find_pieces(const Neighbours& neighbours, const std::vector<std::uint32_t>& chart_of_face);

/// Numbers charts in the order of their first faces and drops empty ones.
void renumber(Partition& partition);

/// Makes charts connected: all but the largest piece of a chart join the chart around them that they share the longest
/// border with. Pieces without a chart beside them stay.
void merge_pieces(const Neighbours& neighbours, Partition& partition);

/// Errors: invalid_argument for a target out of range.
void require_target(const Options& options);

}  // namespace ramcdb::chartify
