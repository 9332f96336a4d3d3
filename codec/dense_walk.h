#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/dense_front.h"
#include "codec/dense_join.h"
#include "codec/dense_models.h"
#include "codec/dense_predictor.h"
#include "codec/dense_surface.h"
#include "codec/tables.h"

namespace ramcdb::codec {

/// What encoder and decoder both know before the first bit.
struct DenseContext {
  std::span<const LatticePoint> border;
  std::span<const std::uint32_t> loop_sizes;
  ChartCounts counts;
  ChartCounts expected;   ///< counts that memory is taken for in advance
  int edge_exponent = 0;  ///< edges are about 2^edge_exponent long
  LatticeBox box;         ///< of all inner vertices
  bool aligned = false;   ///< coordinates are first looked for among those of neighbours
  const CoderTables* tables = nullptr;
};

/// Coordinates that missed their predictions, and those of them that vertices around have: candidates of aligned
/// charts.
struct DenseMisses {
  std::uint64_t all = 0, aligned = 0;
  std::uint64_t aligned_bits = 0;  ///< the bit widths of the aligned misses
};

/// The walk over a chart, from the border inwards, for encoder and decoder alike (Coder and Guide decide which).
///
/// The front starts as all border loops. Again and again the node with the smallest open corner becomes the pivot: the
/// number of edges inside its corner is coded, then the faces of the corner from the first side to the last, each with
/// a new vertex (position coded) or one that the front has elsewhere (a join, which splits or merges loops); the last
/// face closes the corner, and the pivot leaves the front. Where two nodes alone form a loop, their edges are one, and
/// both leave. When the front is empty and faces are left, a closed component begins with an explicit face. Vertices
/// without faces come at the end.
///
///   chart    = component*  closed_component*  isolated_vertex*
///   component        = fan*                     until the front is empty
///   closed_component = 3 x 3 seed  fan*         while faces are left
///   fan      = size  ( join_flag ( join | position ) ){size}
///   position = ( [aligned] | miss ){3}          aligned only in aligned charts: which candidate, if one
///   isolated_vertex = 3 differences             while vertices are left
///
/// Free-valence fans as in F. Kaelberer, K. Polthier, U. Reitebuch, M. Wardetzky, "FreeLence - Coding with Free
/// Valences" (2005), from the border inwards; positions are interleaved and choose the order, as in H. Lee, P. Alliez,
/// M. Desbrun, "Angle-Analyzer" (2002).
template <class Coder, class Guide>
class DenseWalk {
 public:
  DenseWalk(Coder& coder, Guide& guide, const DenseContext& context)
      : coder_(coder),
        guide_(guide),
        context_(context),
        surface_(context.border, context.counts, context.expected),
        join_search_(surface_, front_, std::min(context.edge_exponent + 1, 31)),
        models_(std::make_unique<DenseModels>(DenseModels::built_in(is_fine()))),
        fine_bits_(std::max(0, context.edge_exponent - kScaledFrom)),
        scale_(1 / static_cast<float>(std::uint64_t{1} << fine_bits_)) {
    front_.reserve(context.border.size() + context.expected.inner_vertices + 16);
  }

  /// Codes the chart. Throws corrupt when the stream describes none.
  void run() {
    begin_at_border();
    walk_front();
    while (!surface_.has_all_faces()) {
      begin_at_seed();
      walk_front();
    }
    while (!surface_.has_all_vertices()) code_isolated();
  }

  /// What was coded; may be taken apart after run().
  [[nodiscard]] DenseSurface& surface() { return surface_; }
  [[nodiscard]] DenseModels& models() { return *models_; }
  /// Whether edges are so long that models for fine lattices are used.
  [[nodiscard]] bool is_fine() const { return context_.edge_exponent > kScaledFrom; }
  /// Of encoders only.
  [[nodiscard]] const DenseMisses& misses() const { return misses_; }
  /// What positions took, in 1/256 bit; the rest is connectivity.
  [[nodiscard]] std::uint64_t geometry_cost() const { return geometry_cost_; }

 private:
  /// Contexts are made for edges below this; longer ones count as that long, and misses shrink with them.
  static constexpr int kScaledFrom = 7;

  void begin_at_border() {
    std::uint32_t first = 0;
    for (const std::uint32_t size : context_.loop_sizes) {
      const LatticePoint origin = context_.border[0];
      for (std::uint32_t i = 0; i < size; ++i) {
        const Vec from = difference(context_.border[first + i], origin);
        const Vec to = difference(context_.border[first + (i + 1) % size], origin);
        loops_area_ = loops_area_ + cross(from, to);
      }
      add_ring(first, size);
      first += size;
    }
    for (std::uint32_t node = 0; node < first; ++node) guide_.on_border(node);
    for (std::uint32_t node = first; node-- > 0;) requeue(node);
  }

