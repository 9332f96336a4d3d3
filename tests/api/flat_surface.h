#pragma once

#include <fmt/format.h>

#include <array>
#include <istream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/api/sketch.h"

namespace ramcdb::test {

/// A surface over a plane whose vertices only ever move up and down: x and y name them, in every version and process.
/// What one version holds, or the region of an edit.
struct FlatSurface {
  static constexpr std::int64_t kUnknown = -1;
  using Name = std::array<std::int32_t, 2>;
  using Face = std::array<Name, 3>;  ///< turned to its smallest sequence
  struct Vertex {
    std::int32_t height = 0;
    std::int64_t color = kUnknown;  ///< 0xrrggbb
    friend auto operator<=>(const Vertex&, const Vertex&) = default;
  };

  std::map<Name, Vertex> vertices;
  std::set<Face> faces;

  [[nodiscard]] static Name name(LatticePoint p) { return {p.x, p.y}; }

  void add(LatticePoint p, std::int64_t color) {
    if (!vertices.emplace(name(p), Vertex{p.z, color}).second) throw std::logic_error("two vertices of one name");
  }
  void add(const std::vector<LatticePoint>& points, const std::vector<Triangle>& triangles) {
    for (const Triangle& t : triangles) {
      Face face{name(points[t[0]]), name(points[t[1]]), name(points[t[2]])};
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      if (!faces.insert(face).second) throw std::logic_error("a face twice");
    }
  }
};

/// The color attribute of a vertex as one number.
[[nodiscard]] inline std::int64_t packed_color(const std::vector<double>& values, std::size_t vertex) {
  std::int64_t packed = 0;
  for (std::size_t i = 0; i < 3; ++i) packed = 256 * packed + static_cast<std::int64_t>(values[3 * vertex + i]);
  return packed;
}

[[nodiscard]] inline FlatSurface flat_surface(const RegionMesh& region) {
  FlatSurface surface;
  for (std::size_t v = 0; v < region.points.size(); ++v)
    surface.add(region.points[v], packed_color(region.attributes.at(0).values, v));
  surface.add(region.points, region.faces);
  return surface;
}

/// One edit by names: what it found and what it made of that.
struct FlatEdit {
  struct Change {
    FlatSurface::Name name{};
    bool was = false, is = false;
    FlatSurface::Vertex before, after;
  };

  std::string id;
  bool may_merge = false;  ///< others may have done the same to a place
  std::vector<Change> vertices;
  std::vector<FlatSurface::Face> removed, added;

  static FlatEdit between(const FlatSurface& before, const FlatSurface& after) {
    FlatEdit edit;
    const auto add = [&](FlatSurface::Name name) {
      const auto was = before.vertices.find(name), is = after.vertices.find(name);
      Change change{name, was != before.vertices.end(), is != after.vertices.end(), {}, {}};
      if (change.was) change.before = was->second;
      if (change.is) change.after = is->second;
      if (change.was != change.is || change.before != change.after) edit.vertices.push_back(change);
    };
    for (const auto& [name, vertex] : before.vertices) add(name);
    for (const auto& [name, vertex] : after.vertices)
      if (!before.vertices.contains(name)) add(name);
    std::ranges::set_difference(before.faces, after.faces, std::back_inserter(edit.removed));
    std::ranges::set_difference(after.faces, before.faces, std::back_inserter(edit.added));
    return edit;
  }

  [[nodiscard]] bool empty() const { return vertices.empty() && removed.empty() && added.empty(); }

  /// Does the same to a surface. Throws logic_error where that is not what the edit was made on: an update would be
  /// lost.
  void apply(FlatSurface& surface) const {
    for (const Change& change : vertices) {
      if (change.is) apply(change, surface);
      if (!change.is) expect_unchanged(change, surface);
    }
    for (const auto& face : removed)
      if (surface.faces.erase(face) == 0 && !may_merge) throw std::logic_error(id + ": a removed face is gone");
    for (const auto& face : added)
      if (!surface.faces.insert(face).second && !may_merge) throw std::logic_error(id + ": an added face is there");
    std::set<FlatSurface::Name> used;
    for (const auto& face : surface.faces) used.insert(face.begin(), face.end());
    for (const Change& change : vertices)  // charts outside of the region may share one that it lost
      if (!change.is && !used.contains(change.name)) surface.vertices.erase(change.name);
  }

