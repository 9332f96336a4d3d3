#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "chartify/paper_lloyd.h"
#include "chartify/split.h"

namespace ramcdb::chartify {
namespace {

constexpr int kRepairRounds = 4;  // a cut may make a new abnormal chart
constexpr std::uint32_t kSmallestSplit = 24;

/// What the border of every chart looks like: which charts it meets, and along how many separate stretches.
class BorderSurvey {
 public:
  BorderSurvey(const std::vector<HalfEdge>& twins, const Partition& partition)
      : twins_(twins), partition_(partition), loops_(partition.sizes.size(), 0), neighbours_(partition.sizes.size()) {
    std::vector<std::uint8_t> seen(twins.size(), 0);
    for (HalfEdge h = 0; h < twins.size(); ++h)
      if (!seen[h] && in_chart(h) && is_outer(h)) walk_loop(h, seen);
  }

  [[nodiscard]] bool is_island(std::uint32_t chart) const {
    return neighbours_[chart].size() == 1 && !neighbours_[chart].contains(kNone);
  }
  [[nodiscard]] std::uint32_t only_neighbour(std::uint32_t chart) const { return *neighbours_[chart].begin(); }
  [[nodiscard]] bool is_ring(std::uint32_t chart) const { return loops_[chart] > 1; }
  /// Pairs of charts with more than one stretch of common border.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> double_borders() const {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (const auto& [pair, count] : stretches_)
      if (count > 1) pairs.push_back(pair);
    return pairs;
  }

 private:
  [[nodiscard]] std::uint32_t chart(HalfEdge h) const { return partition_.chart_of_face[face_of(h)]; }
  [[nodiscard]] bool in_chart(HalfEdge h) const { return chart(h) != kNone; }
  [[nodiscard]] std::uint32_t beyond(HalfEdge h) const { return twins_[h] == kNoTwin ? kNone : chart(twins_[h]); }
  [[nodiscard]] bool is_outer(HalfEdge h) const { return beyond(h) != chart(h); }

  [[nodiscard]] HalfEdge next(HalfEdge h) const {
    HalfEdge g = next_in_face(h);
    while (!is_outer(g)) g = next_in_face(twins_[g]);
    return g;
  }

  /// Loops of mesh border alone do not count: they are holes of the data.
  void walk_loop(HalfEdge first, std::vector<std::uint8_t>& seen) {
    const std::uint32_t own = chart(first);
    bool meets_charts = false;
    HalfEdge h = first;
    do {
      seen[h] = 1;
      const HalfEdge after = next(h);
      neighbours_[own].insert(beyond(h));
      meets_charts = meets_charts || beyond(h) != kNone;
      if (beyond(h) != beyond(after) && own < beyond(h) && beyond(h) != kNone) ++stretches_[{own, beyond(h)}];
      h = after;
    } while (h != first);
    loops_[own] += meets_charts;
  }

  const std::vector<HalfEdge>& twins_;
  const Partition& partition_;
  std::vector<std::uint32_t> loops_;
  std::vector<std::set<std::uint32_t>> neighbours_;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> stretches_;
};

bool merge_islands(const BorderSurvey& survey, Partition& partition) {
  std::vector<std::uint32_t> to(partition.sizes.size());
  bool any = false;
  for (std::uint32_t c = 0; c < to.size(); ++c) {
    to[c] = c;
    // Of two charts that make up a closed surface both are islands: one stays.
    if (!survey.is_island(c)) continue;
    const std::uint32_t host = survey.only_neighbour(c);
    if (survey.is_island(host)) continue;
    to[c] = host;
    any = true;
  }
  if (!any) return false;
  for (std::uint32_t& c : partition.chart_of_face)
    if (c != kNone) c = to[c];
  renumber(partition);
  return true;
}

}  // namespace

void repair_topology(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const Neighbours& neighbours,
                     Partition& partition) {
  for (int round = 0; round < kRepairRounds; ++round) {
    if (merge_islands(BorderSurvey(twins, partition), partition)) continue;
    const BorderSurvey survey(twins, partition);
    std::vector<std::uint32_t> parts(partition.sizes.size(), 0);
    for (std::uint32_t c = 0; c < parts.size(); ++c)
      if (survey.is_ring(c) && partition.sizes[c] >= kSmallestSplit) parts[c] = 3;
    for (const auto& [a, b] : survey.double_borders()) {
      const std::uint32_t larger = partition.sizes[b] > partition.sizes[a] ? b : a;
      if (parts[a] == 0 && parts[b] == 0 && partition.sizes[larger] >= kSmallestSplit) parts[larger] = 2;
    }
    if (std::all_of(parts.begin(), parts.end(), [](std::uint32_t p) { return p == 0; })) return;
    split_charts(mesh, neighbours, parts, partition);
  }
}

}  // namespace ramcdb::chartify
