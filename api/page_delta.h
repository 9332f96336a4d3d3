#pragma once

#include <map>
#include <set>

#include "ramcdb/wire_net.h"

namespace ramcdb::detail {

/// What becomes of the members of a mesh's index pages. A version of 0 in what is put means the version that puts it.
struct PageDelta {
  std::map<ChartId, PageChart> charts;  ///< put: of ids that the index holds, and new ones
  std::map<ChartId, ChartId> beside;    ///< for each new one a chart of the index in whose page it goes
  std::set<ChartId> removed;
  std::map<WireId, PageWire> wires;  ///< put; wires that no chart passes any more go by themselves, and so do corners
  std::map<CornerId, LatticePoint> corners;  ///< put
  /// Further charts of the index in whose pages wires or corners are that were put.
  std::set<ChartId> neighbours;

  [[nodiscard]] bool empty() const { return charts.empty() && removed.empty() && wires.empty() && corners.empty(); }
};

}  // namespace ramcdb::detail
