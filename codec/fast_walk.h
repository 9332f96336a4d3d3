#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/vectors.h"

namespace ramcdb::codec {

/// What encoder and decoder both know before connectivity.
struct FastOutline {
  std::span<const std::uint32_t> loop_sizes;
  ChartCounts counts;
  std::uint32_t isolated = 0;  ///< vertices without faces
  std::uint32_t joins = 0;     ///< corners of the front that are split, at most: nodes beyond one per vertex
};

/// The walk over the connectivity of a chart, from the border inwards, for encoder and decoder alike (Source decides
/// which). It knows no positions.
///
/// Every corner of the front knows how many faces it still takes: those of border vertices come first, a new vertex
/// brings its own count. A corner that takes one face more has it, between its two neighbours: nothing needs to be said
/// and nothing can go wrong, since the counts are those of the chart. Where none of the corners at hand is that far,
/// the next face at the pivot has a new vertex or, rarely, one that the front has elsewhere (a join, which splits or
/// merges loops, and its vertex's corner in two). Two corners that take no face more are left together: their edges are
/// one.
///
///   connectivity = degree{border} component* closed_component*
///   component        = step*                      until its loops are closed
///   step             = degree | join              at the pivot, when no corner at hand takes one face only
///   closed_component = degree{3} step*            while faces are left
///
/// After C. Touma, C. Gotsman, "Triangle mesh compression" (1998), and P. Alliez, M. Desbrun, "Valence-driven
/// connectivity encoding for 3D meshes" (2001), from the border inwards and with its degrees in front.
template <class Source>
class FastWalk {
 public:
  FastWalk(Source& source, const FastOutline& outline) : source_(source), outline_(outline) {
    for (const std::uint32_t size : outline.loop_sizes) border_ += size;
    max_vertices_ = border_ + outline.counts.inner_vertices - outline.isolated;
    nodes_ = RawArray<FastNode>(std::size_t{max_vertices_} + outline.joins);
    plan_.faces.resize(outline.counts.faces);
    plan_.places = RawArray<FastPlace>(outline.counts.inner_vertices);
  }

  /// Throws corrupt when the source describes no chart of these counts.
  FastPlan run() {
    begin_at_border();
    walk_loops();
    while (faces_ < outline_.counts.faces) {
      begin_at_seed();
      walk_loops();
    }
    if (vertices_ != max_vertices_) refuse("has fewer vertices than it declares");
    max_vertices_ += outline_.isolated;
    while (vertices_ < max_vertices_) source_.isolated_placed(add_free_vertex());
    plan_.joins = joins_;
    return std::move(plan_);
  }

 private:
  [[noreturn]] static void refuse(const char* problem) {
    throw Error(Errc::corrupt, std::string("a chart ") + problem);
  }

  void begin_at_border() {
    std::uint32_t first = 0;
    for (const std::uint32_t size : outline_.loop_sizes) {
      for (std::uint32_t v = first; v < first + size; ++v) add_node(v, v, 0, source_.border_degree(v));
      link_ring(first, size);
      first += size;
    }
    vertices_ = first;
    for (std::uint32_t end = first, i = static_cast<std::uint32_t>(outline_.loop_sizes.size()); i-- > 0;)
      loops_.push_back(&nodes_[end -= outline_.loop_sizes[i]]);
  }

  void begin_at_seed() {
    const std::uint32_t first_vertex = vertices_, first = used_;
    for (int i = 0; i < 3; ++i) (void)add_free_vertex();
    Cursor at = cursor();
    add_face(at, first_vertex, first_vertex + 1, first_vertex + 2);
    faces_ = at.face;
    source_.seed_placed(first_vertex, first);
    // The front runs around the seed the other way: a, c, b.
    for (const std::uint32_t i : {0u, 2u, 1u}) {
      const std::uint32_t degree = source_.seed_degree(first_vertex + i);
      add_node(first_vertex + i, first_vertex, 1, degree - 1);
    }
    nodes_[first].behind = first_vertex + 1;
    nodes_[first + 1].behind = first_vertex;
    nodes_[first + 2].behind = first_vertex + 2;
    link_ring(first, 3);
    loops_.push_back(&nodes_[first]);
  }

