#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "api/edited_region.h"
#include "api/layer_edit.h"
#include "api/region_mesh.h"

namespace ramcdb::detail {

/// Where a vertex goes. In a lossless mesh it may go less than a lattice step.
struct VertexMove {
  VertexKey key;
  LatticePoint from, to;
  Point position, target;    ///< model units; of other meshes those of `from` and `to`
  std::uint32_t vertex = 0;  ///< of the region, where there is one

  friend bool operator==(const VertexMove&, const VertexMove&) = default;
};

/// The move of a vertex of a region to `p`; none when the mesh would keep it where it is. Throws invalid_argument and
/// limit_exceeded for places that the mesh's lattice does not have.
[[nodiscard]] std::optional<VertexMove> move_to(const Snapshot::Impl& at, const RegionMesh& region, std::size_t vertex,
                                                const Point& p);

/// What an edit changes.
struct ChangeSet {
  std::vector<VertexMove> moves;                         ///< of vertices that stay
  std::vector<LayerEdit> layers;                         ///< of vertices, corners and faces that stay
  std::vector<std::uint32_t> faces_gone, vertices_gone;  ///< of the region
  std::vector<std::uint32_t> faces_new, vertices_new;    ///< of the edited mesh
  /// Charts that are to be cut anew: those that lose faces; for every vertex that new faces take up one chart that
  /// knows it; and all charts at an edge where the number of faces changes. At
  /// least one, where connectivity changes.
  std::set<ChartId> recut;
  std::set<ChartId> touched;  ///< charts of the region that hold anything that changes

  [[nodiscard]] bool empty() const { return moves.empty() && layers.empty() && !connectivity(); }
  [[nodiscard]] bool connectivity() const {
    return !(faces_gone.empty() && faces_new.empty() && vertices_gone.empty() && vertices_new.empty());
  }
};

/// What an edit changes, without `recut` and `touched`.
[[nodiscard]] ChangeSet differences_of(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited);

/// Compares an edit with its region. Throws invalid_argument, naming places, where the number of faces changes at an
/// edge that charts outside the region share: these would be torn.
/// \param at a version that has the region or a part of it
[[nodiscard]] ChangeSet changes_of(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited);

}  // namespace ramcdb::detail
