#include "tests/chartify/region_edits.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "tests/chartify/lattice_mesh.h"

namespace ramcdb::chartify::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::map<Edge, std::vector<std::uint32_t>> faces_of_edges(const IndexedMesh& mesh) {
  std::map<Edge, std::vector<std::uint32_t>> faces;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) faces[std::minmax(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3])].push_back(f);
  return faces;
}

LatticePoint centroid(const IndexedMesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::int64_t x = 0, y = 0, z = 0;
  for (const std::uint32_t v : vertices) x += mesh.positions[v].x, y += mesh.positions[v].y, z += mesh.positions[v].z;
  const auto n = static_cast<std::int64_t>(vertices.size());
  return {static_cast<std::int32_t>(x / n), static_cast<std::int32_t>(y / n), static_cast<std::int32_t>(z / n)};
}

/// The directed border of marked faces as one loop; empty if it is another thing.
std::vector<std::uint32_t> border_loop(const IndexedMesh& mesh, const std::vector<std::uint8_t>& marked) {
  std::set<Edge> edges;
  for (std::size_t f = 0; f < marked.size(); ++f)
    for (std::size_t i = 0; marked[f] && i < 3; ++i) edges.emplace(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]);
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [u, v] : edges)
    if (!edges.contains({v, u}) && !next.emplace(u, v).second) return {};
  std::vector<std::uint32_t> loop;
  if (next.empty()) return {};
  std::uint32_t v = next.begin()->first;
  do {
    loop.push_back(v);
    const auto it = next.find(v);
    if (it == next.end() || loop.size() > next.size()) return {};
    v = it->second;
  } while (v != loop.front());
  if (loop.size() != next.size()) return {};
  return loop;
}

std::vector<std::uint8_t> one_face(const Region& region, std::uint32_t face) {
  std::vector<std::uint8_t> marked(region.mesh.faces.size(), 0);
  marked[face] = 1;
  return marked;
}

}  // namespace

std::vector<std::uint8_t> disk_around(const Region& region, std::uint32_t face, std::size_t count) {
  const auto stays = faces_that_stay(region);
  const auto faces = faces_of_edges(region.mesh);
  std::vector<std::uint8_t> marked(stays.size(), 0);
  if (stays[face]) return marked;
  std::vector<std::uint32_t> queue{face};
  marked[face] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (std::size_t e = 0; e < 3; ++e) {
      const Triangle& t = region.mesh.faces[queue[i]];
      for (const std::uint32_t g : faces.at(std::minmax(t[e], t[(e + 1) % 3]))) {
        if (marked[g] || stays[g] || queue.size() >= count) continue;
        marked[g] = 1;
        queue.push_back(g);
      }
    }
  return marked;
}

void delete_disk(Region& region, std::uint32_t face, std::size_t count) {
  remove_faces(region, disk_around(region, face, count));
}

void subdivide(Region& region, const std::vector<std::uint8_t>& marked) {
  for (std::size_t f = 0; f < marked.size(); ++f) {
    if (!marked[f]) continue;
    const Triangle t = region.mesh.faces[f];
    const std::uint32_t middle = add_vertex(region, centroid(region.mesh, {t[0], t[1], t[2]}));
    for (std::size_t i = 0; i < 3; ++i) add_face(region, {t[i], t[(i + 1) % 3], middle});
  }
  std::vector<std::uint8_t> removed = marked;
  removed.resize(region.mesh.faces.size(), 0);
  remove_faces(region, removed);
}

void coarsen_disk(Region& region, std::uint32_t face, std::size_t count) {
  std::vector<std::uint8_t> marked = disk_around(region, face, count);
  const std::vector<std::uint32_t> loop = border_loop(region.mesh, marked);
  if (loop.empty()) return;
  const std::uint32_t middle = add_vertex(region, centroid(region.mesh, loop));
  for (std::size_t i = 0; i < loop.size(); ++i) add_face(region, {loop[i], loop[(i + 1) % loop.size()], middle});
  marked.resize(region.mesh.faces.size(), 0);
  remove_faces(region, marked);
}

void delete_chart(Region& region, std::uint32_t chart) {
  std::vector<std::uint8_t> removed = faces_that_stay(region);
  for (std::size_t f = 0; f < removed.size(); ++f) removed[f] = !removed[f] && region.chart_of_face[f] == chart;
  remove_faces(region, removed);
}

void add_component(Region& region, const ramcdb::test::TestMesh& mesh, LatticePoint at) {
  const IndexedMesh component = on_lattice(mesh);
  const auto first = static_cast<std::uint32_t>(region.mesh.positions.size());
  for (const LatticePoint p : component.positions)
    (void)add_vertex(region, {at.x + p.x / 64, at.y + p.y / 64, at.z + p.z / 64});
  for (const Triangle& t : component.faces) add_face(region, {first + t[0], first + t[1], first + t[2]});
}

void glue_handle(Region& region, std::uint32_t a, std::uint32_t b) {
  // From border to border an edge of a tube might be one that charts outside have as well.
  std::set<std::uint32_t> taken(region.corners.begin(), region.corners.end());
  for (const FixedWire& wire : region.fixed) taken.insert(wire.vertices.begin(), wire.vertices.end());
  const Triangle s = region.mesh.faces[a], t = region.mesh.faces[b];
  for (const Triangle& end : {s, t})
    for (const std::uint32_t v : end)
      if (!taken.insert(v).second) return;
  const Triangle c{t[0], t[2], t[1]};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    add_face(region, {s[i], s[next], c[next]});
    add_face(region, {s[i], c[next], c[i]});
  }
  std::vector<std::uint8_t> removed(region.mesh.faces.size(), 0);
  removed[a] = removed[b] = 1;
  remove_faces(region, removed);
}

void glue_fin(Region& region, std::uint32_t face) {
  if (faces_that_stay(region)[face]) return;
  const Triangle t = region.mesh.faces[face];
  const LatticePoint p = region.mesh.positions[t[2]];
  const std::uint32_t tip = add_vertex(region, {p.x, p.y, p.z + 500});
  add_face(region, {t[0], t[1], tip});
}

void double_face(Region& region, std::uint32_t face) {
  if (!faces_that_stay(region)[face]) add_face(region, region.mesh.faces[face]);
}

void edit_at_random(Region& region, std::mt19937& random) {
  const auto faces = static_cast<std::uint32_t>(region.mesh.faces.size());
  const LatticePoint at{static_cast<std::int32_t>(random() % 60'000), static_cast<std::int32_t>(random() % 60'000), 0};
  const auto kind = random() % 9;
  if (faces == 0 || kind == 0) return add_component(region, ramcdb::test::sphere(20 + random() % 400), at);
  const auto face = static_cast<std::uint32_t>(random() % faces);
  const std::size_t count = 1 + random() % 200;
  switch (kind) {
    case 1:
      return delete_disk(region, face, count);
    case 2:
      return subdivide(region, disk_around(region, face, count));
    case 3:
      return coarsen_disk(region, face, count);
    case 4:
      return region.charts.empty() ? void()
                                   : delete_chart(region, static_cast<std::uint32_t>(random() % region.charts.size()));
    case 5:
      return glue_handle(region, face, static_cast<std::uint32_t>(random() % faces));
    case 6:
      return glue_fin(region, face);
    case 7:
      return double_face(region, face);
    default:
      return subdivide(region, one_face(region, face));
  }
}

}  // namespace ramcdb::chartify::test
