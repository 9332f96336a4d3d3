#include "chartify/growth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "chartify/bucket_queue.h"
#include "chartify/hilbert_cells.h"

namespace ramcdb::chartify {
namespace {

__extension__ using Wide = unsigned __int128;

// What a chart pays for each further face, in 1/256; the balance term makes big charts pay more.
constexpr std::uint32_t kFirstWeight = 16 * 256, kSmallestWeight = 5 * 256, kLargestWeight = 48 * 256;

class Grower {
 public:
  Grower(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions)
      : mesh_(mesh),
        neighbours_(neighbours),
        regions_(regions),
        seeds_(spread_seeds(regions)),
        weights_(seeds_.size(), kFirstWeight) {}

  void grow() {
    partition_.chart_of_face.assign(mesh_.faces.size(), kNone);
    partition_.sizes.assign(seeds_.size(), 0);
    std::vector<std::uint64_t> best(mesh_.faces.size(), ~std::uint64_t{0});
    BucketQueue queue;
    for (std::uint32_t c = 0; c < seeds_.size(); ++c) queue.push(0, {seeds_[c], c});
    while (!queue.empty()) {
      std::uint64_t key = 0;
      const auto [face, chart] = queue.pop(key);
      if (partition_.chart_of_face[face] != kNone) continue;
      partition_.chart_of_face[face] = chart;
      ++partition_.sizes[chart];
      const std::uint64_t next_key = key + weights_[chart] / 256;
      for (std::size_t e = 3 * std::size_t{face}; e < 3 * std::size_t{face} + 3; ++e) {
        const std::uint32_t g = neighbours_[e];
        if (g == kNone || partition_.chart_of_face[g] != kNone || next_key >= best[g]) continue;
        best[g] = next_key;
        queue.push(next_key, {g, chart});
      }
    }
  }

  void move_seeds() {
    struct Mean {
      std::array<std::int64_t, 3> sum{};
      Wide nearest = ~Wide{0};
    };
    std::vector<Mean> means(seeds_.size());
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      if (partition_.chart_of_face[f] == kNone) continue;
      const auto sum = corner_sum(mesh_, f);
      for (std::size_t a = 0; a < 3; ++a) means[partition_.chart_of_face[f]].sum[a] += sum[a];
    }
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      const std::uint32_t chart = partition_.chart_of_face[f];
      if (chart == kNone) continue;
      const auto sum = corner_sum(mesh_, f);
      Wide distance = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t d = partition_.sizes[chart] * sum[a] - means[chart].sum[a];
        const auto magnitude = static_cast<Wide>(d < 0 ? -d : d);
        distance += magnitude * magnitude;
      }
      if (distance >= means[chart].nearest) continue;
      means[chart].nearest = distance;
      seeds_[chart] = f;
    }
  }

  void balance() {
    for (std::size_t c = 0; c < seeds_.size(); ++c) {
      const std::uint32_t region = regions_.region_of_face[seeds_[c]];
      const double share = static_cast<double>(partition_.sizes[c]) * regions_.charts[region] / regions_.sizes[region];
      const double factor = std::clamp(std::sqrt(share), 0.7, 1.4);
      const auto weight = static_cast<std::uint32_t>(static_cast<double>(weights_[c]) * factor + 0.5);
      weights_[c] = std::clamp(weight, kSmallestWeight, kLargestWeight);
    }
  }

  Partition take() { return std::move(partition_); }

 private:
  const IndexedMesh& mesh_;
  const Neighbours& neighbours_;
  const Regions& regions_;
  std::vector<std::uint32_t> seeds_, weights_;
  Partition partition_;
};

}  // namespace

std::vector<std::uint32_t> spread_seeds(const Regions& regions) {
  std::vector<std::uint32_t> seeds, seen(regions.sizes.size(), 0);
  for (std::uint32_t f = 0; f < regions.region_of_face.size(); ++f) {
    const std::uint32_t region = regions.region_of_face[f];
    if (region == kNone || regions.charts[region] == 0) continue;
    const std::uint64_t size = regions.sizes[region], count = regions.charts[region], at = seen[region]++;
    const std::uint64_t run = at * count / size;
    const std::uint64_t begin = (run * size + count - 1) / count, end = ((run + 1) * size + count - 1) / count;
    if (at == begin + (end - begin) / 2) seeds.push_back(f);
  }
  return seeds;
}

Partition grow_charts(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions, int iterations,
                      const Progress& progress) {
  Grower grower(mesh, neighbours, regions);
  grower.grow();
  for (int i = 0; i < iterations; ++i) {
    if (progress) progress(static_cast<double>(i + 1) / (iterations + 1));
    grower.move_seeds();
    grower.balance();
    grower.grow();
  }
  return grower.take();
}

}  // namespace ramcdb::chartify
