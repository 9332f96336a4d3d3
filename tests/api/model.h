#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "api/topology.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::test {

/// A plain mesh: what a version ought to hold. Vertices without a face are isolated ones.
struct Model {
  using Color = std::vector<double>;

  std::vector<LatticePoint> points;
  std::vector<Color> color;  ///< per vertex; empty where it is not known
  std::vector<Triangle> faces;
  std::vector<std::uint64_t> ids;  ///< per vertex who it is, in all versions

  void add_vertex(std::uint64_t id, LatticePoint p, Color c) {
    ids.push_back(id);
    points.push_back(p);
    color.push_back(std::move(c));
  }
  [[nodiscard]] detail::Topology topology() const {
    chartify::IndexedMesh mesh;
    mesh.positions = points;
    mesh.faces = faces;
    return detail::analyze(mesh);
  }
  [[nodiscard]] std::vector<LatticePoint> sorted_points() const {
    std::vector<LatticePoint> all = points;
    std::sort(all.begin(), all.end());
    return all;
  }
  /// A place and a colour for every vertex that has a known one.
  [[nodiscard]] std::vector<std::pair<LatticePoint, Color>> known_colors() const {
    std::vector<std::pair<LatticePoint, Color>> known;
    for (std::size_t v = 0; v < points.size(); ++v)
      if (!color[v].empty()) known.emplace_back(points[v], color[v]);
    std::sort(known.begin(), known.end());
    return known;
  }
  [[nodiscard]] std::map<std::uint64_t, std::uint32_t> vertex_of_id() const {
    std::map<std::uint64_t, std::uint32_t> at;
    for (std::uint32_t v = 0; v < ids.size(); ++v) at.emplace(ids[v], v);
    return at;
  }
};

[[nodiscard]] inline Model::Color color_at(const RegionMesh& region, std::uint32_t v) {
  if (region.attributes.empty()) return {};
  const auto first = region.attributes.front().values.begin() + 3 * static_cast<std::ptrdiff_t>(v);
  Model::Color color{first, first + 3};
  for (double& value : color)
    if (std::isnan(value)) value = -1;  // absent; but equal to itself
  return color;
}

/// With ids that count from 0.
[[nodiscard]] inline Model model_of(const RegionMesh& region) {
  Model model;
  for (std::uint32_t v = 0; v < region.points.size(); ++v) model.add_vertex(v, region.points[v], color_at(region, v));
  model.faces = region.faces;
  return model;
}

/// Finds which vertex of one mesh is which of another: meshes are the same when places and faces are, however vertices
/// are numbered and however many lie at one place. Vertices get marks from their places and then, again and again, from
/// the marks around them; where several keep the same one, the first of either mesh are said to be the same.
class SameMesh {
 public:
  SameMesh(const Model& a, const Model& b) : a_(a), b_(b) {}

  /// Per vertex of b the vertex of a; none when they are not the same.
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> run() {
    if (a_.points.size() != b_.points.size() || a_.faces.size() != b_.faces.size()) return std::nullopt;
    marks_a_ = of_places(a_);
    marks_b_ = of_places(b_);
    for (;;) {
      if (!refine()) return std::nullopt;
      const auto tie = first_tie();
      if (!tie) return matched();
      marks_a_[tie->first] = marks_b_[tie->second] = mix(++ties_, 77);
    }
  }

 private:
  using Marks = std::vector<std::uint64_t>;

