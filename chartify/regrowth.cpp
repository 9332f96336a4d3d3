#include "chartify/regrowth.h"

#include <algorithm>

#include "chartify/bucket_queue.h"

namespace ramcdb::chartify {
namespace {

// What a chart pays for a further ring: the first when it has no faces, and as much again for every target of them.
constexpr std::uint64_t kEmptyStep = 16, kMostStep = 256;

class Regrowth {
 public:
  Regrowth(const Neighbours& neighbours, std::uint32_t target, Partition& partition)
      : neighbours_(neighbours), target_(target), partition_(partition), best_(neighbours.size() / 3, ~0ULL) {}

  void run() {
    for (std::uint32_t f = 0; f < best_.size(); ++f)
      if (partition_.chart_of_face[f] != kNone) offer(f, 0);
    for (std::vector<BucketQueue::Entry> wanted; !queue_.empty();) {
      const std::uint64_t key = queue_.pop_all(wanted);
      for (; !wanted.empty(); wanted.pop_back()) take(wanted.back(), key);
    }
  }

 private:
  void take(BucketQueue::Entry wanted, std::uint64_t key) {
    if (partition_.chart_of_face[wanted.face] != kNone) return;
    partition_.chart_of_face[wanted.face] = wanted.chart;
    ++partition_.sizes[wanted.chart];
    offer(wanted.face, key);
  }

  /// Puts the free faces around a face of a chart into the queue.
  void offer(std::uint32_t face, std::uint64_t key) {
    const std::uint32_t chart = partition_.chart_of_face[face];
    const std::uint64_t step = std::min(kMostStep, kEmptyStep + kEmptyStep * partition_.sizes[chart] / target_);
    for (std::size_t e = 3 * std::size_t{face}; e < 3 * std::size_t{face} + 3; ++e) {
      const std::uint32_t g = neighbours_[e];
      if (g == kNone || partition_.chart_of_face[g] != kNone || key + step >= best_[g]) continue;
      best_[g] = key + step;
      queue_.push(key + step, {g, chart});
    }
  }

  const Neighbours& neighbours_;
  std::uint32_t target_;
  Partition& partition_;
  std::vector<std::uint64_t> best_;
  BucketQueue queue_;
};

}  // namespace

void grow_into_new_faces(const Neighbours& neighbours, std::uint32_t target, Partition& partition) {
  Regrowth(neighbours, target, partition).run();
}

}  // namespace ramcdb::chartify
