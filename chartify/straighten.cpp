#include "chartify/straighten.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <queue>
#include <utility>

#include "chartify/turns.h"
#include "chartify/vertex_scratch.h"

namespace ramcdb::chartify {
namespace {

constexpr std::uint32_t kBandWidth = 8;     // edges on either side of a border
constexpr std::uint32_t kCostPerEdge = 64;  // plus as much for an edge of mean length

double edge_length(const IndexedMesh& mesh, std::uint32_t u, std::uint32_t v) {
  const LatticePoint p = mesh.positions[u], q = mesh.positions[v];
  const auto square = [](double d) { return d * d; };
  return std::sqrt(square(p.x - q.x) + square(p.y - q.y) + square(p.z - q.z));
}

/// A border that runs from corner to corner, and the charts beside it.
struct BorderBetween {
  BorderPath path;
  std::uint32_t left, right;
};

std::vector<BorderBetween> between_charts(std::vector<BorderPath> paths, const std::vector<HalfEdge>& twins,
                                          const std::vector<std::uint32_t>& chart_of_face) {
  std::vector<BorderBetween> borders;
  for (BorderPath& path : paths) {
    const HalfEdge first = path.front();
    borders.push_back({std::move(path), chart_of_face[face_of(first)], chart_of_face[face_of(twins[first])]});
  }
  return borders;
}

/// Straightens one border after the other. Several may work at a time on borders without a common chart.
class Straightener {
 public:
  Straightener(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const ClosedFans& fans, double mean_length,
               const SizeLimits& limits, Partition& partition, const MoveRules* rules)
      : mesh_(mesh),
        twins_(twins),
        fans_(fans),
        mean_length_(mean_length),
        limits_(limits),
        partition_(partition),
        rules_(rules) {}

  void straighten(const BorderBetween& border) {
    const BorderPath& path = border.path;
    left_ = border.left;
    right_ = border.right;
    begin_ = start_of(path.front());
    end_ = end_of(path.back());
    if (begin_ == end_) return;
    // Straightening another border may have changed the sides of this one.
    if (chart_left(path.front()) != left_ || chart_left(twins_[path.front()]) != right_) return;
    if (std::ranges::none_of(path, [&](HalfEdge h) { return may_move(h) || may_move(twins_[h]); })) return;
    vertices_.clear();
    mark_band(path);
    std::uint32_t cost = 0;
    for (const HalfEdge h : path) cost += cost_of(h);
    const BorderPath better = cheapest_path(path, cost);
    if (!better.empty()) replace(better);
  }

 private:
  struct VertexState {
    enum : std::uint8_t { unknown, in_band, outside } place = unknown;
    bool reached = false;
    std::uint32_t cost = 0;
    HalfEdge arriving = kNoTwin;
  };

  [[nodiscard]] std::uint32_t start_of(HalfEdge h) const { return mesh_.faces[face_of(h)][h % 3]; }
  [[nodiscard]] std::uint32_t end_of(HalfEdge h) const { return start_of(next_in_face(h)); }
  /// Others may be changing faces of other charts meanwhile.
  [[nodiscard]] std::atomic_ref<std::uint32_t> chart_of(std::uint32_t face) const {
    return std::atomic_ref(partition_.chart_of_face[face]);
  }
  [[nodiscard]] std::uint32_t chart_left(HalfEdge h) const {
    return chart_of(face_of(h)).load(std::memory_order_relaxed);
  }

  [[nodiscard]] std::uint32_t cost_of(HalfEdge h) const {
    const double length = edge_length(mesh_, start_of(h), end_of(h));
    if (mean_length_ == 0) return kCostPerEdge;
    return kCostPerEdge + static_cast<std::uint32_t>(std::min(64.0, length / mean_length_) * kCostPerEdge + 0.5);
  }

  [[nodiscard]] bool may_change(std::uint32_t face, std::uint32_t to) const {
    return rules_ == nullptr || rules_->allow(face, to);
  }
  /// Whether the face that a border half-edge is of may change sides.
  [[nodiscard]] bool may_move(HalfEdge h) const { return may_change(face_of(h), chart_left(twins_[h])); }

