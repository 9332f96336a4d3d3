#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "api/chart_loader.h"
#include "api/layer_edit.h"
#include "api/region_mesh.h"

namespace ramcdb::detail {

/// Where a vertex goes. In a lossless mesh it may go less than a lattice step.
struct VertexMove {
  VertexKey key;
  LatticePoint from, to;
  Point position, target;  ///< model units; of other meshes those of `from` and `to`

  friend bool operator==(const VertexMove&, const VertexMove&) = default;
};

/// The move of a vertex of a region to `p`; none when the mesh would keep it where it is. Throws invalid_argument and
/// limit_exceeded for places that the mesh's lattice does not have.
[[nodiscard]] std::optional<VertexMove> move_to(const Snapshot::Impl& at, const RegionMesh& region, std::size_t vertex,
                                                const Point& p);

struct RecodedLayer {
  std::uint16_t layer = 0;
  Buffer blob;
  std::uint64_t bytes_before = 0;  ///< checksum included
};

/// A chart of which something was coded anew, and what it was decided on.
struct RecodedChart {
  PageChart base;  ///< as it stood: the tip must still have this very state
  PageChart entry;
  Buffer blob;  ///< empty when its geometry stays
  codec::ChartCost cost_before, cost;
  bool expanded_range = false;
  std::vector<RecodedLayer> layers;
};

struct RecodedWire {
  PageWire base;
  WireId group;  ///< the first wire in the blob with its new points
  Wire wire;
  std::uint64_t bytes_before = 0;  ///< its share of the blob that it was in, checksum included
};

/// Another way of coding all charts of a mesh.
struct NewCoding {
  codec::Profile profile = codec::Profile::dense;
  TableId table;                         ///< 0: the built-in tables
  Buffer tables;                         ///< the blob of that table
  std::uint64_t table_bytes_before = 0;  ///< of the mesh's own table, checksum included; 0 without
};

/// An edit, coded and ready to be placed on any version that still holds what it was decided on.
struct EncodedEdit {
  std::map<ChartId, RecodedChart> charts;
  std::map<WireId, RecodedWire> wires;
  std::map<WireId, Buffer> wire_groups;  ///< the blobs with their points, by first wire
  std::map<CornerId, LatticePoint> corners;
  std::optional<NewCoding> coding;  ///< then `charts` are all that the mesh has
};

/// What an edit changes.
struct Edit {
  std::vector<VertexMove> moves;
  std::vector<LayerEdit> layers;

  [[nodiscard]] bool empty() const { return moves.empty() && layers.empty(); }
};

/// Codes the charts and wires that an edit touches. A moved inner vertex touches its chart; a point of a wire, the wire
/// and every chart on it; a corner, all wires that end there and all charts around it, also those outside the region,
/// whose other vertices stay; the exact positions of a lossless mesh follow its charts. A changed value touches its
/// layer in the same charts, and nothing else. No connectivity changes, so wires, corners and loops keep their ids.
/// Layers follow connectivity, so they stay when vertices move; only where a component has no border to begin at may
/// another order of its faces make them new.
/// \param parts the region that the keys belong to; keys of one part's charts refer to its version.
[[nodiscard]] EncodedEdit encode_edit(std::span<const RegionPart> parts, const Edit& edit, unsigned threads);

/// Codes all charts of a mesh anew with other tables, in any profile; what charts hold stays as it is. Layers are coded
/// anew where their order follows that of the chart's vertices or faces. `progress` gets the share that is done.
[[nodiscard]] EncodedEdit encode_again(const Snapshot::Impl& at, codec::Profile profile,
                                       const codec::CoderTables& tables, unsigned threads,
                                       const std::function<void(double)>& progress);

}  // namespace ramcdb::detail
