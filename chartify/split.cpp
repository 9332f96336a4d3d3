#include "chartify/split.h"

#include <algorithm>

#include "chartify/growth.h"

namespace ramcdb::chartify {
namespace {

constexpr int kSplitRounds = 8;  // a part may come out far too large again

}  // namespace

Neighbours neighbours_within_charts(const Neighbours& neighbours, const std::vector<std::uint32_t>& chart_of_face) {
  Neighbours within = neighbours;
  for (std::size_t e = 0; e < within.size(); ++e)
    if (within[e] != kNone && chart_of_face[within[e]] != chart_of_face[e / 3]) within[e] = kNone;
  return within;
}

void split_charts(const IndexedMesh& mesh, const Neighbours& neighbours, const std::vector<std::uint32_t>& parts,
                  Partition& partition) {
  const Regions regions{partition.chart_of_face, partition.sizes, parts};
  const Neighbours within = neighbours_within_charts(neighbours, partition.chart_of_face);
  const Partition split = grow_charts(mesh, within, regions, kSplitIterations, nullptr);
  const auto offset = static_cast<std::uint32_t>(partition.sizes.size());
  for (std::size_t f = 0; f < partition.chart_of_face.size(); ++f)
    if (split.chart_of_face[f] != kNone) partition.chart_of_face[f] = offset + split.chart_of_face[f];
  partition.sizes.insert(partition.sizes.end(), split.sizes.begin(), split.sizes.end());
  renumber(partition);
}

void split_oversized(const IndexedMesh& mesh, const Neighbours& neighbours, const SizeLimits& limits,
                     Partition& partition) {
  for (int round = 0; round < kSplitRounds; ++round) {
    std::vector<std::uint32_t> parts(partition.sizes.size(), 0);
    for (std::size_t c = 0; c < parts.size(); ++c)
      if (partition.sizes[c] > limits.ceiling) parts[c] = (partition.sizes[c] + limits.target - 1) / limits.target;
    if (std::all_of(parts.begin(), parts.end(), [](std::uint32_t p) { return p == 0; })) return;
    split_charts(mesh, neighbours, parts, partition);
  }
}

}  // namespace ramcdb::chartify