  void add_ring(std::uint32_t first_vertex, std::uint32_t size) {
    const std::uint32_t first_node = front_.node_count();
    for (std::uint32_t i = 0; i < size; ++i) add_node(first_vertex + i, kNone);
    for (std::uint32_t i = 0; i < size; ++i) front_.link(first_node + i, first_node + (i + 1) % size);
  }

  void begin_at_seed() {
    const std::array<LatticePoint, 3> corners = guide_.next_seed();
    const std::uint32_t a = surface_.vertex_count();
    for (const LatticePoint corner : corners) code_free_position(models_->seed, corner);
    surface_.add_face(a, a + 1, a + 2);
    const std::uint32_t first = add_node(a, a + 1);
    add_node(a + 2, a);
    add_node(a + 1, a + 2);
    for (std::uint32_t i = 0; i < 3; ++i) front_.link(first + i, first + (i + 1) % 3);
    guide_.seed_placed(a, first);
    for (std::uint32_t i = 0; i < 3; ++i) requeue(first + i);
  }

  void code_isolated() { code_free_position(models_->isolated, guide_.next_isolated(surface_.next_vertex())); }

  void walk_front() {
    for (std::uint32_t pivot = front_.pop(); pivot != kNone; pivot = front_.pop()) code_fan(pivot);
  }

  void code_fan(std::uint32_t pivot) {
    FanPlace place;
    place.pivot = front_[pivot].vertex;
    place.angle = front_[pivot].angle;
    std::uint32_t current = front_[pivot].prev;
    const std::uint32_t inside = code_fan_size(pivot, place);
    begin_touching(inside);
    touch(current);
    if (inside > 0) place.normal = unit_or(normal_at(pivot), {0, 0, 1});
    place.behind_current = front_[current].opposite;
    for (place.edges_left = inside; place.edges_left > 0; --place.edges_left) {
      place.current = front_[current].vertex;
      place.next = front_[front_[pivot].next].vertex;
      place.behind_next = front_[pivot].opposite;
      if (place.edges_left != inside) {
        place.normal = unit_or(surface_[place.pivot].normal, place.normal);
        place.angle = open_angle(place);
      }
      current = code_apex(pivot, current, place);
      place.behind_current = place.current;
    }
    close_fan(pivot, current);
    for (std::size_t i = 0; i < touched_count_; ++i)
      if (front_[touched_[i]].live != kNone) requeue(touched_[i]);
  }

  /// Makes room for the nodes whose corners a fan changes: two of each new vertex or join, and those at the sides.
  void begin_touching(std::uint32_t inside) {
    if (touched_.size() < 2 * std::size_t{inside} + 2) touched_.resize(2 * std::size_t{inside} + 2);
    touched_count_ = 0;
  }
  void touch(std::uint32_t node) { touched_[touched_count_++] = node; }

  std::uint32_t code_fan_size(std::uint32_t pivot, const FanPlace& place) {
    const std::uint32_t inside = guide_.begin_fan(front_[pivot].prev, pivot);
    return models_->fan_size.code(coder_, place.angle, surface_[place.pivot].faces, surface_.on_border(place.pivot),
                                  surface_.faces_left(), inside);
  }

  /// Codes the face at the edge from `current` to the pivot; returns the node of its third vertex next to the pivot.
  std::uint32_t code_apex(std::uint32_t pivot, std::uint32_t current, const FanPlace& place) {
    auto& join_flag =
        models_->join[std::min(place.edges_left, 4u) - 1][std::min<std::size_t>(15, front_.live().size() / 2)];
    if (coder_.code(join_flag, guide_.apex_is_known())) return join(pivot, current, place);

    const std::uint32_t vertex = surface_.next_vertex();
    code_position(place, guide_.apex());
    guide_.apex_placed(vertex);
    surface_.add_face(place.current, place.pivot, vertex);
    const std::uint32_t node = add_node(vertex, place.current);
    front_.link(current, node);
    front_.link(node, pivot);
    front_.set_opposite(current, place.pivot);
    guide_.face_opened(current, node);
    touch(node);
    return node;
  }

  /// The third vertex is on the front already. Its node `there` gets a twin next to the pivot.
  std::uint32_t join(std::uint32_t pivot, std::uint32_t current, const FanPlace& place) {
    join_search_.rank_near(join_target(place), {place.pivot, place.current, place.next});
    const std::uint32_t there = join_search_.code(coder_, models_->join_rank, guide_.apex_node(front_));
    const std::uint32_t vertex = front_[there].vertex;
    surface_.add_face(place.current, place.pivot, vertex);
    const std::uint32_t before = front_[there].prev;
    const std::uint32_t here = add_node(vertex, place.current);
    front_.link(before, here);
    front_.link(here, pivot);
    front_.link(current, there);
    front_.set_opposite(current, place.pivot);
    guide_.face_opened(current, here);
    touch(there);
    touch(here);
    remove_if_pair(current);
    return here;
  }

