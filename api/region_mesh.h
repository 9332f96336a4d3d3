#pragma once

#include <span>
#include <vector>

#include "api/chart_loader.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// Some charts of one snapshot. A region as a rule is one such part; after a commit that went in beside other people's,
/// a checked-out file has charts of several versions.
struct RegionPart {
  const Snapshot::Impl* at = nullptr;
  std::vector<ChartId> charts;
};

/// Joins charts into one mesh: vertices with equal keys become one. Charts ascending; vertices in the order in which
/// the charts first name them.
[[nodiscard]] RegionMesh load_region(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost = nullptr,
                                     bool with_layers = false);

/// Where a vertex of a mesh is, model units: of a lossless one to the last bit.
[[nodiscard]] inline Point position_in(const RegionMesh& mesh, const Lattice& lattice, std::size_t vertex) {
  return mesh.exact.empty() ? lattice.position(mesh.points[vertex]) : mesh.exact[vertex];
}
/// The same of all vertices.
[[nodiscard]] std::vector<Point> positions_in(const RegionMesh& mesh, const Lattice& lattice);

/// The middle of the bounding box of some points; the origin of none.
[[nodiscard]] Point middle_of(std::span<const Point> points);

}  // namespace ramcdb::detail