 private:
  void apply(const Change& change, FlatSurface& surface) const {
    const auto [it, is_new] = surface.vertices.emplace(change.name, change.after);
    if (is_new && change.was) throw std::logic_error(id + ": a changed vertex is gone");
    if (is_new) return;
    if (!change.was) {
      if (!may_merge || it->second.height != change.after.height)
        throw std::logic_error(id + ": a new vertex is there");
      return;
    }
    change_number(it->second.height, change.before.height, change.after.height);
    if (change.after.color == change.before.color) return;
    if (it->second.color == FlatSurface::kUnknown) it->second.color = change.before.color;
    change_number(it->second.color, change.before.color, change.after.color);
  }
  /// What nobody saw is not taken away.
  void expect_unchanged(const Change& change, const FlatSurface& surface) const {
    const auto it = surface.vertices.find(change.name);
    if (it == surface.vertices.end()) return;
    const bool same_color = it->second.color == change.before.color || it->second.color == FlatSurface::kUnknown;
    if (it->second.height != change.before.height || !same_color)
      throw std::logic_error(id + ": removes a vertex that others changed");
  }
  template <class Number>
  void change_number(Number& now, Number before, Number after) const {
    if (before == after) return;
    if (now != before && !(may_merge && now == after)) throw std::logic_error(id + ": made on another value");
    now = after;
  }
};

/// Text that ends with ';': a writer may be killed before it is all there.
[[nodiscard]] inline std::string to_text(const FlatEdit& edit) {
  std::string text = fmt::format("edit {} {:d} {} {} {}\n", edit.id, edit.may_merge, edit.vertices.size(),
                                 edit.removed.size(), edit.added.size());
  for (const FlatEdit::Change& c : edit.vertices)
    text += fmt::format("{} {} {:d} {:d} {} {} {} {}\n", c.name[0], c.name[1], c.was, c.is, c.before.height,
                        c.before.color, c.after.height, c.after.color);
  for (const auto* faces : {&edit.removed, &edit.added})
    for (const auto& face : *faces) {
      for (const auto& name : face) text += fmt::format("{} {} ", name[0], name[1]);
      text += '\n';
    }
  return text + ";\n";
}

/// What stands behind the word `edit`; false when it is not whole.
[[nodiscard]] inline bool read_edit(std::istream& in, FlatEdit& edit) {
  std::size_t vertices = 0, removed = 0, added = 0;
  if (!(in >> edit.id >> edit.may_merge >> vertices >> removed >> added)) return false;
  edit.vertices.resize(vertices);
  edit.removed.resize(removed);
  edit.added.resize(added);
  for (FlatEdit::Change& c : edit.vertices)
    in >> c.name[0] >> c.name[1] >> c.was >> c.is >> c.before.height >> c.before.color >> c.after.height >>
        c.after.color;
  for (auto* faces : {&edit.removed, &edit.added})
    for (auto& face : *faces)
      for (auto& name : face) in >> name[0] >> name[1];
  char end = 0;
  return in >> end && end == ';';
}

/// Random changes of a sketch that leave it flat.
class FlatChanges {
 public:
  FlatChanges(Sketch& sketch, Sketch::Random& random) : sketch_(sketch), random_(random) {}

  void remesh() {
    for (auto count = 1 + random_() % 6; count && !sketch_.faces.empty(); --count) {
      switch (random_() % 6) {
        case 0:
        case 1:
          split(random_() % sketch_.faces.size());
          break;
        case 2:
          remove(random_() % sketch_.faces.size());
          break;
        case 3:
          fill();
          break;
        default:
          join(random_() % sketch_.points.size());
      }
    }
  }

  /// Lifts vertices, those that others share only where they may be recognized by their numbers.
  void move(bool shared) {
    const std::size_t every = 1 + random_() % 30;
    for (std::size_t v = 0; v < sketch_.points.size(); ++v) {
      const std::uint32_t was = sketch_.vertex_was[v];
      const bool may = shared || (was != Sketch::kNew && sketch_.region().keys[was].where == VertexKey::Where::chart);
      if (may && random_() % every == 0) sketch_.points[v].z += static_cast<std::int32_t>(random_() % 13) - 6;
    }
  }

