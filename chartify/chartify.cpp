#include "chartify/chartify.h"

#include <algorithm>

#include "chartify/block.h"
#include "chartify/face_moves.h"
#include "chartify/growth.h"
#include "chartify/packing.h"
#include "chartify/paper_lloyd.h"
#include "chartify/polygons.h"
#include "chartify/rebalance.h"
#include "chartify/split.h"
#include "chartify/straighten.h"
#include "ramcdb/error.h"

namespace ramcdb::chartify {
namespace {

constexpr int kLloydIterations = 5;
constexpr int kRefinements = 2;
constexpr double kGrowthShare = 0.5;  // of the time, for the progress

/// The default recipe (chartify/RECIPE.md), behind its first stage.
void refine(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
            const Progress& progress, const SizeLimits& limits, unsigned threads, Partition& partition) {
  FaceMover mover(twins, limits, partition);
  rebalance(mover, limits, static_cast<std::uint32_t>(partition.sizes.size()));
  split_oversized(mesh, neighbours, limits, partition);
  const BorderStraightener straightener(mesh, twins);
  for (int i = 0; i < kRefinements; ++i) {
    const auto share = [&](double of_round) { return (i + of_round) / kRefinements; };
    move_faces(mover, threads, part_of(progress, share(0), share(0.5)));
    straightener.run(limits, partition, nullptr, threads, part_of(progress, share(0.5), share(1)));
  }
  merge_pieces(neighbours, partition);
}

Partition refined_charts(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                         const Regions& components, const Options& options) {
  Partition partition = grow_charts(mesh, neighbours, components, kLloydIterations,
                                    part_of(options.progress, 0, kGrowthShare), options.threads);
  refine(mesh, twins, neighbours, part_of(options.progress, kGrowthShare, 1), SizeLimits(options.target_faces),
         options.threads, partition);
  return partition;
}

Partition paper_charts(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                       const Regions& components, const Options& options) {
  Partition partition = paper_lloyd(mesh, neighbours, components, options.progress);
  repair_topology(mesh, twins, neighbours, partition);
  return partition;
}

Charts charts_of(const IndexedMesh& mesh, const Regions& components, const Options& options, Partition& partition) {
  pack_small_components(components, options.target_faces, partition);
  keep_polygons_whole(mesh.polygon_of_face, partition);
  renumber(partition);
  Charts charts;
  charts.chart_of_isolated_vertex = place_isolated_vertices(mesh, options.target_faces, partition);
  charts.chart_of_face = std::move(partition.chart_of_face);
  charts.chart_count = static_cast<std::uint32_t>(partition.sizes.size());
  report(options.progress, 1);
  return charts;
}

/// Gives each small component that vertices of `later` touch a chart of its own, until the rest of it is there.
void keep_apart(const IndexedMesh& mesh, const Regions& components, std::span<const std::uint32_t> later,
                Partition& partition) {
  std::vector<std::uint32_t> chart_of(components.sizes.size(), kNone);
  const auto waits = [&](std::uint32_t v) { return later[v] != kNone; };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t component = components.region_of_face[f];
    if (components.charts[component] == 0 && chart_of[component] == kNone && std::ranges::any_of(mesh.faces[f], waits))
      chart_of[component] = partition.add_chart();
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t chart = chart_of[components.region_of_face[f]];
    if (chart == kNone) continue;
    partition.chart_of_face[f] = chart;
    ++partition.sizes[chart];
  }
}

Charts cut(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, std::span<const std::uint32_t> later,
           const Options& options) {
  require_target(options);
  const Neighbours neighbours = find_neighbours(twins);
  report(options.progress, 0);
  const Regions components = find_components(neighbours, options.target_faces);
  report(options.progress, 0);
  Partition partition = options.method == Method::paper ? paper_charts(mesh, twins, neighbours, components, options)
                                                        : refined_charts(mesh, twins, neighbours, components, options);
  if (!later.empty()) keep_apart(mesh, components, later, partition);
  return charts_of(mesh, components, options, partition);
}

}  // namespace

Charts chartify(const IndexedMesh& mesh, const Options& options) {
  return cut(mesh, find_twins(mesh, group_half_edges(mesh)), {}, options);
}

Charts chartify(const IndexedMesh& mesh, const Adjacency& adjacency, const Options& options) {
  return cut(mesh, adjacency.twins, {}, options);
}

BlockCharts cut_block(const IndexedMesh& mesh, std::span<const std::uint32_t> later, const Options& options) {
  if (later.size() != mesh.positions.size())
    throw Error(Errc::invalid_argument, "a block of another number of vertices", "chartify");
  BlockCharts out{cut(mesh, find_twins(mesh, group_half_edges(mesh)), later, options), {}};
  out.waits_for.assign(out.charts.chart_count, kNone);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) {
      std::uint32_t& block = out.waits_for[out.charts.chart_of_face[f]];
      block = std::min(block, later[v]);
    }
  return out;
}

Charts refine_cut(const IndexedMesh& mesh, std::vector<std::uint32_t> chart_of_face, const Options& options) {
  require_target(options);
  if (chart_of_face.size() != mesh.faces.size())
    throw Error(Errc::invalid_argument, "a cut of another number of faces", "chartify");
  const std::vector<HalfEdge> twins = find_twins(mesh, group_half_edges(mesh));
  const Neighbours neighbours = find_neighbours(twins);
  const Regions components = find_components(neighbours, options.target_faces);
  Partition partition{std::move(chart_of_face), {}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::uint32_t& chart = partition.chart_of_face[f];
    const std::uint32_t region = components.region_of_face[f];
    if (region == kNone || components.charts[region] == 0) {
      chart = kNone;
      continue;
    }
    if (chart >= mesh.faces.size()) throw Error(Errc::invalid_argument, "a chart number beyond the faces", "chartify");
    if (chart >= partition.sizes.size()) partition.sizes.resize(std::size_t{chart} + 1);
    ++partition.sizes[chart];
  }
  renumber(partition);
  merge_pieces(neighbours, partition);
  refine(mesh, twins, neighbours, options.progress, SizeLimits(options.target_faces), options.threads, partition);
  return charts_of(mesh, components, options, partition);
}

}  // namespace ramcdb::chartify
