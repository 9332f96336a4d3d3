#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "ramcdb/snapshot.h"

namespace ramcdb::test {

/// A region in the hands of a program that may do anything to it but at its outer edges: what it is now, and what of
/// the region each part was. Every change is refused (and nothing done) where it would tear outer edges.
class Sketch {
  const RegionMesh* region_;

 public:
  static constexpr std::uint32_t kNew = ~std::uint32_t{0};
  using Random = std::mt19937;

  std::vector<LatticePoint> points;
  std::vector<std::uint32_t> vertex_was;  ///< the region's vertex, or kNew
  std::vector<bool> keep_isolated;        ///< stays without a face
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> face_was;

  explicit Sketch(const RegionMesh& region) : region_(&region), points(region.points), faces(region.faces) {
    for (std::uint32_t v = 0; v < points.size(); ++v) vertex_was.push_back(v);
    for (std::uint32_t f = 0; f < faces.size(); ++f) face_was.push_back(f);
    std::vector<bool> used = used_vertices();
    for (const bool u : used) keep_isolated.push_back(!u);
    outer_before_ = outer_counts();
  }
  /// Nothing of the region yet.
  static Sketch blank(const RegionMesh& region) {
    Sketch sketch(region);
    sketch.points.clear();
    sketch.vertex_was.clear();
    sketch.keep_isolated.clear();
    sketch.faces.clear();
    sketch.face_was.clear();
    return sketch;
  }

  [[nodiscard]] const RegionMesh& region() const { return *region_; }

  std::uint32_t add_vertex(LatticePoint p, std::uint32_t was = kNew, bool isolated = false) {
    points.push_back(p);
    vertex_was.push_back(was);
    keep_isolated.push_back(isolated);
    return static_cast<std::uint32_t>(points.size() - 1);
  }
  void add_face(const Triangle& t, std::uint32_t was = kNew) {
    faces.push_back(t);
    face_was.push_back(was);
  }
  [[nodiscard]] bool on_outer_edge(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t u = vertex_was[a], v = vertex_was[b];
    return u != kNew && v != kNew &&
           std::ranges::binary_search(region_->outer_edges, std::array{std::min(u, v), std::max(u, v)});
  }
  [[nodiscard]] bool outer_edges_intact() const { return outer_counts() == outer_before_; }

  /// One random change; only with `weird` may it make more places that are not manifold, degenerate or duplicate.
  void change(Random& random, bool weird) {
    if (faces.empty()) return add_grid(random);
    const Sketch before = *this;
    switch (random() % (weird ? 16 : 12)) {
      case 0:
        split_faces(random, 1 + random() % 8);
        break;
      case 1:
        split_faces(random, 1 + random() % (1 + faces.size()));
        break;
      case 2:
        split_edges(random, 1 + random() % 20);
        break;
      case 3:
        split_edges(random, 1 + random() % (1 + faces.size()));
        break;
      case 4:
        flip_edges(random, 1 + random() % 30);
        break;
      case 5:
        collapse_edges(random, 1 + random() % 20);
        break;
      case 6:
        collapse_edges(random, 1 + random() % (1 + faces.size() / 3));
        break;
      case 7:
        cut_hole(random, 1 + random() % (1 + faces.size() / 2));
        break;
      case 8:
        fill_corners(random, 1 + random() % 20);
        break;
      case 9:
        delete_charts(random);
        break;
      case 10:
        random() % 2 ? add_grid(random) : delete_component(random);
        break;
      case 11:
        bridge(random);
        break;
      case 12:
        add_fins(random);
        break;
      case 13:
        add_odd_faces(random);
        break;
      case 14:
        cut_open(random);
        break;
      default:
        (void)add_vertex(somewhere(random), kNew, true);
        break;
    }
    if (!outer_edges_intact() || (!weird && crowded_edges() > before.crowded_edges())) *this = before;
  }

