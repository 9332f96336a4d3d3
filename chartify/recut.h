#pragma once

#include <cstdint>
#include <vector>

#include "chartify/partition.h"

namespace ramcdb::chartify {

/// A cut that is being changed. Charts keep their numbers until the end; those that lost all faces have size 0.
struct Recut {
  const IndexedMesh& mesh;  ///< in canonical order
  const Neighbours& neighbours;
  const Regions& components;
  std::uint32_t target;
  Partition partition;  ///< sizes count the faces of small components aboard, whose faces are of no chart meanwhile
  std::vector<std::uint32_t> into = {};   ///< per chart the one that it was merged into, itself as long as it lives
  std::vector<std::uint32_t> group = {};  ///< see MoveRules
  std::vector<std::uint8_t> open = {};    ///< see MoveRules

  std::uint32_t add_chart() {
    const std::uint32_t chart = partition.add_chart();
    into.push_back(chart);
    group.push_back(chart);
    open.push_back(0);
    return chart;
  }
  [[nodiscard]] std::uint32_t living(std::uint32_t chart) const {
    while (into[chart] != chart) chart = into[chart];
    return chart;
  }
  /// Smaller charts join others, larger ones are split; slight ones join where that makes a good chart.
  [[nodiscard]] bool is_small(std::uint64_t faces) const { return 4 * faces < target; }
  [[nodiscard]] bool is_slight(std::uint64_t faces) const { return 2 * faces <= target; }
  [[nodiscard]] bool is_large(std::uint64_t faces) const { return faces > 2ULL * target; }
};

/// A component that shares a chart with others, or is to.
struct SmallComponent {
  std::uint32_t component = 0;
  std::uint32_t first_face = 0;
  std::uint32_t chart = kNone;  ///< that it is aboard of; kNone: it waits for one
};

}  // namespace ramcdb::chartify
