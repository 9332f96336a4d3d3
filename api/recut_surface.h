#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "api/change_set.h"
#include "api/chart_loader.h"
#include "chartify/rechart.h"

namespace ramcdb::detail {

/// The charts that an edit cuts anew, as a mesh of their own, and the wires around them that stay.
struct RecutSurface {
  std::vector<ChartId> charts;                   ///< that are cut anew, ascending
  std::vector<LoadedChart> loaded;               ///< the same, as they were
  std::unordered_map<WireId, LoadedWire> wires;  ///< that they passed

  chartify::IndexedMesh mesh;                ///< what becomes of them
  std::vector<std::uint32_t> vertex, face;   ///< of `mesh` -> of the edited region
  std::vector<std::uint32_t> chart_of_face;  ///< position in `charts`, or chartify::kNone
  std::vector<std::uint32_t> chart_of_isolated_vertex;
  std::vector<WireId> fixed_ids;  ///< of the wires that other charts pass, too
  std::vector<chartify::FixedWire> fixed;
  std::vector<std::uint32_t> corners;           ///< of `mesh`: that other charts' wires end in
  std::map<std::uint32_t, CornerId> corner_at;  ///< vertices of `mesh` that were corners
  std::set<CornerId> shared_corners;            ///< that other charts have

  chartify::IndexedMesh before;  ///< what they were
  /// `mesh` and `before` with the faces of other charts at their vertices, wherever these make a difference.
  chartify::IndexedMesh around, around_before;

  /// The path of a wire over vertices of `mesh`; empty when one of them is gone.
  [[nodiscard]] std::vector<std::uint32_t> path_of(const PageWire& wire) const;
  [[nodiscard]] bool holds(ChartId chart) const { return std::ranges::binary_search(charts, chart); }
  /// Whether only these charts pass a wire.
  [[nodiscard]] bool is_inner(const PageWire& wire) const {
    return std::ranges::all_of(wire.charts, [&](ChartId c) { return holds(c); });
  }

  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_key;  ///< wires' and corners' keys -> vertex of `mesh`
};

[[nodiscard]] RecutSurface recut_surface(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                                         const ChangeSet& changes, unsigned threads);

}  // namespace ramcdb::detail
