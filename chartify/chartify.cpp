#include "chartify/chartify.h"

#include <string>

#include "chartify/face_moves.h"
#include "chartify/growth.h"
#include "chartify/packing.h"
#include "chartify/paper_lloyd.h"
#include "chartify/rebalance.h"
#include "chartify/split.h"
#include "chartify/straighten.h"
#include "ramcdb/error.h"

namespace ramcdb::chartify {
namespace {

constexpr int kLloydIterations = 5;
constexpr int kRefinements = 2;
constexpr double kGrowthShare = 0.5;  // of the time, for the progress

/// The default recipe (chartify/RECIPE.md).
Partition refined_charts(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                         const Regions& components, const Options& options) {
  const auto progress = [&](double done) {
    if (options.progress) options.progress(done);
  };
  const SizeLimits limits(options.target_faces);
  Partition partition =
      grow_charts(mesh, neighbours, components, kLloydIterations, [&](double done) { progress(kGrowthShare * done); });
  FaceMover mover(twins, limits, partition);
  rebalance(mover, limits, static_cast<std::uint32_t>(partition.sizes.size()));
  split_oversized(mesh, neighbours, limits, partition);
  for (int i = 0; i < kRefinements; ++i) {
    progress(kGrowthShare + (1 - kGrowthShare) * i / kRefinements);
    move_faces(mover);
    straighten_borders(mesh, twins, limits, partition);
  }
  merge_pieces(neighbours, partition);
  return partition;
}

Partition paper_charts(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                       const Regions& components, const Options& options) {
  Partition partition = paper_lloyd(mesh, neighbours, components, options.progress);
  repair_topology(mesh, twins, neighbours, partition);
  return partition;
}

}  // namespace

Charts chartify(const IndexedMesh& mesh, const Options& options) {
  if (options.target_faces == 0 || options.target_faces > kMostTargetFaces)
    throw Error(Errc::invalid_argument, "charts of " + std::to_string(options.target_faces) + " faces", "chartify",
                "aim at 1 to " + std::to_string(kMostTargetFaces) + " faces");
  const std::vector<HalfEdge> twins = find_twins(mesh, group_half_edges(mesh));
  const Neighbours neighbours = find_neighbours(twins);
  const Regions components = find_components(neighbours, options.target_faces);
  Partition partition = options.method == Method::paper ? paper_charts(mesh, twins, neighbours, components, options)
                                                        : refined_charts(mesh, twins, neighbours, components, options);
  pack_small_components(components, options.target_faces, partition);
  renumber(partition);
  Charts charts;
  charts.chart_of_isolated_vertex = place_isolated_vertices(mesh, options.target_faces, partition);
  charts.chart_of_face = std::move(partition.chart_of_face);
  charts.chart_count = static_cast<std::uint32_t>(partition.sizes.size());
  if (options.progress) options.progress(1);
  return charts;
}

}  // namespace ramcdb::chartify
