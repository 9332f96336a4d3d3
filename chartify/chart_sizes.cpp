#include "chartify/chart_sizes.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "chartify/growth.h"
#include "chartify/split.h"

namespace ramcdb::chartify {
namespace {

constexpr int kRounds = 8;  // a part may come out too small or too large again

/// Joins small charts with their neighbours, the smallest first, and slight ones with those that they make one chart
/// with of up to the target.
class SmallCharts {
 public:
  SmallCharts(Recut& cut, std::vector<SmallComponent>& small) : cut_(cut), small_(small) {}

  void merge() {
    const std::vector<std::uint32_t>& sizes = cut_.partition.sizes;
    for (std::uint32_t c = 0; c < sizes.size(); ++c)
      if (waits(c)) queue_.emplace(sizes[c], c);
    if (queue_.empty()) return;
    lone_.assign(sizes.size(), 0);
    count_borders();
    while (!queue_.empty()) {
      const std::uint32_t c = queue_.begin()->second;
      queue_.erase(queue_.begin());
      const std::uint32_t to = closest(c);
      if (to != kNone)
        join(c, to);
      else if (cut_.is_small(sizes[c]))
        lone_[c] = 1;
    }
    relabel();
  }

 private:
  [[nodiscard]] bool waits(std::uint32_t c) const {
    return cut_.partition.sizes[c] > 0 && cut_.is_slight(cut_.partition.sizes[c]);
  }

  void count_borders() {
    borders_.resize(cut_.partition.sizes.size());
    const std::vector<std::uint32_t>& chart_of_face = cut_.partition.chart_of_face;
    for (std::size_t e = 0; e < cut_.neighbours.size(); ++e) {
      if (cut_.neighbours[e] == kNone) continue;
      const std::uint32_t a = chart_of_face[e / 3], b = chart_of_face[cut_.neighbours[e]];
      if (a != b) ++borders_[a][b];
    }
  }

  /// The neighbour to join; kNone where there is none, or none that a chart which need not join fits.
  [[nodiscard]] std::uint32_t closest(std::uint32_t c) const {
    const std::vector<std::uint32_t>& sizes = cut_.partition.sizes;
    const bool must_join = cut_.is_small(sizes[c]);
    const auto rank = [&](std::uint32_t other, std::uint32_t edges) {
      const bool fits = !cut_.is_large(std::uint64_t{sizes[c]} + sizes[other]);
      return std::tuple(!fits, ~edges, sizes[other], other);
    };
    std::uint32_t best = kNone, most = 0;
    for (const auto& [other, edges] : borders_[c])
      if ((must_join || sizes[c] + sizes[other] <= cut_.target) &&
          (best == kNone || rank(other, edges) < rank(best, most)))
        best = other, most = edges;
    return best;
  }

  void join(std::uint32_t c, std::uint32_t to) {
    std::vector<std::uint32_t>& sizes = cut_.partition.sizes;
    queue_.erase({sizes[to], to});
    sizes[to] += std::exchange(sizes[c], 0U);
    cut_.into[c] = to;
    cut_.open[to] = cut_.open[to] || cut_.open[c];
    for (const auto& [other, edges] : borders_[c]) {
      borders_[other].erase(c);
      if (other == to) continue;
      borders_[other][to] += edges;
      borders_[to][other] += edges;
    }
    if (waits(to)) queue_.emplace(sizes[to], to);
  }

  /// Charts without neighbours are whole components; they come apart.
  void relabel() {
    std::vector<std::uint8_t> listed(cut_.components.sizes.size(), 0);
    for (std::uint32_t f = 0; f < cut_.partition.chart_of_face.size(); ++f) {
      std::uint32_t& chart = cut_.partition.chart_of_face[f];
      if (chart == kNone) continue;
      chart = cut_.living(chart);
      if (!lone_[chart]) continue;
      chart = kNone;
      const std::uint32_t component = cut_.components.region_of_face[f];
      if (!std::exchange(listed[component], std::uint8_t{1})) small_.push_back({component, f, kNone});
    }
    for (SmallComponent& s : small_)
      if (s.chart != kNone) s.chart = lone_[cut_.living(s.chart)] ? kNone : cut_.living(s.chart);
    for (std::size_t c = 0; c < lone_.size(); ++c)
      if (lone_[c]) cut_.partition.sizes[c] = 0;
  }