  /// Moves a share of the vertices by a few steps.
  void move(Random& random, const std::vector<bool>& may_move) {
    const std::size_t every = 1 + random() % 40;
    const int far = random() % 10 == 0 ? 3000 : 6;
    for (std::uint32_t v = 0; v < points.size(); ++v)
      if ((vertex_was[v] == kNew || may_move[vertex_was[v]]) && random() % every == 0)
        for (int axis = 0; axis < 3; ++axis)
          points[v][axis] += static_cast<std::int32_t>(random() % static_cast<unsigned>(2 * far + 1)) - far;
  }

  /// Tears an outer edge if there is one.
  bool tear(Random& random) {
    if (region_->outer_edges.empty()) return false;
    const auto edge = region_->outer_edges[random() % region_->outer_edges.size()];
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      std::size_t ends = 0;
      for (const std::uint32_t v : faces[f]) ends += vertex_was[v] == edge[0] || vertex_was[v] == edge[1];
      if (ends < 2) continue;
      erase_faces([&](std::uint32_t g) { return g == f; });
      break;
    }
    return !outer_edges_intact();
  }

  /// Vertices without faces go, but those that always were so.
  void tidy() {
    const std::vector<bool> used = used_vertices();
    std::vector<std::uint32_t> to(points.size(), kNew);
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (!used[v] && !keep_isolated[v]) continue;
      to[v] = count;
      points[count] = points[v];
      vertex_was[count] = vertex_was[v];
      keep_isolated[count++] = keep_isolated[v];
    }
    points.resize(count);
    vertex_was.resize(count);
    keep_isolated.resize(count);
    for (Triangle& t : faces)
      for (std::uint32_t& v : t) v = to[v];
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] std::vector<bool> used_vertices() const {
    std::vector<bool> used(points.size(), false);
    for (const Triangle& t : faces)
      for (const std::uint32_t v : t) used[v] = true;
    return used;
  }

  [[nodiscard]] std::vector<std::size_t> outer_counts() const {
    std::map<std::array<std::uint32_t, 2>, std::size_t> place;
    for (const auto& edge : region_->outer_edges) place.emplace(edge, place.size());
    std::vector<std::size_t> counts(place.size(), 0);
    for (const Triangle& t : faces)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t u = vertex_was[t[i]], v = vertex_was[t[(i + 1) % 3]];
        if (u == kNew || v == kNew) continue;
        if (const auto it = place.find({std::min(u, v), std::max(u, v)}); it != place.end()) ++counts[it->second];
      }
    return counts;
  }

  template <class Gone>
  void erase_faces(Gone&& gone) {
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      if (gone(f)) continue;
      faces[count] = faces[f];
      face_was[count++] = face_was[f];
    }
    faces.resize(count);
    face_was.resize(count);
  }

  [[nodiscard]] static Edge key(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
  [[nodiscard]] std::map<Edge, std::vector<std::uint32_t>> faces_at_edges() const {
    std::map<Edge, std::vector<std::uint32_t>> at;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) at[key(faces[f][i], faces[f][(i + 1) % 3])].push_back(f);
    return at;
  }
  [[nodiscard]] std::ptrdiff_t crowded_edges() const {
    return std::ranges::count_if(faces_at_edges(), [](const auto& edge) { return edge.second.size() > 2; });
  }
  [[nodiscard]] static bool degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

  [[nodiscard]] LatticePoint middle(const std::vector<std::uint32_t>& of, Random& random) const {
    LatticePoint p;
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t sum = 0;
      for (const std::uint32_t v : of) sum += points[v][axis];
      p[axis] = static_cast<std::int32_t>(sum / static_cast<std::int64_t>(of.size()) +
                                          static_cast<std::int64_t>(random() % 5) - 2);
    }
    return p;
  }
  [[nodiscard]] LatticePoint somewhere(Random& random) const {
    LatticePoint p = points.empty() ? LatticePoint{100, 100, 100} : points[random() % points.size()];
    for (int axis = 0; axis < 3; ++axis) p[axis] += static_cast<std::int32_t>(random() % 2001) - 1000;
    return p;
  }
  [[nodiscard]] std::uint32_t any_face(Random& random) const {
    return static_cast<std::uint32_t>(random() % faces.size());
  }

  void replace(std::uint32_t f, const Triangle& t) {
    faces[f] = t;
    face_was[f] = kNew;
  }

  void split_faces(Random& random, std::size_t count) {
    for (; count; --count) {
      const std::uint32_t f = any_face(random);
      const Triangle t = faces[f];
      if (degenerate(t)) continue;
      const std::uint32_t m = add_vertex(middle({t[0], t[1], t[2]}, random));
      replace(f, {t[0], t[1], m});
      add_face({t[1], t[2], m});
      add_face({t[2], t[0], m});
    }
  }

  void split_edges(Random& random, std::size_t count) {
    std::set<std::uint32_t> done;
    const auto at = faces_at_edges();
    for (; count; --count) {
      const Triangle picked = faces[any_face(random)];
      const Edge edge = key(picked[0], picked[1]);
      const auto found = at.find(edge);
      if (degenerate(picked) || found == at.end() || on_outer_edge(edge.first, edge.second)) continue;
      if (std::ranges::any_of(found->second, [&](auto f) { return done.contains(f) || degenerate(faces[f]); }))
        continue;
      const std::uint32_t m = add_vertex(middle({edge.first, edge.second}, random));
      for (const std::uint32_t f : found->second) {
        done.insert(f);
        Triangle first = faces[f], second = first;
        for (std::uint32_t& v : first) v = v == edge.first ? m : v;
        for (std::uint32_t& v : second) v = v == edge.second ? m : v;
        replace(f, first);
        add_face(second);
      }
    }
  }

  void flip_edges(Random& random, std::size_t count) {
    std::set<std::uint32_t> done;
    const auto at = faces_at_edges();
    for (; count; --count) {
      const std::uint32_t f = any_face(random);
      const auto [a, b, c] = faces[f];
      if (degenerate(faces[f]) || on_outer_edge(a, b)) continue;
      const auto& both = at.find(key(a, b))->second;
      if (both.size() != 2 || done.contains(both[0]) || done.contains(both[1])) continue;
      const std::uint32_t g = both[0] == f ? both[1] : both[0];
      Triangle other = faces[g];
      for (int turn = 0; turn < 3 && !(other[0] == b && other[1] == a); ++turn)
        std::rotate(other.begin(), other.begin() + 1, other.end());
      if (other[0] != b || other[1] != a || other[2] == c || at.contains(key(c, other[2]))) continue;
      done.insert({f, g});
      replace(f, {c, a, other[2]});
      replace(g, {other[2], b, c});
    }
  }

  void collapse_edges(Random& random, std::size_t count) {
    for (; count && !faces.empty(); --count) {
      const std::uint32_t f = any_face(random);
      const std::uint32_t gone = faces[f][0], stays = faces[f][1];
      if (gone == stays || shared_outside(gone)) continue;
      const Sketch before = *this;
      erase_faces([&](std::uint32_t g) {
        return std::ranges::count(faces[g], gone) > 0 && std::ranges::count(faces[g], stays) > 0;
      });
      for (std::uint32_t g = 0; g < faces.size(); ++g)
        for (std::uint32_t& v : faces[g])
          if (v == gone) {
            v = stays;
            face_was[g] = kNew;
          }
      if (!outer_edges_intact()) *this = before;
    }
  }
  [[nodiscard]] bool shared_outside(std::uint32_t v) const {
    return vertex_was[v] != kNew && region_->keys[vertex_was[v]].where == VertexKey::Where::corner;
  }

  /// Faces around one, nearest first; those at outer edges are left.
  void cut_hole(Random& random, std::size_t count) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> at;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (const std::uint32_t v : faces[f]) at[v].push_back(f);
    std::vector<std::uint32_t> queue{any_face(random)};
    std::set<std::uint32_t> seen{queue.front()};
    for (std::size_t i = 0; i < queue.size() && queue.size() < count; ++i)
      for (const std::uint32_t v : faces[queue[i]])
        for (const std::uint32_t g : at[v])
          if (seen.insert(g).second) queue.push_back(g);
    erase_faces([&](std::uint32_t f) { return seen.contains(f) && !touches_outer(f); });
  }
  [[nodiscard]] bool touches_outer(std::uint32_t f) const {
    const Triangle& t = faces[f];
    for (std::size_t i = 0; i < 3; ++i)
      if (on_outer_edge(t[i], t[(i + 1) % 3])) return true;
    return false;
  }

  /// Triangles between two border edges that meet.
  void fill_corners(Random& random, std::size_t count) {
    const auto at = faces_at_edges();
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [edge, around] : at) {
      if (around.size() != 1 || on_outer_edge(edge.first, edge.second)) continue;
      const Triangle& t = faces[around.front()];
      for (std::size_t i = 0; i < 3; ++i)
        if (key(t[i], t[(i + 1) % 3]) == edge) next[t[(i + 1) % 3]] = t[i];
    }
    for (const auto& [a, b] : std::map(next)) {
      if (!count || random() % 2) continue;
      const auto second = next.find(b);
      if (second == next.end() || !next.contains(a)) continue;
      const std::uint32_t c = second->second;
      if (c == a || at.contains(key(a, c))) continue;
      add_face({a, b, c});
      next.erase(b);
      next[a] = c;
      --count;
    }
  }

  void delete_charts(Random& random) {
    const auto chart = static_cast<std::uint32_t>(random() % region_->charts.size());
    const bool all = random() % 3 == 0;
    erase_faces([&](std::uint32_t f) {
      const bool of_it = all || (face_was[f] != kNew && region_->chart_of_face[face_was[f]] == chart);
      return of_it && !touches_outer(f);
    });
  }

  void delete_component(Random& random) { cut_hole(random, faces.size()); }

  void add_grid(Random& random) {
    const auto n = static_cast<std::uint32_t>(1 + random() % 12);
    const auto first = static_cast<std::uint32_t>(points.size());
    const LatticePoint corner = somewhere(random);
    for (std::uint32_t y = 0; y <= n; ++y)
      for (std::uint32_t x = 0; x <= n; ++x)
        (void)add_vertex({corner.x + static_cast<std::int32_t>(x * 11), corner.y + static_cast<std::int32_t>(y * 9),
                          corner.z + static_cast<std::int32_t>(random() % 7)});
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return first + y * (n + 1) + x; };
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t x = 0; x < n; ++x) {
        add_face({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
        add_face({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
      }
  }

  /// A tube between two faces, which go.
  void bridge(Random& random) {
    const std::uint32_t f = any_face(random), g = any_face(random);
    const Triangle a = faces[f], b = faces[g];
    std::set<std::uint32_t> six{a[0], a[1], a[2], b[0], b[1], b[2]};
    if (six.size() < 6) return;
    erase_faces([&](std::uint32_t h) { return h == f || h == g; });
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::uint32_t bi = b[(3 - i) % 3], bj = b[(3 - j) % 3];
      add_face({a[i], a[j], bi});
      add_face({a[j], bj, bi});
    }
  }

  void add_fins(Random& random) {
    for (std::size_t i = 1 + random() % 4; i; --i) {
      const Triangle t = faces[any_face(random)];
      if (t[0] == t[1] || on_outer_edge(t[0], t[1])) continue;
      add_face({t[0], t[1],
                random() % 3 ? add_vertex(somewhere(random)) : static_cast<std::uint32_t>(random() % points.size())});
    }
  }

  void add_odd_faces(Random& random) {
    Triangle t = faces[any_face(random)];
    if (random() % 2)
      std::swap(t[0], t[1]);
    else
      t[2] = t[random() % 3];
    add_face(t);
  }

  /// One face gets a vertex of its own at the same place.
  void cut_open(Random& random) {
    const std::uint32_t f = any_face(random);
    Triangle t = faces[f];
    if (degenerate(t) || touches_outer(f)) return;
    t[0] = add_vertex(points[t[0]]);
    replace(f, t);
  }

  std::vector<std::size_t> outer_before_;
};

}  // namespace ramcdb::test