  static std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t x = (a ^ (b + 0x9e3779b97f4a7c15U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 29)) * 0x94d049bb133111ebU;
    return x ^ (x >> 32);
  }
  static Marks of_places(const Model& mesh) {
    Marks marks;
    for (const LatticePoint& p : mesh.points) {
      std::uint64_t mark = 1;
      for (int axis = 0; axis < 3; ++axis) mark = mix(mark, static_cast<std::uint32_t>(p[axis]));
      marks.push_back(mark);
    }
    return marks;
  }
  static Marks of_faces(const Model& mesh, const Marks& marks) {
    Marks sums(marks.size(), 0);
    for (const Triangle& t : mesh.faces)
      for (std::size_t i = 0; i < 3; ++i)
        sums[t[i]] += mix(mix(marks[t[(i + 1) % 3]], 5), mix(marks[t[(i + 2) % 3]], marks[t[i]]));
    for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = mix(marks[v], sums[v]);
    return sums;
  }
  static Marks sorted(Marks marks) {
    std::sort(marks.begin(), marks.end());
    return marks;
  }
  static std::size_t kinds(const Marks& sorted) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) count += i == 0 || sorted[i] != sorted[i - 1];
    return count;
  }

  bool refine() {
    for (std::size_t before = kinds(sorted(marks_a_));;) {
      Marks a = of_faces(a_, marks_a_), b = of_faces(b_, marks_b_);
      const Marks all = sorted(a);
      if (all != sorted(b)) return false;
      const std::size_t now = kinds(all);
      marks_a_ = std::move(a);
      marks_b_ = std::move(b);
      if (now == before || now == all.size()) return true;
      before = now;
    }
  }

  /// Of the vertices that share a mark, one of either mesh, of one colour if that is known.
  [[nodiscard]] std::optional<std::pair<std::uint32_t, std::uint32_t>> first_tie() const {
    const Marks all = sorted(marks_a_);
    for (std::uint32_t v = 0; v < marks_a_.size(); ++v) {
      const auto [first, last] = std::equal_range(all.begin(), all.end(), marks_a_[v]);
      if (last - first == 1) continue;
      std::optional<std::uint32_t> other;
      for (std::uint32_t w = 0; w < marks_b_.size(); ++w) {
        if (marks_b_[w] != marks_a_[v]) continue;
        const bool alike = !a_.color[v].empty() && a_.color[v] == b_.color[w];
        if (!other || alike) other = w;
        if (alike) break;
      }
      return std::pair(v, *other);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::uint32_t> matched() const {
    std::map<std::uint64_t, std::uint32_t> of_mark;
    for (std::uint32_t v = 0; v < marks_a_.size(); ++v) of_mark.emplace(marks_a_[v], v);
    std::vector<std::uint32_t> to;
    for (const std::uint64_t mark : marks_b_) to.push_back(of_mark.at(mark));
    return to;
  }

  const Model &a_, &b_;
  Marks marks_a_, marks_b_;
  std::uint64_t ties_ = 0;
};

/// Faces by the ids of their vertices, each turned to its smallest sequence, with how many there are.
using FacesById = std::map<std::array<std::uint64_t, 3>, int>;

[[nodiscard]] inline FacesById faces_by_id(const Model& model) {
  FacesById faces;
  for (const Triangle& t : model.faces) {
    std::array<std::uint64_t, 3> face{model.ids[t[0]], model.ids[t[1]], model.ids[t[2]]}, best = face;
    for (int turn = 1; turn < 3; ++turn) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
      best = std::min(best, face);
    }
    ++faces[best];
  }
  return faces;
}

/// The vertices of `base` at which `other` is not the same: moved, of another value, gone, or of a face that is gone or
/// new.
[[nodiscard]] inline std::set<std::uint64_t> touched(const Model& base, const Model& other) {
  std::set<std::uint64_t> ids;
  const auto there = other.vertex_of_id();
  for (std::uint32_t v = 0; v < base.ids.size(); ++v) {
    const auto it = there.find(base.ids[v]);
    if (it == there.end() || other.points[it->second] != base.points[v] || other.color[it->second] != base.color[v])
      ids.insert(base.ids[v]);
  }
  const FacesById before = faces_by_id(base), after = faces_by_id(other);
  const auto count = [](const FacesById& faces, const auto& face) {
    const auto it = faces.find(face);
    return it == faces.end() ? 0 : it->second;
  };
  const auto here = base.vertex_of_id();
  for (const FacesById* side : {&before, &after})
    for (const auto& [face, n] : *side)
      if (count(before, face) != count(after, face))
        for (const std::uint64_t id : face)
          if (here.contains(id)) ids.insert(id);
  return ids;
}

/// Three-way merge by who vertices are; none where the sides contradict each other.
class PlainMerge {
 public:
  PlainMerge(const Model& base, const Model& ours, const Model& theirs)
      : base_(base),
        ours_(ours),
        theirs_(theirs),
        in_base_(base.vertex_of_id()),
        in_ours_(ours.vertex_of_id()),
        in_theirs_(theirs.vertex_of_id()) {}

  [[nodiscard]] std::optional<Model> run() {
    for (std::uint32_t v = 0; v < theirs_.ids.size(); ++v) add_vertex_of_theirs(v);
    for (std::uint32_t v = 0; v < ours_.ids.size(); ++v)
      if (const std::uint64_t id = ours_.ids[v]; !in_theirs_.contains(id)) {
        if (!in_base_.contains(id))
          out_.add_vertex(id, ours_.points[v], ours_.color[v]);
        else if (changed(ours_, v, in_base_.at(id)))
          contradict(id, "changed and removed");
      }
    add_faces();
    drop_bare();
    if (!contradiction_.empty()) return std::nullopt;
    return std::move(out_);
  }

  [[nodiscard]] const std::string& contradiction() const { return contradiction_; }

