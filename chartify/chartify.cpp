#include "chartify/chartify.h"

#include "chartify/growth.h"
#include "chartify/packing.h"

namespace ramcdb::chartify {
namespace {

constexpr int kLloydIterations = 5;

}  // namespace

Charts chartify(const IndexedMesh& mesh, const Options& options) {
  const Neighbours neighbours = find_neighbours(mesh);
  const Components components = find_components(neighbours);
  Partition partition =
      grow_charts(mesh, neighbours, components, options.target_faces, kLloydIterations, options.progress);
  pack_small_components(components, options.target_faces, partition);
  renumber(partition);
  Charts charts;
  charts.chart_of_isolated_vertex = place_isolated_vertices(mesh, options.target_faces, partition);
  charts.chart_of_face = std::move(partition.chart_of_face);
  charts.chart_count = static_cast<std::uint32_t>(partition.sizes.size());
  return charts;
}

}  // namespace ramcdb::chartify