  /// The vertices of the border and those around it inside the two charts.
  void mark_band(const BorderPath& path) {
    std::vector<std::uint32_t> ring, next;
    for (std::size_t i = 1; i < path.size(); ++i) {
      vertices_[start_of(path[i])].place = VertexState::in_band;
      ring.push_back(start_of(path[i]));
    }
    for (std::uint32_t width = 0; width < kBandWidth; ++width, ring.swap(next)) {
      next.clear();
      for (const std::uint32_t v : ring)
        for_each_leaving(v, [&](HalfEdge h) {
          const std::uint32_t u = end_of(h);
          VertexState& state = vertices_[u];
          if (state.place != VertexState::unknown) return;
          state.place = is_inside(u) ? VertexState::in_band : VertexState::outside;
          if (state.place == VertexState::in_band) next.push_back(u);
        });
    }
  }

  template <class Visit>
  void for_each_leaving(std::uint32_t v, Visit&& visit) const {
    const HalfEdge first = fans_.leaving(v);
    HalfEdge h = first;
    do {
      visit(h);
      h = twins_[previous_in_face(h)];
    } while (h != first);
  }

  /// Whether all faces around a vertex are in one of the two charts.
  [[nodiscard]] bool is_inside(std::uint32_t v) const {
    const HalfEdge first = fans_.leaving(v);
    if (first == kNoTwin) return false;
    const std::uint32_t c = chart_left(first);
    if (c != left_ && c != right_) return false;
    for (HalfEdge h = twins_[previous_in_face(first)]; h != first; h = twins_[previous_in_face(h)])
      if (chart_left(h) != c) return false;
    return true;
  }

  /// The half-edges that leave the corner at the start of `h` between the two charts' other borders.
  [[nodiscard]] std::vector<HalfEdge> sector(HalfEdge h, std::uint32_t left, std::uint32_t right) const {
    std::vector<HalfEdge> leaving{h};
    for (HalfEdge g = twins_[previous_in_face(h)]; g != kNoTwin && g != h && chart_left(g) == left;
         g = twins_[previous_in_face(g)])
      leaving.push_back(g);
    for (HalfEdge g = twins_[h]; g != kNoTwin && chart_left(g) == right;) {
      const HalfEdge out = next_in_face(g);
      if (out == h || twins_[out] == kNoTwin || chart_left(twins_[out]) != right) break;
      leaving.push_back(out);
      g = twins_[out];
    }
    return leaving;
  }

  /// A path from corner to corner in the band that costs less than `most`, or nothing.
  [[nodiscard]] BorderPath cheapest_path(const BorderPath& path, std::uint32_t most) {
    std::vector<HalfEdge> arriving_at_end;
    for (const HalfEdge h : sector(twins_[path.back()], right_, left_)) arriving_at_end.push_back(twins_[h]);
    queue_ = {};
    for (const HalfEdge h : sector(path.front(), left_, right_)) reach(h, 0, most, arriving_at_end);
    while (!queue_.empty()) {
      const auto [least, v] = queue_.top();
      const auto cost = least;  // clang does not let lambdas have names of parts
      queue_.pop();
      if (cost != vertices_[v].cost) continue;
      if (v == end_) return path_to_end();
      for_each_leaving(v, [&](HalfEdge h) { reach(h, cost, most, arriving_at_end); });
    }
    return {};
  }

  void reach(HalfEdge h, std::uint32_t cost_before, std::uint32_t most, const std::vector<HalfEdge>& arriving_at_end) {
    if (h == kNoTwin || twins_[h] == kNoTwin) return;
    const std::uint32_t u = end_of(h), cost = cost_before + cost_of(h);
    const bool ends =
        u == end_ && std::find(arriving_at_end.begin(), arriving_at_end.end(), h) != arriving_at_end.end();
    if (cost >= most || (!ends && (u == end_ || u == begin_))) return;
    VertexState& state = vertices_[u];
    if (!ends && state.place != VertexState::in_band) return;
    const bool tie = state.reached && cost == state.cost && start_of(h) < start_of(state.arriving);
    if (state.reached && cost >= state.cost && !tie) return;
    if (!tie) queue_.push({cost, u});
    state.reached = true;
    state.cost = cost;
    state.arriving = h;
  }

