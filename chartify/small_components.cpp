#include "chartify/small_components.h"

#include <algorithm>
#include <cstdlib>

#include "chartify/hilbert_cells.h"

namespace ramcdb::chartify {
namespace {

constexpr int kMostSteps = 32;  // charts looked at on either side

class Placer {
 public:
  Placer(Recut& cut, std::vector<SmallComponent>& small) : cut_(cut), small_(small) {
    for (std::uint32_t f = 0; f < cut.partition.chart_of_face.size(); ++f) add_to_runs(f);
  }

  void run() {
    std::ranges::sort(small_, {}, &SmallComponent::first_face);
    std::vector<SmallComponent*> rest;
    for (SmallComponent& s : small_)
      if (s.chart == kNone && !board(s, nearest(s.first_face, size(s), cut_.target))) rest.push_back(&s);
    fill_charts(rest);
    std::vector<std::uint32_t> chart_of(cut_.components.sizes.size(), kNone);
    for (const SmallComponent& s : small_) chart_of[s.component] = s.chart;
    for (std::size_t f = 0; f < cut_.partition.chart_of_face.size(); ++f)
      if (const std::uint32_t chart = chart_of[cut_.components.region_of_face[f]]; chart != kNone)
        cut_.partition.chart_of_face[f] = chart;
  }

 private:
  /// Faces of one chart in a row.
  struct Run {
    std::uint32_t first, last, chart;
  };

  void add_to_runs(std::uint32_t face) {
    const std::uint32_t chart = cut_.partition.chart_of_face[face];
    if (chart == kNone) return;
    if (!runs_.empty() && runs_.back().chart == chart)
      runs_.back().last = face;
    else
      runs_.push_back({face, face, chart});
  }

  [[nodiscard]] std::uint32_t size(const SmallComponent& s) const { return cut_.components.sizes[s.component]; }

  bool board(SmallComponent& s, std::uint32_t chart) {
    if (chart == kNone) return false;
    s.chart = chart;
    cut_.partition.sizes[chart] += size(s);
    return true;
  }

  [[nodiscard]] std::int64_t distance(std::uint32_t face, std::uint32_t other) const {
    const auto a = corner_sum(cut_.mesh, face), b = corner_sum(cut_.mesh, other);
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::abs(a[i] - b[i]);
    return sum;
  }

  /// The chart of the nearer of the runs before and behind a face that have room; ties to the one before.
  [[nodiscard]] std::uint32_t nearest(std::uint32_t face, std::uint32_t faces, std::uint64_t most) const {
    const auto fits = [&](const Run& run) { return std::uint64_t{cut_.partition.sizes[run.chart]} + faces <= most; };
    const auto behind = std::ranges::lower_bound(runs_, face, {}, &Run::first);
    std::uint32_t best = kNone;
    std::int64_t least = 0;
    auto before = behind;
    for (int step = 0; step < kMostSteps && before != runs_.begin() && best == kNone; ++step)
      if (fits(*--before)) best = before->chart, least = distance(face, std::min(before->last, face));
    int step = 0;
    for (auto it = behind; it != runs_.end() && step < kMostSteps; ++it, ++step) {
      if (!fits(*it)) continue;
      if (best == kNone || distance(face, it->first) < least) best = it->chart;
      break;
    }
    return best;
  }

  void fill_charts(const std::vector<SmallComponent*>& rest) {
    std::uint32_t chart = kNone;
    for (SmallComponent* s : rest) {
      if (chart == kNone || std::uint64_t{cut_.partition.sizes[chart]} + size(*s) > cut_.target)
        chart = cut_.add_chart();
      board(*s, chart);
    }
    if (chart != kNone && cut_.is_small(cut_.partition.sizes[chart])) give_up(chart, rest);
  }

  /// The last chart is too small: it joins a near one that stays within twice the target, or the first such.
  void give_up(std::uint32_t chart, const std::vector<SmallComponent*>& rest) {
    std::vector<std::uint32_t>& sizes = cut_.partition.sizes;
    const std::uint32_t faces = sizes[chart];
    std::uint32_t to = nearest(rest.back()->first_face, faces, 2ULL * cut_.target);
    for (std::uint32_t c = 0; c < sizes.size(); ++c)
      if (to == kNone && c != chart && sizes[c] > 0 && !cut_.is_large(std::uint64_t{sizes[c]} + faces)) to = c;
    if (to == kNone) return;
    for (SmallComponent* s : rest)
      if (s->chart == chart) s->chart = to;
    sizes[to] += faces;
    sizes[chart] = 0;
  }

  Recut& cut_;
  std::vector<SmallComponent>& small_;
  std::vector<Run> runs_;
};

}  // namespace

void place_small_components(Recut& cut, std::vector<SmallComponent>& small) {
  if (!small.empty()) Placer(cut, small).run();
}

}  // namespace ramcdb::chartify