  void close_fan(std::uint32_t pivot, std::uint32_t current) {
    const std::uint32_t next = front_[pivot].next, vertex = front_[pivot].vertex;
    surface_.add_face(front_[current].vertex, vertex, front_[next].vertex);
    front_.link(current, next);
    front_.set_opposite(current, vertex);
    guide_.fan_closed(current);
    remove_node(pivot);
    touch(next);
    remove_if_pair(current);
  }

  void remove_if_pair(std::uint32_t node) {
    const std::uint32_t other = front_[node].next;
    if (front_[other].next != node) return;
    remove_node(node);
    remove_node(other);
  }

  std::uint32_t add_node(std::uint32_t vertex, std::uint32_t opposite) {
    const std::uint32_t node = front_.add(vertex, opposite);
    join_search_.entered(node);
    return node;
  }

  void remove_node(std::uint32_t node) {
    join_search_.left(node);
    front_.remove(node);
  }

  void requeue(std::uint32_t node) {
    const auto [to_next, to_prev] = sides(node);
    front_.queue(node, corner_angle(to_next, to_prev, normal_at(node)));
  }

  [[nodiscard]] std::uint32_t open_angle(const FanPlace& place) const {
    const DenseVertex& pivot = surface_[place.pivot];
    return corner_angle(difference(surface_[place.next], pivot), difference(surface_[place.current], pivot),
                        place.normal);
  }

  /// From a node to the next one and to the one before.
  [[nodiscard]] std::pair<Vec, Vec> sides(std::uint32_t node) const {
    const FrontNode& n = front_[node];
    const DenseVertex& vertex = surface_[n.vertex];
    return {difference(surface_[front_[n.next].vertex], vertex), difference(surface_[front_[n.prev].vertex], vertex)};
  }

  /// A vector along the surface normal at a node: of its own decoded faces or else of the nearest along the front that
  /// have any, or else of all loops together.
  [[nodiscard]] Vec normal_at(std::uint32_t node) const {
    const Vec own = surface_[front_[node].vertex].normal;
    if (squared_length(own) > 0) return own;
    std::uint32_t left = front_[node].prev, right = front_[node].next;
    for (int step = 0; step < 8; ++step) {
      const Vec both = surface_[front_[left].vertex].normal + surface_[front_[right].vertex].normal;
      if (squared_length(both) > 0) return both;
      left = front_[left].prev;
      right = front_[right].next;
    }
    return loops_area_;
  }

  /// Where a join is looked for: the parallelogram of the corner, at half its size.
  [[nodiscard]] LatticePoint join_target(const FanPlace& place) const {
    const LatticePoint p = surface_[place.pivot].position;
    LatticePoint target;
    for (int a = 0; a < 3; ++a) {
      const std::int64_t sum = std::int64_t{surface_[place.current].position[a]} + surface_[place.next].position[a];
      target[a] = clamp_to_lattice(p[a] + ((sum - 2 * std::int64_t{p[a]} + 1) >> 1));
    }
    return target;
  }