  [[nodiscard]] BorderPath path_to_end() const {
    BorderPath path;
    for (std::uint32_t v = end_; v != begin_; v = start_of(path.back())) path.push_back(vertices_.find(v)->arriving);
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// Gives the faces right of the new path to the right chart, those left of it to the left one, unless sizes forbid.
  void replace(const BorderPath& path) {
    on_path_.clear();
    for (const HalfEdge h : path) on_path_.insert(on_path_.end(), {h, twins_[h]});
    std::ranges::sort(on_path_);
    changed_.clear();
    bool fits = true;
    for (const HalfEdge h : path) {
      fits = fits && flood(face_of(twins_[h]), left_, right_);
      fits = fits && flood(face_of(h), right_, left_);
    }
    if (!fits || !sizes_fit()) undo();
  }

  [[nodiscard]] bool flood(std::uint32_t seed, std::uint32_t from, std::uint32_t to) {
    if (chart_left(3 * seed) != from) return true;
    if (!may_change(seed, to)) return false;
    open_.assign(1, seed);
    change(seed, from, to);
    while (!open_.empty()) {
      const std::uint32_t f = open_.back();
      open_.pop_back();
      for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
        if (twins_[h] == kNoTwin || chart_left(twins_[h]) != from || std::ranges::binary_search(on_path_, h)) continue;
        if (changed_.size() >= limits_.target || !may_change(face_of(twins_[h]), to)) return false;
        change(face_of(twins_[h]), from, to);
        open_.push_back(face_of(twins_[h]));
      }
    }
    return true;
  }

  void change(std::uint32_t face, std::uint32_t from, std::uint32_t to) {
    chart_of(face).store(to, std::memory_order_relaxed);
    --partition_.sizes[from];
    ++partition_.sizes[to];
    changed_.push_back(face);
    grown_left_ += to == left_ ? 1 : -1;
  }

  /// A chart that is outside the limits already may not get worse.
  [[nodiscard]] bool sizes_fit() {
    const std::int64_t grown = std::exchange(grown_left_, 0);
    const auto fits = [&](std::uint32_t chart, std::int64_t growth) {
      const std::uint32_t size = partition_.sizes[chart];
      return size > 0 && (growth <= 0 || size <= limits_.cap) && (growth >= 0 || size >= limits_.hard_floor);
    };
    return fits(left_, grown) && fits(right_, -grown);
  }

  void undo() {
    grown_left_ = 0;
    for (auto it = changed_.rbegin(); it != changed_.rend(); ++it) {
      const std::uint32_t was = chart_left(3 * *it), is = was == left_ ? right_ : left_;
      --partition_.sizes[was];
      ++partition_.sizes[is];
      chart_of(*it).store(is, std::memory_order_relaxed);
    }
  }

  const IndexedMesh& mesh_;
  const std::vector<HalfEdge>& twins_;
  const ClosedFans& fans_;
  double mean_length_;
  const SizeLimits& limits_;
  Partition& partition_;
  const MoveRules* rules_;
  std::uint32_t left_ = 0, right_ = 0, begin_ = 0, end_ = 0;
  VertexScratch<VertexState> vertices_;
  std::vector<HalfEdge> on_path_;  ///< the new path both ways, ascending
  using Entry = std::pair<std::uint32_t, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<std::uint32_t> open_, changed_;
  std::int64_t grown_left_ = 0;
};

}  // namespace

BorderStraightener::BorderStraightener(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins)
    : mesh_(mesh), twins_(twins), fans_(mesh, twins) {
  if (twins.empty()) return;
  double sum = 0;
  for (const Triangle& t : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) sum += edge_length(mesh, t[i], t[i == 2 ? 0 : i + 1]);
  mean_length_ = sum / static_cast<double>(twins.size());
}

void BorderStraightener::run(const SizeLimits& limits, Partition& partition, const MoveRules* rules, unsigned threads,
                             const Progress& progress) const {
  report(progress, 0);
  std::vector<Straightener> workers(std::max(threads, 1U),
                                    {mesh_, twins_, fans_, mean_length_, limits, partition, rules});
  const std::vector<std::uint32_t>& chart_of_face = partition.chart_of_face;
  auto borders = between_charts(trace_borders(mesh_, twins_, fans_, chart_of_face), twins_, chart_of_face);
  report(progress, 0.5);
  work_in_turns(std::move(borders), partition.sizes.size(), workers,
                [](Straightener& worker, const BorderBetween& border) { worker.straighten(border); });
}

}  // namespace ramcdb::chartify
