#include "chartify/packing.h"

#include <algorithm>

#include "chartify/hilbert_cells.h"

namespace ramcdb::chartify {
namespace {

// Isolated vertices that a chart takes: in targets, and at most (the codec limits the vertices of a chart).
constexpr std::uint32_t kIsolatedPerTarget = 4, kMostIsolated = 200'000;

}  // namespace

std::vector<std::uint32_t> isolated_vertices(const IndexedMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) used[v] = 1;
  std::vector<std::uint32_t> isolated;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) isolated.push_back(v);
  return isolated;
}

void pack_small_components(const Regions& components, std::uint32_t target, Partition& partition) {
  std::vector<std::uint32_t> chart_of(components.sizes.size(), kNone);
  std::uint32_t bin = kNone;
  for (std::size_t f = 0; f < partition.chart_of_face.size(); ++f) {
    if (partition.chart_of_face[f] != kNone) continue;
    const std::uint32_t component = components.region_of_face[f];
    std::uint32_t& chart = chart_of[component];
    if (chart == kNone) {
      if (bin == kNone || partition.sizes[bin] + components.sizes[component] > target) bin = partition.add_chart();
      chart = bin;
      partition.sizes[bin] += components.sizes[component];
    }
    partition.chart_of_face[f] = chart;
  }
}

std::vector<std::uint32_t> place_isolated_vertices(const IndexedMesh& mesh, std::uint32_t target, Partition& partition,
                                                   std::span<const std::uint32_t> wished) {
  const std::vector<std::uint32_t> isolated = isolated_vertices(mesh);
  if (isolated.empty()) return {};
  const HilbertCells cells(mesh);
  const std::uint64_t most = std::min(kIsolatedPerTarget * target, kMostIsolated);
  std::vector<std::uint64_t> count(partition.sizes.size(), 0), granted(partition.sizes.size(), 0);
  for (const std::uint32_t chart : wished)  // room is kept for them before others come
    if (chart != kNone) count[chart] = std::min(count[chart] + 1, most);
  std::vector<std::uint32_t> charts;
  std::uint32_t face = 0, overflow = kNone;
  for (std::size_t i = 0; i < isolated.size(); ++i) {
    if (!wished.empty() && wished[i] != kNone && granted[wished[i]] < most) {
      ++granted[wished[i]];
      charts.push_back(wished[i]);
      continue;
    }
    const std::uint64_t key = cells.key_of_vertex(isolated[i]);
    while (face + 1 < mesh.faces.size() && cells.key_of_face(face + 1) <= key) ++face;
    std::uint32_t chart = mesh.faces.empty() ? overflow : partition.chart_of_face[face];
    if (chart != kNone && count[chart] == most) chart = overflow;
    if (chart == kNone || count[chart] == most) {
      chart = overflow = partition.add_chart();
      count.push_back(0);
    }
    ++count[chart];
    charts.push_back(chart);
  }
  return charts;
}

}  // namespace ramcdb::chartify