  static std::int32_t clamp_to_lattice(std::int64_t x) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(x, -kMaxLatticeCoordinate, kMaxLatticeCoordinate));
  }

  void code_position(const FanPlace& place, LatticePoint actual) {
    if constexpr (requires { coder_.observe(surface_, place, actual); }) {
      coder_.observe(surface_, place, actual);  // training, not coding
      surface_.add_vertex({actual});
      return;
    }
    const std::uint64_t before = coder_.position();
    const FanPrediction prediction(surface_, *context_.tables, place, scale_);
    const auto pivot = lanes(surface_[place.pivot].position), wanted = lanes(actual);
    std::array<std::int32_t, 3> point{};
    std::array<float, 3> sizes{}, known{};
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k), lane = static_cast<std::size_t>(prediction.axis(k));
      const auto [guess, doubt] = k < 2 ? prediction.first_guess(k) : prediction.last_guess(known[0], known[1]);
      const std::int32_t step = round_half_up(guess);
      const std::int32_t rounded = clamp_to_lattice(std::int64_t{pivot[lane]} + step);
      std::int32_t miss = Coder::kEncodes ? wanted[lane] - rounded : 0;
      const std::optional<std::int32_t> found =
          context_.aligned ? code_aligned(place, k, prediction.axis(k), wanted[lane]) : std::nullopt;
      if (found) {
        miss = *found - rounded;
      } else {
        if (Coder::kEncodes && miss != 0) count_miss(miss, is_aligned(place, prediction.axis(k), wanted[lane]));
        // Towards where the guess was rounded from is plus.
        const bool flip = guess < static_cast<float>(step);
        miss = models_->miss.code(coder_, at, doubt, prediction.activity(k), fine_bits_, flip ? -miss : miss);
        if (flip) miss = static_cast<std::int32_t>(0U - static_cast<std::uint32_t>(miss));
      }
      point[lane] = in_box(std::int64_t{rounded} + miss, lane);
      known[at] = static_cast<float>(point[lane] - pivot[lane]);
      sizes[at] = std::abs(static_cast<float>(miss));
    }
    DenseVertex vertex{std::bit_cast<LatticePoint>(point)};
    vertex.tangential = sizes[0] + sizes[1];
    vertex.normal_miss = 2 * sizes[2];
    surface_.add_vertex(vertex);
    geometry_cost_ += coder_.position() - before;
  }

  void count_miss(std::int32_t miss, bool aligned) {
    ++misses_.all;
    if (!aligned) return;
    ++misses_.aligned;
    misses_.aligned_bits += static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(std::abs(miss))));
  }

  /// Coordinates that vertices around have, and the one that completes a parallelogram with them.
  [[nodiscard]] std::array<std::int32_t, 4> aligned_candidates(const FanPlace& place, int axis) const {
    const std::int32_t c = surface_[place.current].position[axis], x = surface_[place.next].position[axis],
                       p = surface_[place.pivot].position[axis];
    return {c, x, p, clamp_to_lattice(std::int64_t{c} + x - p)};
  }

  [[nodiscard]] bool is_aligned(const FanPlace& place, int axis, std::int32_t coordinate) const {
    const auto candidates = aligned_candidates(place, axis);
    return std::find(candidates.begin(), candidates.end(), coordinate) != candidates.end();
  }

  /// The k-th coordinate of a position, if it is one of the candidates.
  std::optional<std::int32_t> code_aligned(const FanPlace& place, int k, int axis, std::int32_t actual) {
    const auto candidates = aligned_candidates(place, axis);
    if (k == 0) found_before_ = {candidates.size(), candidates.size()};
    auto& bits = models_->aligned[static_cast<std::size_t>(k)][found_before_[0]][found_before_[1]];
    std::size_t found = 0;
    for (auto at = candidates.begin(); at != candidates.end(); ++at, ++found) {
      if (std::find(candidates.begin(), at, *at) != at) continue;  // known not to be it
      if (coder_.code(bits[found], actual == *at)) break;
    }
    found_before_ = {found, found_before_[0]};
    return found == candidates.size() ? std::nullopt : std::optional(candidates[found]);
  }

  /// A position without neighbours, as the difference to the vertex before.
  void code_free_position(std::array<AdaptiveSigned, 3>& models, LatticePoint actual) {
    const std::uint64_t before = coder_.position();
    const std::uint32_t count = surface_.vertex_count();
    const LatticePoint anchor = count == 0 ? context_.box.lo : surface_[count - 1].position;
    LatticePoint point;
    for (int a = 0; a < 3; ++a) {
      const std::int32_t step = models[static_cast<std::size_t>(a)].code(coder_, actual[a] - anchor[a]);
      point[a] = in_box(std::int64_t{anchor[a]} + step, static_cast<std::size_t>(a));
    }
    surface_.add_vertex({point});
    geometry_cost_ += coder_.position() - before;
  }

  /// A point as its three coordinates, to be indexed without branches.
  static std::array<std::int32_t, 3> lanes(LatticePoint p) { return std::bit_cast<std::array<std::int32_t, 3>>(p); }

  std::int32_t in_box(std::int64_t coordinate, std::size_t axis) const {
    if (coordinate < lo_[axis] || coordinate > hi_[axis])
      throw Error(Errc::corrupt, "a chart's vertex lies outside of the chart's range");
    return static_cast<std::int32_t>(coordinate);
  }

  Coder& coder_;
  Guide& guide_;
  const DenseContext& context_;
  DenseSurface surface_;
  DenseFront front_;
  JoinSearch join_search_;
  std::unique_ptr<DenseModels> models_;
  int fine_bits_;
  float scale_;
  std::array<std::int32_t, 3> lo_ = lanes(context_.box.lo), hi_ = lanes(context_.box.hi);
  Vec loops_area_;
  std::array<std::size_t, 2> found_before_{};  ///< where the coordinates before of a vertex were found; 4: nowhere
  std::vector<std::uint32_t> touched_;         ///< nodes whose corners a fan changed: so many of these
  std::size_t touched_count_ = 0;
  DenseMisses misses_;
  std::uint64_t geometry_cost_ = 0;
};

}  // namespace ramcdb::codec
