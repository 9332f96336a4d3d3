#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ramcdb/figures.h"
#include "ramcdb/region.h"

namespace ramcdb {

/// Who a vertex is, for as long as its mesh keeps its connectivity: a corner, the n-th inner point of a wire, or the
/// n-th inner vertex of a chart. Charts decoded separately agree on it.
struct VertexKey {
  enum class Where : std::uint8_t { corner = 1, wire = 2, chart = 3 };
  Where where = Where::corner;
  std::uint32_t id = 0;     ///< of the corner, wire or chart
  std::uint32_t index = 0;  ///< along the wire from its begin, 0 first; in decode order within a chart

  [[nodiscard]] std::uint64_t packed() const;
  /// Throws invalid_argument for a number that packed() does not make.
  [[nodiscard]] static VertexKey unpack(std::uint64_t packed);
  friend auto operator<=>(const VertexKey&, const VertexKey&) = default;
};

/// A region as a triangle mesh: every vertex once, shared between its charts.
struct RegionMesh {
  std::vector<ChartId> charts;       ///< ascending
  std::vector<LatticePoint> points;  ///< per vertex
  std::vector<Point> exact;          ///< per vertex, model units; empty unless the mesh is lossless
  std::vector<VertexKey> keys;       ///< per vertex, no two equal
  std::vector<bool> outer_border;    ///< per vertex: on an edge that a chart outside the region shares
  /// These edges as pairs of vertices, the smaller first, ascending. Their vertices may move; faces may neither come
  /// nor go at them.
  std::vector<std::array<std::uint32_t, 2>> outer_edges;
  std::vector<Triangle> faces;               ///< chart by chart, in decode order
  std::vector<std::uint32_t> chart_of_face;  ///< per face: position in `charts`

  // What follows is there when it was asked for. A corner is 3 * face + 0..2.
  std::vector<Attribute> attributes;           ///< values per vertex, corner or face, as above
  std::vector<std::uint32_t> polygon_of_face;  ///< per face its polygon; all three empty when there are triangles only
  std::vector<std::uint32_t> polygon_sizes;    ///< corners per polygon
  std::vector<std::uint32_t> polygon_corners;  ///< polygon after polygon; a corner of one of its triangles each
};

/// What a piece of reading cost.
struct ReadCost {
  std::uint64_t blobs = 0, pages = 0, bytes = 0;
};

/// A read-only view of one mesh at one version. It holds the version: pruning leaves it alone until the last copy is
/// gone. Cheap to copy. Thread-safe: any number of threads may read through one Snapshot.
class Snapshot {
 public:
  class Impl;
  explicit Snapshot(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  [[nodiscard]] VersionId version() const;
  [[nodiscard]] const Lattice& lattice() const;
  /// Reads all leaf pages for the spread of chart sizes, components and boundary loops; no charts.
  [[nodiscard]] MeshInfo info() const;

  /// The region's charts, ascending. Reads index pages only, and only those whose box the region meets; `NearestTo`
  /// decodes the few charts whose box comes close enough. Throws not_found when a named chart does not exist and when
  /// the region is empty.
  [[nodiscard]] std::vector<ChartId> find(const Region& region, ReadCost* cost = nullptr) const;

  /// A line per chart; reads their index pages and the lengths of their blobs.
  [[nodiscard]] std::vector<ChartSummary> describe(const std::vector<ChartId>& charts) const;

  /// Decodes charts into one mesh: reads their blobs, their wires and their index pages, nothing else.
  /// Throws corrupt naming chart and version, not_found for an id that does not exist at this version.
  [[nodiscard]] RegionMesh read(const std::vector<ChartId>& charts, unsigned threads = 1,
                                ReadCost* cost = nullptr) const;
  /// The same with attributes and polygons, whose blobs it reads too.
  [[nodiscard]] RegionMesh read_with_attributes(const std::vector<ChartId>& charts, unsigned threads = 1,
                                                ReadCost* cost = nullptr) const;

  [[nodiscard]] Point position(LatticePoint p) const { return lattice().position(p); }
  /// Where a vertex of a region is, model units: of a lossless mesh to the last bit.
  [[nodiscard]] Point position(const RegionMesh& region, std::size_t vertex) const {
    return region.exact.empty() ? position(region.points[vertex]) : region.exact[vertex];
  }

  [[nodiscard]] const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace ramcdb
