#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fast_plan.h"

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
    nodes_.resize(std::size_t{max_vertices_} + outline.joins);
    plan_.faces.resize(outline.counts.faces);
    plan_.places.resize(outline.counts.inner_vertices);
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
      for (std::uint32_t i = 0; i < size; ++i) link(first + i, first + (i + 1) % size);
      first += size;
    }
    vertices_ = first;
    for (std::uint32_t end = first, i = static_cast<std::uint32_t>(outline_.loop_sizes.size()); i-- > 0;)
      loops_.push_back(end -= outline_.loop_sizes[i]);
  }

  void begin_at_seed() {
    const std::uint32_t first_vertex = vertices_, first = used_;
    for (int i = 0; i < 3; ++i) (void)add_free_vertex();
    add_face(first_vertex, first_vertex + 1, first_vertex + 2);
    source_.seed_placed(first_vertex, first);
    // The front runs around the seed the other way: a, c, b.
    for (const std::uint32_t i : {0u, 2u, 1u}) {
      const std::uint32_t degree = source_.seed_degree(first_vertex + i);
      add_node(first_vertex + i, first_vertex, 1, degree - 1);
    }
    nodes_[first].behind = first_vertex + 1;
    nodes_[first + 1].behind = first_vertex;
    nodes_[first + 2].behind = first_vertex + 2;
    for (std::uint32_t i = 0; i < 3; ++i) link(first + i, first + (i + 1) % 3);
    loops_.push_back(first);
  }

  void walk_loops() {
    while (!loops_.empty()) {
      const std::uint32_t node = loops_.back();
      loops_.pop_back();
      if (nodes_[node].open > 0) walk_loop(node);
    }
  }

  void walk_loop(std::uint32_t pivot) {
    for (;;) {
      const FastNode& at = nodes_[pivot];
      const std::uint32_t before = at.prev, next = at.next;
      if (at.open == 1) {
        if (!close(pivot)) return;
        pivot = next_pivot(next);
      } else if (nodes_[before].open == 1) {
        if (!close(before)) return;
      } else if (nodes_[next].open == 1) {
        if (!close(next)) return;
      } else {
        take_step(before, pivot);
      }
    }
  }

  /// The corner among the next five that takes the fewest faces.
  [[nodiscard]] std::uint32_t next_pivot(std::uint32_t node) const {
    std::uint32_t best = node;
    for (int i = 0; i < 4; ++i) {
      node = nodes_[node].next;
      if (nodes_[node].open < nodes_[best].open) best = node;
    }
    return best;
  }

  /// The last face of a corner. False when that was the last of the loop, too.
  bool close(std::uint32_t corner) {
    FastNode& at = nodes_[corner];
    FastNode &before = nodes_[at.prev], &next = nodes_[at.next];
    add_face(before.vertex, at.vertex, next.vertex);
    source_.closed(at.prev);
    at.open = 0;
    set_behind(before, at.vertex);
    const std::uint32_t from = at.prev, to = at.next;
    link(from, to);
    --before.open;
    --next.open;
    if (before.open == 0 || next.open == 0 || next.next == from) return !end_loop(from, to);
    return true;
  }

  /// Two corners form a loop just when they take no face more. Anything else only hostile bytes describe.
  bool end_loop(std::uint32_t a, std::uint32_t b) {
    if (nodes_[a].open != 0 || nodes_[b].open != 0 || nodes_[a].next != b || nodes_[b].next != a)
      refuse("has a corner with more or fewer faces than it says");
    return true;
  }

  /// The face at the edge from `before` to the pivot, with a third vertex that is new or joined.
  void take_step(std::uint32_t before, std::uint32_t pivot) {
    const std::uint32_t degree = source_.step_degree(before);
    if (degree == 0) return join(before, pivot);
    if (vertices_ == max_vertices_) refuse("has more vertices than it declares");
    describe_place(nodes_[before], nodes_[pivot], nodes_[nodes_[pivot].next], nodes_[nodes_[before].prev], degree);
    const std::uint32_t vertex = vertices_++;
    add_face(nodes_[before].vertex, nodes_[pivot].vertex, vertex);
    const std::uint32_t node = add_node(vertex, nodes_[before].vertex, 1, degree - 1);
    set_behind(nodes_[before], nodes_[pivot].vertex);
    link(before, node);
    link(node, pivot);
    --nodes_[before].open;
    --nodes_[pivot].open;
    source_.vertex_placed(before, node, vertex);
  }

  /// The corner `there` is split: into what lies between pivot's side and the face, a new node, and the rest.
  void join(std::uint32_t before, std::uint32_t pivot) {
    if (joins_++ == outline_.joins) refuse("has more joins than it declares");
    const auto [there, open_here] = source_.join_target(nodes_, used_, before, pivot);
    const std::uint32_t total = nodes_[there].open;
    if (there == pivot || there == before || there == nodes_[pivot].next || there == nodes_[before].prev ||
        open_here < 1 || std::uint64_t{open_here} + 2 > total)
      refuse("joins what cannot be joined");
    const std::uint32_t vertex = nodes_[there].vertex;
    add_face(nodes_[before].vertex, nodes_[pivot].vertex, vertex);
    const std::uint32_t behind_there = nodes_[there].prev;
    const std::uint32_t here = add_node(vertex, nodes_[before].vertex, 1, open_here);
    nodes_[there].open = total - 1 - open_here;
    set_behind(nodes_[before], nodes_[pivot].vertex);
    link(behind_there, here);
    link(here, pivot);
    link(before, there);
    --nodes_[before].open;
    --nodes_[pivot].open;
    source_.joined(before, here);
    loops_.push_back(there);
  }

  void describe_place(const FastNode& p, const FastNode& v, const FastNode& n, const FastNode& pp,
                      std::uint32_t degree) {
    FastPlace& place = plan_.places[vertices_ - border_];
    place.pivot = v.vertex;
    place.around = {p.vertex, n.vertex, p.behind, v.behind, pp.vertex, pp.behind};
    const std::uint32_t open_v = std::min(v.open, 4u) - 2, open_p = std::min(p.open, 4u) - 2;
    const std::uint32_t size = std::clamp(degree, 4u, 7u) - 4;
    const std::uint32_t flags = 4 * p.has_face + 2 * v.has_face + pp.has_face;
    place.predictor = ((open_v * 3 + open_p) * 4 + size) * 8 + flags;
  }

  /// A vertex without neighbours: of a seed, or isolated.
  std::uint32_t add_free_vertex() {
    if (vertices_ == max_vertices_) refuse("has more vertices than it declares");
    plan_.places[vertices_ - border_].predictor = kFreePlace;
    return vertices_++;
  }

  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (faces_ == plan_.faces.size()) refuse("has more faces than it declares");
    if (a == b || b == c || c == a) refuse("has a face with a vertex twice");
    plan_.faces[faces_++] = {a, b, c};
  }

  std::uint32_t add_node(std::uint32_t vertex, std::uint32_t behind, std::uint32_t has_face, std::uint32_t open) {
    nodes_[used_] = {vertex, 0, 0, behind, has_face, open};
    return used_++;
  }

  static void set_behind(FastNode& node, std::uint32_t vertex) {
    node.behind = vertex;
    node.has_face = 1;
  }

  void link(std::uint32_t from, std::uint32_t to) {
    nodes_[from].next = to;
    nodes_[to].prev = from;
  }

  Source& source_;
  FastOutline outline_;
  FastPlan plan_;
  std::vector<FastNode> nodes_;
  std::vector<std::uint32_t> loops_;  ///< a node of each loop that waits, and some that have left
  std::uint32_t border_ = 0;
  std::uint32_t max_vertices_ = 0;  ///< that have faces; at the end all
  std::uint32_t vertices_ = 0;
  std::uint32_t faces_ = 0;
  std::uint32_t joins_ = 0;
  std::uint32_t used_ = 0;  ///< nodes made so far: one per vertex with faces, one per join
};

}  // namespace ramcdb::codec