  Recut& cut_;
  std::vector<SmallComponent>& small_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> queue_;  ///< size and chart
  std::vector<std::map<std::uint32_t, std::uint32_t>> borders_;
  std::vector<std::uint8_t> lone_;
};

std::uint32_t parts_of(std::uint64_t faces, std::uint32_t target) {
  return static_cast<std::uint32_t>(std::max<std::uint64_t>(2, (faces + target / 2) / target));
}

/// Small components leave charts that are to be split, so that sizes tell what is connected.
void clear_decks(Recut& cut, const std::vector<std::uint8_t>& leave, std::vector<SmallComponent>& small) {
  for (SmallComponent& s : small)
    if (s.chart != kNone && leave[s.chart]) {
      cut.partition.sizes[s.chart] -= cut.components.sizes[s.component];
      s.chart = kNone;
    }
}

/// Cuts chart c into parts[c] charts, or not where that is 0. The first part keeps the number.
void split(Recut& cut, const std::vector<std::uint32_t>& parts) {
  Regions regions{cut.partition.chart_of_face, cut.partition.sizes, parts};
  for (std::uint32_t& region : regions.region_of_face)
    if (region != kNone && parts[region] == 0) region = kNone;
  const Neighbours within = neighbours_within_charts(cut.neighbours, regions.region_of_face);
  const Partition pieces = grow_charts(cut.mesh, within, regions, kSplitIterations, nullptr);
  std::vector<std::uint32_t> chart_of_part(pieces.sizes.size(), kNone);
  std::vector<std::uint8_t> kept(parts.size(), 0);
  for (std::size_t f = 0; f < pieces.chart_of_face.size(); ++f) {
    if (pieces.chart_of_face[f] == kNone) continue;
    const std::uint32_t chart = regions.region_of_face[f];
    std::uint32_t& part = chart_of_part[pieces.chart_of_face[f]];
    if (part == kNone && !kept[chart]) {
      kept[chart] = 1;
      part = chart;
    } else if (part == kNone) {
      part = cut.add_chart();
      cut.group[part] = cut.group[chart];
    }
    cut.open[part] = cut.open[chart] = 1;
    --cut.partition.sizes[chart];
    ++cut.partition.sizes[part];
    cut.partition.chart_of_face[f] = part;
  }
}

/// Returns whether there were any.
bool split_large(Recut& cut, std::vector<SmallComponent>& small) {
  const std::size_t charts = cut.partition.sizes.size();
  std::vector<std::uint8_t> large(charts, 0);
  for (std::size_t c = 0; c < charts; ++c) large[c] = cut.is_large(cut.partition.sizes[c]);
  if (std::ranges::count(large, 1) == 0) return false;
  clear_decks(cut, large, small);
  std::vector<std::uint32_t> parts(charts, 0);
  for (std::size_t c = 0; c < charts; ++c)
    if (cut.is_large(cut.partition.sizes[c])) parts[c] = parts_of(cut.partition.sizes[c], cut.target);
  split(cut, parts);
  return true;
}

/// If those that wait are too few for a chart of their own and fit nowhere, the smallest chart is split for them.
bool make_room(Recut& cut, std::vector<SmallComponent>& small) {
  std::uint64_t waiting = 0;
  for (const SmallComponent& s : small)
    if (s.chart == kNone) waiting += cut.components.sizes[s.component];
  if (waiting == 0 || !cut.is_small(waiting)) return false;
  std::uint32_t smallest = kNone;
  const std::vector<std::uint32_t>& sizes = cut.partition.sizes;
  for (std::uint32_t c = 0; c < sizes.size(); ++c)
    if (sizes[c] > 0 && (smallest == kNone || sizes[c] < sizes[smallest])) smallest = c;
  if (smallest == kNone || !cut.is_large(waiting + sizes[smallest])) return false;
  std::vector<std::uint8_t> leave(sizes.size(), 0);
  leave[smallest] = 1;
  clear_decks(cut, leave, small);
  std::vector<std::uint32_t> parts(sizes.size(), 0);
  if (!cut.is_small(sizes[smallest] / 2)) parts[smallest] = 2;
  split(cut, parts);
  return true;
}

}  // namespace

void keep_sizes(Recut& cut, std::vector<SmallComponent>& small) {
  for (int round = 0; round < kRounds; ++round) {
    SmallCharts(cut, small).merge();
    if (!split_large(cut, small) && !make_room(cut, small)) return;
  }
}

}  // namespace ramcdb::chartify
