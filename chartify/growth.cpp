#include "chartify/growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "chartify/bucket_queue.h"
#include "chartify/hilbert_cells.h"
#include "chartify/parallel.h"

namespace ramcdb::chartify {
namespace {

__extension__ using Wide = unsigned __int128;

// What a chart pays for each further face, in 1/256; the balance term makes big charts pay more.
constexpr std::uint32_t kFirstWeight = 16 * 256, kSmallestWeight = 5 * 256, kLargestWeight = 48 * 256;

/// What growth reads and writes of a face, together in memory.
struct Cell {
  static constexpr std::uint32_t kTaken = 0, kFree = ~std::uint32_t{0};

  std::array<std::uint32_t, 3> neighbours;
  std::uint32_t least;  ///< key that the face went into the queue with so far; kTaken once it is in a chart
};

class Grower {
 public:
  Grower(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions, unsigned threads)
      : mesh_(mesh),
        regions_(regions),
        threads_(threads),
        seeds_(spread_seeds(regions)),
        weights_(seeds_.size(), kFirstWeight),
        cells_(mesh.faces.size()) {
    for (std::size_t f = 0; f < cells_.size(); ++f)
      std::copy_n(neighbours.begin() + static_cast<std::ptrdiff_t>(3 * f), 3, cells_[f].neighbours.begin());
  }

  void grow() {
    partition_.chart_of_face.assign(mesh_.faces.size(), kNone);
    partition_.sizes.assign(seeds_.size(), 0);
    for (Cell& cell : cells_) cell.least = Cell::kFree;
    BucketQueue queue;
    for (std::uint32_t c = 0; c < seeds_.size(); ++c) queue.push(0, {seeds_[c], c});
    for (std::vector<BucketQueue::Entry> wanted; !queue.empty();) {
      const std::uint64_t key = queue.pop_all(wanted);
      for (; !wanted.empty(); wanted.pop_back()) {
        prefetch(wanted);
        const BucketQueue::Entry entry = wanted.back();
        if (cells_[entry.face].least == Cell::kTaken) continue;
        take(entry);
        // Along a strip of 89 million faces keys become too large to be told apart by `least`.
        const std::uint64_t next_key = key + weights_[entry.chart] / 256;
        const auto least = static_cast<std::uint32_t>(std::min<std::uint64_t>(next_key, Cell::kFree - 1));
        for (const std::uint32_t g : cells_[entry.face].neighbours) {
          if (g == kNone || least >= cells_[g].least) continue;
          cells_[g].least = least;
          queue.push(next_key, {g, entry.chart});
        }
      }
    }
  }

  void move_seeds() {
    const std::vector<Sum> sums = sums_of_charts();
    std::vector<Nearest> nearest(seeds_.size());
    std::mutex mutex;
    parallel_ranges(mesh_.faces.size(), threads_, [&](std::size_t begin, std::size_t end) {
      std::vector<Nearest> found(seeds_.size());
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) {
        const std::uint32_t chart = partition_.chart_of_face[f];
        if (chart != kNone) found[chart] = std::min(found[chart], {distance(f, chart, sums[chart]), f});
      }
      const std::lock_guard lock(mutex);
      for (std::size_t c = 0; c < found.size(); ++c) nearest[c] = std::min(nearest[c], found[c]);
    });
    for (std::size_t c = 0; c < seeds_.size(); ++c) seeds_[c] = nearest[c].face;
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
  using Sum = std::array<std::int64_t, 3>;
  /// Ties to the lower face.
  struct Nearest {
    Wide distance = ~Wide{0};
    std::uint32_t face = kNone;
    friend bool operator<(const Nearest& a, const Nearest& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
    }
  };

  [[nodiscard]] std::vector<Sum> sums_of_charts() const {
    std::vector<Sum> sums(seeds_.size(), Sum{});
    std::mutex mutex;
    const auto add = [](Sum& to, const Sum& sum) {
      for (std::size_t a = 0; a < 3; ++a) to[a] += sum[a];
    };
    parallel_ranges(mesh_.faces.size(), threads_, [&](std::size_t begin, std::size_t end) {
      std::vector<Sum> found(seeds_.size(), Sum{});
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f)
        if (partition_.chart_of_face[f] != kNone) add(found[partition_.chart_of_face[f]], corner_sum(mesh_, f));
      const std::lock_guard lock(mutex);
      for (std::size_t c = 0; c < found.size(); ++c) add(sums[c], found[c]);
    });
    return sums;
  }

  /// From a face's middle to that of its chart, squared, as far as it tells the chart's faces apart.
  [[nodiscard]] Wide distance(std::uint32_t face, std::uint32_t chart, const Sum& sum_of_chart) const {
    const Sum sum = corner_sum(mesh_, face);
    Wide distance = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t d = partition_.sizes[chart] * sum[a] - sum_of_chart[a];
      const auto magnitude = static_cast<Wide>(d < 0 ? -d : d);
      distance += magnitude * magnitude;
    }
    return distance;
  }

  void take(BucketQueue::Entry wanted) {
    cells_[wanted.face].least = Cell::kTaken;
    partition_.chart_of_face[wanted.face] = wanted.chart;
    ++partition_.sizes[wanted.chart];
  }

  /// Growth is all misses of the cache, as fronts of many charts take turns; but what comes next is known.
  void prefetch(const std::vector<BucketQueue::Entry>& wanted) const {
    constexpr std::size_t kFar = 16, kNear = 8;
    const auto cell = [&](std::size_t ahead) { return &cells_[wanted[wanted.size() - 1 - ahead].face]; };
    if (wanted.size() > kFar) __builtin_prefetch(cell(kFar));
    if (wanted.size() <= kNear || cell(kNear)->least == Cell::kTaken) return;
    for (const std::uint32_t g : cell(kNear)->neighbours)
      if (g != kNone) __builtin_prefetch(&cells_[g]);
  }

  const IndexedMesh& mesh_;
  const Regions& regions_;
  unsigned threads_;
  std::vector<std::uint32_t> seeds_, weights_;
  std::vector<Cell> cells_;
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
                      const Progress& progress, unsigned threads) {
  Grower grower(mesh, neighbours, regions, threads);
  grower.grow();
  for (int i = 1; i <= iterations; ++i) {
    report(progress, static_cast<double>(i) / (iterations + 1));
    grower.move_seeds();
    grower.balance();
    grower.grow();
  }
  return grower.take();
}

}  // namespace ramcdb::chartify