 private:
  /// Twice the area over the plane, with its sign.
  [[nodiscard]] static std::int64_t area(LatticePoint a, LatticePoint b, LatticePoint c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
           (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
  }
  [[nodiscard]] std::int64_t area(const Triangle& t) const {
    return area(sketch_.points[t[0]], sketch_.points[t[1]], sketch_.points[t[2]]);
  }

  /// One face becomes three, around a vertex somewhere inside.
  void split(std::size_t f) {
    const Triangle t = sketch_.faces[f];
    const std::int64_t weight[] = {1 + static_cast<std::int64_t>(random_() % 9),
                                   1 + static_cast<std::int64_t>(random_() % 9), 10};
    LatticePoint p;
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += weight[i] * sketch_.points[t[i]][axis];
      p[axis] = static_cast<std::int32_t>(sum / (weight[0] + weight[1] + weight[2]));
    }
    for (std::size_t i = 0; i < 3; ++i)
      if ((area(sketch_.points[t[i]], sketch_.points[t[(i + 1) % 3]], p) > 0) != (area(t) > 0) ||
          area(sketch_.points[t[i]], sketch_.points[t[(i + 1) % 3]], p) == 0)
        return;
    const std::uint32_t m = sketch_.add_vertex(p);
    sketch_.faces[f] = {t[0], t[1], m};
    sketch_.face_was[f] = Sketch::kNew;
    sketch_.add_face({t[1], t[2], m});
    sketch_.add_face({t[2], t[0], m});
  }

  void remove(std::size_t f) {
    const Triangle& t = sketch_.faces[f];
    for (std::size_t i = 0; i < 3; ++i)
      if (sketch_.on_outer_edge(t[i], t[(i + 1) % 3])) return;
    erase({f});
  }

  void erase(const std::set<std::size_t>& gone) {
    std::size_t count = 0;
    for (std::size_t f = 0; f < sketch_.faces.size(); ++f) {
      if (gone.contains(f)) continue;
      sketch_.faces[count] = sketch_.faces[f];
      sketch_.face_was[count++] = sketch_.face_was[f];
    }
    sketch_.faces.resize(count);
    sketch_.face_was.resize(count);
  }

  /// A hole of three edges is closed.
  void fill() {
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const Triangle& t : sketch_.faces)
      for (std::size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
    std::map<std::uint32_t, std::vector<std::uint32_t>> open;  // along the hole
    for (const auto& [a, b] : edges)
      if (!edges.contains({b, a}) && !sketch_.on_outer_edge(a, b)) open[b].push_back(a);
    const auto is_open = [&](std::uint32_t a, std::uint32_t b) {
      const auto it = open.find(a);
      return it != open.end() && std::ranges::count(it->second, b) > 0;
    };
    for (const auto& [a, ends] : open)
      for (const std::uint32_t b : ends) {
        const auto next = open.find(b);
        if (next == open.end()) continue;
        for (const std::uint32_t c : next->second)
          if (is_open(c, a) && (area({a, b, c}) > 0) == (area(sketch_.faces.front()) > 0))
            return sketch_.add_face({a, b, c});
      }
  }

  /// A vertex of three faces goes, and they become one.
  void join(std::size_t v) {
    std::set<std::size_t> around;
    std::map<std::uint32_t, std::uint32_t> next;
    for (std::size_t f = 0; f < sketch_.faces.size(); ++f) {
      const Triangle& t = sketch_.faces[f];
      const auto i = static_cast<std::size_t>(std::ranges::find(t, v) - t.begin());
      if (i == 3) continue;
      around.insert(f);
      next[t[(i + 1) % 3]] = t[(i + 2) % 3];
    }
    if (around.size() != 3 || next.size() != 3) return;
    const std::uint32_t a = next.begin()->first, b = next.begin()->second;
    if (!next.contains(b) || !next.contains(next[b]) || next[next[b]] != a) return;
    erase(around);
    sketch_.add_face({a, b, next[b]});
  }

  Sketch& sketch_;
  Sketch::Random& random_;
};

}  // namespace ramcdb::test
