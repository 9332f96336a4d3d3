#pragma once

#include <cstdint>
#include <vector>

#include "chartify/rechart.h"
#include "chartify/wire_net_builder.h"

/// A mesh that lives through edits: charts and a wire-net as a store would keep them, and parts of it that are taken
/// out, changed and put back.
namespace ramcdb::chartify::test {

struct StoredMesh {
  IndexedMesh mesh;
  Charts charts;
  WireNet net;
};
[[nodiscard]] StoredMesh store(IndexedMesh mesh, const Options& options);

/// Some charts of a stored mesh as a mesh of their own, with what stays fixed around them.
struct Region {
  IndexedMesh mesh;
  std::vector<std::uint32_t> chart_of_face, chart_of_isolated;  ///< positions in `charts`, or kNone
  std::vector<FixedWire> fixed;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> charts;         ///< of the stored mesh, ascending
  std::vector<std::uint32_t> fixed_wires;    ///< of the stored mesh
  std::vector<std::uint32_t> source_vertex;  ///< of the stored mesh; kNone for a new one

  [[nodiscard]] Rechart rechart_input() const {
    return {mesh, chart_of_face, chart_of_isolated, static_cast<std::uint32_t>(charts.size()), fixed};
  }
};
[[nodiscard]] Region take_out(const StoredMesh& stored, std::vector<std::uint32_t> charts);

/// Per face whether it passes an edge of a fixed wire and has to stay.
[[nodiscard]] std::vector<std::uint8_t> faces_that_stay(const Region& region);

/// Removes faces, and vertices that only they had.
void remove_faces(Region& region, const std::vector<std::uint8_t>& removed);

/// Adds vertices and faces without a chart.
std::uint32_t add_vertex(Region& region, LatticePoint at);
void add_face(Region& region, const Triangle& face);

/// The stored mesh with the region in the place of its charts: first the region's vertices and charts, then the others.
[[nodiscard]] StoredMesh put_back(const StoredMesh& stored, const Region& region, const Charts& charts,
                                  const WireNet& net);

}  // namespace ramcdb::chartify::test