 private:
  void contradict(std::uint64_t id, const char* what) {
    const auto at = in_base_.find(id);
    const LatticePoint p = at == in_base_.end() ? LatticePoint{} : base_.points[at->second];
    contradiction_ +=
        what + (" near " + std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z)) + "; ";
  }
  /// Whether a side moved or painted a vertex.
  [[nodiscard]] bool changed(const Model& side, std::uint32_t v, std::uint32_t in_base) const {
    const Model::Color &is = side.color[v], &was = base_.color[in_base];
    return side.points[v] != base_.points[in_base] || (!is.empty() && is != was);
  }
  void add_vertex_of_theirs(std::uint32_t v) {
    const std::uint64_t id = theirs_.ids[v];
    const auto b = in_base_.find(id), o = in_ours_.find(id);
    LatticePoint p = theirs_.points[v];
    if (b != in_base_.end() && o == in_ours_.end()) {  // removed by ours
      if (changed(theirs_, v, b->second)) contradict(id, "changed and removed");
      return;
    }
    Model::Color c = theirs_.color[v];
    if (b != in_base_.end()) {
      const LatticePoint was = base_.points[b->second], mine = ours_.points[o->second];
      if (mine != was) {
        if (p != was && p != mine) contradict(id, "moved twice");
        p = mine;
      }
      if (ours_.color[o->second].empty()) c.clear();  // made anew in its place
      for (std::size_t k = 0; k < c.size(); ++k) {
        const double before = base_.color[b->second][k], value = ours_.color[o->second][k];
        if (value == before) continue;
        if (c[k] != before && c[k] != value) contradict(id, "painted twice");
        c[k] = value;
      }
    }
    out_.add_vertex(id, p, std::move(c));
  }

  /// Whether a side has new faces at a vertex.
  [[nodiscard]] bool has_new_face(std::uint64_t id) const {
    const FacesById base = faces_by_id(base_);
    for (const FacesById& side : {faces_by_id(ours_), faces_by_id(theirs_)})
      for (const auto& [face, n] : side) {
        const auto before = base.find(face);
        if (n > (before == base.end() ? 0 : before->second) && std::ranges::count(face, id)) return true;
      }
    return false;
  }

  void add_faces() {
    const FacesById base = faces_by_id(base_), ours = faces_by_id(ours_);
    const FacesById theirs_faces = faces_by_id(theirs_);
    FacesById all = theirs_faces;
    const auto in = [](const FacesById& faces, const auto& face) {
      const auto it = faces.find(face);
      return it == faces.end() ? 0 : it->second;
    };
    for (const auto& [face, n] : base) all[face] += in(ours, face) - n;
    for (const auto& [face, n] : ours) {
      const int there = in(theirs_faces, face), before = in(base, face);
      if (before == 0) all[face] += n;
      if (n > before && there > before) all[face] = std::max(n, there);  // added on both sides: taken once
    }
    const auto at = out_.vertex_of_id();
    for (const auto& [face, n] : all) {
      if (n < 0 && std::ranges::any_of(face, [&](std::uint64_t id) { return has_new_face(id); }))
        contradict(face[0], "remeshed twice");
      for (int i = 0; i < n; ++i) {
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
          const auto vertex = at.find(face[k]);
          if (vertex == at.end())
            contradict(face[k], "used and removed");
          else
            t[k] = vertex->second;
        }
        out_.faces.push_back(t);
      }
    }
  }

  /// A vertex goes when each side took away all faces that the other left at it.
  void drop_bare() {
    const auto with_faces = [](const Model& model) {
      std::set<std::uint64_t> ids;
      for (const Triangle& t : model.faces)
        for (const std::uint32_t v : t) ids.insert(model.ids[v]);
      return ids;
    };
    const std::set<std::uint64_t> ours = with_faces(ours_), theirs = with_faces(theirs_), stay = with_faces(out_);
    Model kept;
    std::vector<std::uint32_t> to(out_.ids.size(), 0);
    for (std::uint32_t v = 0; v < out_.ids.size(); ++v) {
      const std::uint64_t id = out_.ids[v];
      to[v] = static_cast<std::uint32_t>(kept.ids.size());
      if (!in_base_.contains(id) || stay.contains(id) || !ours.contains(id) || !theirs.contains(id))
        kept.add_vertex(id, out_.points[v], out_.color[v]);
      else if (changed(out_, v, in_base_.at(id)))
        contradict(id, "changed and left bare");
    }
    for (const Triangle& t : out_.faces) kept.faces.push_back({to[t[0]], to[t[1]], to[t[2]]});
    out_ = std::move(kept);
  }

  const Model &base_, &ours_, &theirs_;
  std::map<std::uint64_t, std::uint32_t> in_base_, in_ours_, in_theirs_;
  Model out_;
  std::string contradiction_;
};

}  // namespace ramcdb::test