  void walk_loops() {
    while (!loops_.empty()) {
      FastNode* const node = loops_.back();
      loops_.pop_back();
      if (node->open > 0) walk_loop(node);
    }
  }

  /// What the loop over faces counts in registers.
  struct Cursor {
    FastPlace* places = nullptr;
    Triangle* faces = nullptr;
    std::uint32_t face = 0;
    std::uint32_t last_face = 0;
    std::uint32_t vertex = 0;
    FastNode* new_node = nullptr;
  };

  [[nodiscard]] Cursor cursor() {
    return {plan_.places.data(), plan_.faces.data(), faces_, outline_.counts.faces, vertices_, nodes_.data() + used_};
  }
  void keep(const Cursor& at) {
    faces_ = at.face;
    vertices_ = at.vertex;
    used_ = number_of(at.new_node);
  }

  void walk_loop(FastNode* pivot) {
    Cursor at = cursor();
    for (;;) {
      FastNode *const before = pivot->prev, *const next = pivot->next;
      if (pivot->open == 1) {
        if (!close(at, pivot, before, next)) break;
        pivot = next_pivot(next);
      } else if (before->open == 1) {
        if (!close(at, before, before->prev, pivot)) break;
      } else if (next->open == 1) {
        if (!close(at, next, pivot, next->next)) break;
      } else if (const std::uint32_t degree = source_.step_degree(number_of(before)); degree > 0) [[likely]] {
        place_vertex(at, *before, *pivot, degree);
      } else {
        keep(at);
        join(*before, *pivot);
        at = cursor();
      }
    }
    keep(at);
  }

  /// The corner among the next four that takes the fewest faces; of equal ones the first.
  [[nodiscard]] static RAMCDB_INLINE FastNode* next_pivot(FastNode* node) {
    std::array<FastNode*, 4> nodes;
    std::uint32_t fewest = ~std::uint32_t{0};  // no branches: nobody could guess them
    for (std::uint32_t i = 0; i < nodes.size(); ++i, node = node->next) {
      nodes[i] = node;
      fewest = std::min(fewest, 8 * node->open + i);
    }
    return nodes[fewest % 8];
  }

  /// The last face of a corner. False when that was the last of the loop, too.
  RAMCDB_INLINE bool close(Cursor& at, FastNode* corner, FastNode* before, FastNode* next) {
    add_face(at, before->vertex, corner->vertex, next->vertex);
    source_.closed(number_of(before));
    corner->open = 0;
    before->behind = corner->vertex;
    before->has_face = 1;
    before->next = next;
    next->prev = before;
    const std::uint32_t open_before = --before->open, open_next = --next->open;
    if (open_before == 0 || open_next == 0 || next->next == before) [[unlikely]]
      return !end_loop(*before, *next);
    return true;
  }

  /// Two corners form a loop just when they take no face more. Anything else only hostile bytes describe.
  static bool end_loop(const FastNode& a, const FastNode& b) {
    if (a.open != 0 || b.open != 0 || a.next != &b || b.next != &a)
      refuse("has a corner with more or fewer faces than it says");
    return true;
  }

  /// The face at the edge from `before` to the pivot, with a third vertex that is new.
  RAMCDB_INLINE void place_vertex(Cursor& at, FastNode& before, FastNode& pivot, std::uint32_t degree) {
    if (at.vertex == max_vertices_) [[unlikely]]
      refuse("has more vertices than it declares");
    at.places[at.vertex - border_] = place_of(before, pivot, degree);
    add_face(at, before.vertex, pivot.vertex, at.vertex);
    FastNode* const node = at.new_node++;
    *node = {at.vertex, before.vertex, &before, &pivot, degree - 1, 1};
    before.behind = pivot.vertex;
    before.has_face = 1;
    before.next = pivot.prev = node;
    --before.open;
    --pivot.open;
    source_.vertex_placed(number_of(&before), number_of(node), at.vertex++);
  }

