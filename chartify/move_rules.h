#pragma once

#include <cstdint>
#include <vector>

#include "chartify/chartify.h"

namespace ramcdb::chartify {

/// Which faces may change charts, where not all may: new faces go to any chart that is open, others stay within the
/// charts that theirs was split into.
struct MoveRules {
  std::vector<std::uint32_t> home_of_face;    ///< the group of charts that a face stays in; kNone: a new face
  std::vector<std::uint32_t> group_of_chart;  ///< charts of one group were one chart
  std::vector<std::uint8_t> open;             ///< per chart whether it has new faces or was split

  [[nodiscard]] bool allow(std::uint32_t face, std::uint32_t to) const {
    return home_of_face[face] == group_of_chart[to] || (home_of_face[face] == kNone && open[to]);
  }
};

}  // namespace ramcdb::chartify
