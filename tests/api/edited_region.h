#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "api/region_match.h"
#include "tests/support/meshes.h"

namespace ramcdb::test {

inline constexpr std::uint32_t kNew = ~std::uint32_t{0};

/// A region as if one chart held the whole mesh; border vertices are those of its open edges.
[[nodiscard]] inline RegionMesh region_of(const TestMesh& mesh, unsigned bits = 18) {
  RegionMesh region;
  region.charts = {ChartId(1)};
  region.points = snap_to_bits(mesh, bits);
  region.faces = mesh.faces;
  region.chart_of_face.assign(mesh.faces.size(), 0);
  region.outer_border.assign(region.points.size(), false);
  for (std::uint32_t v = 0; v < region.points.size(); ++v) region.keys.push_back({VertexKey::Where::chart, 1, v});
  std::vector<std::uint64_t> edges;
  const auto edge = [](std::uint32_t a, std::uint32_t b) { return (std::uint64_t{a} << 32) | b; };
  for (const Triangle& t : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(edge(t[i], t[(i + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  for (const std::uint64_t e : edges) {
    const auto a = static_cast<std::uint32_t>(e >> 32), b = static_cast<std::uint32_t>(e);
    if (!std::binary_search(edges.begin(), edges.end(), edge(b, a)))
      region.outer_border[a] = region.outer_border[b] = true;
  }
  return region;
}

/// What a program made of a region, and what became of every part: the region's vertex and face, or kNew.
struct EditedRegion {
  std::vector<LatticePoint> points;
  std::vector<std::uint32_t> corners, firsts{0};
  std::vector<std::uint64_t> ids;
  std::vector<std::uint32_t> vertex_was, face_was;
  bool splits_vertices = false;

  explicit EditedRegion(const RegionMesh& region) : points(region.points), vertex_was(points.size()) {
    std::iota(vertex_was.begin(), vertex_was.end(), 0U);
    for (std::uint32_t f = 0; f < region.faces.size(); ++f) add(region.faces[f], f);
    for (const VertexKey& key : region.keys) ids.push_back(key.packed());
  }

  [[nodiscard]] detail::OtherMesh other(bool with_ids) const {
    detail::OtherMesh mesh;
    mesh.points = points;
    mesh.corners = corners;
    mesh.firsts = firsts;
    if (with_ids) mesh.ids = ids;
    mesh.splits_vertices = splits_vertices;
    return mesh;
  }
  [[nodiscard]] std::size_t face_count() const { return firsts.size() - 1; }
  [[nodiscard]] Triangle triangle(std::size_t face) const {
    return {corners[firsts[face]], corners[firsts[face] + 1], corners[firsts[face] + 2]};
  }

  void add(const Triangle& t, std::uint32_t was = kNew) {
    corners.insert(corners.end(), t.begin(), t.end());
    firsts.push_back(static_cast<std::uint32_t>(corners.size()));
    face_was.push_back(was);
  }
  std::uint32_t add(LatticePoint p) {
    points.push_back(p);
    vertex_was.push_back(kNew);
    ids.push_back(0);
    return static_cast<std::uint32_t>(points.size() - 1);
  }
  /// Takes out faces, and then vertices without faces that had some.
  void remove_faces(const std::vector<bool>& gone) {
    std::vector<bool> had(points.size(), false), has(points.size(), false);
    for (const std::uint32_t v : corners) had[v] = true;
    EditedRegion old = std::move(*this);
    firsts = {0};
    corners.clear();
    face_was.clear();
    for (std::size_t f = 0; f < old.face_count(); ++f) {
      if (f < gone.size() && gone[f]) continue;
      add(old.triangle(f), old.face_was[f]);
      for (const std::uint32_t v : old.triangle(f)) has[v] = true;
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < had.size(); ++v)
      if (has[v] || !had[v]) order.push_back(v);
    splits_vertices = old.splits_vertices;
    take_vertices(old, order);
  }
  void shuffle(unsigned seed) {
    std::mt19937 random(seed);
    const auto permutation = [&](std::size_t count) {
      std::vector<std::uint32_t> order(count);
      std::iota(order.begin(), order.end(), 0U);
      for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
      return order;
    };
    const EditedRegion old = *this;
    corners.clear();
    firsts = {0};
    face_was.clear();
    for (const std::uint32_t f : permutation(old.face_count())) {
      Triangle t = old.triangle(f);
      std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
      add(t, old.face_was[f]);
    }
    take_vertices(old, permutation(old.points.size()));
  }
  /// Every face with vertices of its own; isolated vertices are lost.
  void explode() {
    const EditedRegion old = *this;
    take_vertices(old, old.corners);
    std::iota(corners.begin(), corners.end(), 0U);
    splits_vertices = true;
  }
  template <class Moves>
  void move(Moves&& moves) {
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (!moves(v)) continue;
      points[v].z += 7 + static_cast<std::int32_t>(vertex_was[v] % 5);
      points[v].x -= 3;
    }
  }
  /// Takes out vertices no two of which share a face, and fills the holes in another way.
  void remesh(double share, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<std::uint32_t>> faces_at(points.size());
    for (std::uint32_t f = 0; f < face_count(); ++f)
      for (const std::uint32_t v : triangle(f)) faces_at[v].push_back(f);
    std::vector<bool> gone(face_count(), false);
    const auto wanted = static_cast<std::size_t>(share * static_cast<double>(face_count()) / 6) + 1;
    std::size_t done = 0;
    for (std::size_t tries = 0; done < wanted && tries < 50 * wanted; ++tries) {
      const auto v = static_cast<std::uint32_t>(random() % faces_at.size());
      const std::vector<std::uint32_t> ring = ring_of(v, faces_at[v], gone);
      if (ring.size() < 4) continue;
      for (const std::uint32_t f : faces_at[v]) gone[f] = true;
      fill(ring);
      ++done;
    }
    remove_faces(gone);
  }

 private:
  void take_vertices(const EditedRegion& old, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> to(old.points.size(), kNew);
    std::vector<LatticePoint> new_points;
    std::vector<std::uint64_t> new_ids;
    std::vector<std::uint32_t> new_was;
    for (const std::uint32_t v : order) {
      to[v] = static_cast<std::uint32_t>(new_points.size());
      new_points.push_back(old.points[v]);
      new_ids.push_back(old.ids[v]);
      new_was.push_back(old.vertex_was[v]);
    }
    points = std::move(new_points);
    ids = std::move(new_ids);
    vertex_was = std::move(new_was);
    for (std::uint32_t& v : corners) v = to[v];
  }
  /// The vertices around a vertex in order; empty when its faces are no closed fan, or some of them are gone.
  [[nodiscard]] std::vector<std::uint32_t> ring_of(std::uint32_t v, const std::vector<std::uint32_t>& faces,
                                                   const std::vector<bool>& gone) const {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const std::uint32_t f : faces) {
      const Triangle t = triangle(f);
      const auto i = static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
      if (gone[f] || !next.emplace(t[(i + 1) % 3], t[(i + 2) % 3]).second) return {};
    }
    std::vector<std::uint32_t> ring;
    for (std::uint32_t at = faces.empty() ? 0 : next.begin()->first; ring.size() < next.size();) {
      ring.push_back(at);
      const auto it = next.find(at);
      if (it == next.end()) return {};
      at = it->second;
    }
    const std::vector<std::uint32_t> sorted = [&] {
      std::vector<std::uint32_t> s = ring;
      std::sort(s.begin(), s.end());
      return s;
    }();
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? ring : std::vector<std::uint32_t>{};
  }
  void fill(const std::vector<std::uint32_t>& ring) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const Triangle t{ring[0], ring[i], ring[i + 1]};
      if (i != 1) {
        add(t);
        continue;
      }
      LatticePoint middle;
      for (int a = 0; a < 3; ++a)
        middle[a] = static_cast<std::int32_t>((std::int64_t{points[t[0]][a]} + points[t[1]][a] + points[t[2]][a]) / 3);
      middle.z += 1;
      const std::uint32_t w = add(middle);
      for (std::size_t k = 0; k < 3; ++k) add(Triangle{t[k], t[(k + 1) % 3], w});
    }
  }
};

/// The mesh with so much of its connectivity changed at random places that it has no symmetry left.
[[nodiscard]] inline TestMesh irregular(const TestMesh& mesh) {
  EditedRegion edited(region_of(mesh, 24));
  edited.remesh(0.3, 99);
  TestMesh out;
  for (const LatticePoint p : edited.points)
    out.positions.push_back({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
  for (std::size_t f = 0; f < edited.face_count(); ++f) out.faces.push_back(edited.triangle(f));
  return out;
}

}  // namespace ramcdb::test