  static RAMCDB_INLINE FastPlace place_of(const FastNode& p, const FastNode& v, std::uint32_t degree) {
    const FastNode &n = *v.next, &pp = *p.prev;
    const std::uint32_t open_v = std::min(v.open, 4u) - 2, open_p = std::min(p.open, 4u) - 2;
    const std::uint32_t size = std::clamp(degree, 4u, 7u) - 4;
    const std::uint32_t flags = 4 * p.has_face + 2 * v.has_face + pp.has_face;
    return {v.vertex,
            {p.vertex, n.vertex, p.behind, v.behind, pp.vertex, pp.behind},
            ((open_v * 3 + open_p) * 4 + size) * 8 + flags};
  }

  /// The corner `there` is split: into what lies between pivot's side and the face, a new node, and the rest.
  void join(FastNode& before, FastNode& pivot) {
    if (joins_++ == outline_.joins) refuse("has more joins than it declares");
    const auto [there, open_here] = source_.join_target(std::span(nodes_.data(), used_), before, pivot);
    if (there == &pivot || there == &before || there == pivot.next || there == before.prev || open_here < 1 ||
        std::uint64_t{open_here} + 2 > there->open)
      refuse("joins what cannot be joined");
    Cursor at = cursor();
    add_face(at, before.vertex, pivot.vertex, there->vertex);
    faces_ = at.face;
    FastNode& here = add_node(there->vertex, before.vertex, 1, open_here);
    there->open -= 1 + open_here;
    before.behind = pivot.vertex;
    before.has_face = 1;
    link(*there->prev, here);
    link(here, pivot);
    link(before, *there);
    --before.open;
    --pivot.open;
    source_.joined(number_of(&before), number_of(&here));
    loops_.push_back(there);
  }

  /// A vertex without neighbours: of a seed, or isolated.
  std::uint32_t add_free_vertex() {
    if (vertices_ == max_vertices_) refuse("has more vertices than it declares");
    plan_.places[vertices_ - border_].predictor = kFreePlace;
    return vertices_++;
  }

  static RAMCDB_INLINE void add_face(Cursor& at, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (at.face == at.last_face) [[unlikely]]
      refuse("has more faces than it declares");
    if (a == b || b == c || c == a) [[unlikely]]
      refuse("has a face with a vertex twice");
    at.faces[at.face++] = {a, b, c};
  }

  FastNode& add_node(std::uint32_t vertex, std::uint32_t behind, std::uint32_t has_face, std::uint32_t open) {
    nodes_[used_] = {vertex, behind, nullptr, nullptr, open, has_face};
    return nodes_[used_++];
  }
  [[nodiscard]] std::uint32_t number_of(const FastNode* node) const {
    return static_cast<std::uint32_t>(node - nodes_.data());
  }

  static void link(FastNode& from, FastNode& to) {
    from.next = &to;
    to.prev = &from;
  }
  void link_ring(std::uint32_t first, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i) link(nodes_[first + i], nodes_[first + (i + 1) % size]);
  }

  Source& source_;
  FastOutline outline_;
  FastPlan plan_;
  RawArray<FastNode> nodes_;
  std::vector<FastNode*> loops_;  ///< a node of each loop that waits, and some that have left
  std::uint32_t border_ = 0;
  std::uint32_t max_vertices_ = 0;  ///< that have faces; at the end all
  std::uint32_t vertices_ = 0;
  std::uint32_t faces_ = 0;
  std::uint32_t joins_ = 0;
  std::uint32_t used_ = 0;  ///< nodes made so far: one per vertex with faces, one per join
};

}  // namespace ramcdb::codec
