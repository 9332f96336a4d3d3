#include "api/edited_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::vector<std::uint32_t> identity(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

/// First faces of the charts of a region, and the end of the last.
std::vector<std::uint32_t> chart_starts(const RegionMesh& region) {
  std::vector<std::uint32_t> starts(region.charts.size() + 1, 0);
  for (const std::uint32_t chart : region.chart_of_face) ++starts[chart + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

/// Which vertices and faces of one region those of another are, over the charts that both have.
struct RegionMap {
  std::vector<std::uint32_t> vertices, faces;  ///< from -> to, or kNew

  RegionMap(const RegionMesh& from, const RegionMesh& to)
      : vertices(from.points.size(), kNew), faces(from.faces.size(), kNew) {
    const std::vector<std::uint32_t> mine = chart_starts(from), theirs = chart_starts(to);
    std::unordered_map<std::uint64_t, std::uint32_t> inner;
    for (std::uint32_t v = 0; v < to.keys.size(); ++v)
      if (to.keys[v].where == VertexKey::Where::chart) inner.emplace(to.keys[v].packed(), v);
    for (std::size_t c = 0; c < from.charts.size(); ++c) {
      const auto it = std::lower_bound(to.charts.begin(), to.charts.end(), from.charts[c]);
      if (it == to.charts.end() || *it != from.charts[c]) continue;
      const auto d = static_cast<std::size_t>(it - to.charts.begin());
      if (mine[c + 1] - mine[c] != theirs[d + 1] - theirs[d])
        throw Error(Errc::conflict, "a chart is not what the edit was made on");
      for (std::uint32_t f = mine[c]; f < mine[c + 1]; ++f) {
        faces[f] = theirs[d] + (f - mine[c]);
        for (int i = 0; i < 3; ++i) vertices[from.faces[f][i]] = to.faces[faces[f]][i];
      }
    }
    for (std::uint32_t v = 0; v < from.keys.size(); ++v)  // isolated ones are in no face
      if (const auto it = inner.find(from.keys[v].packed()); vertices[v] == kNew && it != inner.end())
        vertices[v] = it->second;
  }
};

void append_value(std::vector<double>& to, const std::vector<double>& from, std::size_t at, std::size_t components) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(at * components);
  to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(components));
}

/// Takes parts of meshes over into one, with their attributes and polygons.
class Collector {
 public:
  explicit Collector(const RegionMesh& like) {
    for (const Attribute& attribute : like.attributes) out_.mesh.attributes.push_back({attribute.info, {}});
  }

  std::uint32_t add_vertex(const RegionMesh& from, std::uint32_t v, std::uint32_t source) {
    out_.mesh.points.push_back(from.points[v]);
    if (!from.exact.empty()) out_.mesh.exact.push_back(from.exact[v]);
    out_.vertex_source.push_back(source);
    take(from, AttributeOf::vertex, v);
    return static_cast<std::uint32_t>(out_.mesh.points.size() - 1);
  }

  void add_face(const RegionMesh& from, std::uint32_t f, const Triangle& vertices, std::uint32_t source) {
    out_.mesh.faces.push_back(vertices);
    out_.face_source.push_back(source);
    for (std::uint32_t i = 0; i < 3; ++i) take(from, AttributeOf::corner, 3 * f + i);
    take(from, AttributeOf::face, f);
  }

  /// \param face_of faces of `from` -> faces added, or kNew
  void add_polygons(const RegionMesh& from, const std::vector<std::uint32_t>& face_of) {
    std::vector<std::uint32_t> number(from.polygon_sizes.size(), kNew);
    std::vector<std::uint32_t>& of_face = out_.mesh.polygon_of_face;
    of_face.resize(out_.mesh.faces.size(), kNew);
    std::uint32_t first = 0;
    for (std::uint32_t p = 0; p < from.polygon_sizes.size(); first += from.polygon_sizes[p++]) {
      if (face_of[from.polygon_corners[first] / 3] == kNew) continue;
      number[p] = static_cast<std::uint32_t>(out_.mesh.polygon_sizes.size());
      out_.mesh.polygon_sizes.push_back(from.polygon_sizes[p]);
      for (std::uint32_t i = 0; i < from.polygon_sizes[p]; ++i) {
        const std::uint32_t corner = from.polygon_corners[first + i];
        out_.mesh.polygon_corners.push_back(3 * face_of[corner / 3] + corner % 3);
      }
    }
    for (std::uint32_t f = 0; f < face_of.size(); ++f)
      if (face_of[f] != kNew && !from.polygon_of_face.empty()) of_face[face_of[f]] = number[from.polygon_of_face[f]];
  }

  [[nodiscard]] RegionMesh& mesh() { return out_.mesh; }

  EditedRegion finish() {
    add_triangles(out_.mesh);
    return std::move(out_);
  }

 private:
  void take(const RegionMesh& from, AttributeOf of, std::size_t at) {
    for (std::size_t a = 0; a < out_.mesh.attributes.size(); ++a)
      if (const Attribute& attribute = from.attributes[a]; attribute.info.of == of)
        append_value(out_.mesh.attributes[a].values, attribute.values, at, attribute.info.components);
  }

  EditedRegion out_;
};

}  // namespace

void add_triangles(RegionMesh& mesh) {
  if (mesh.polygon_sizes.empty()) mesh.polygon_of_face.clear();
  for (std::uint32_t f = 0; f < mesh.polygon_of_face.size(); ++f) {
    if (mesh.polygon_of_face[f] != kNew) continue;
    mesh.polygon_of_face[f] = static_cast<std::uint32_t>(mesh.polygon_sizes.size());
    mesh.polygon_sizes.push_back(3);
    for (std::uint32_t i = 0; i < 3; ++i) mesh.polygon_corners.push_back(3 * f + i);
  }
}

EditedRegion unedited(const RegionMesh& region) {
  EditedRegion edited{region, identity(region.points.size()), identity(region.faces.size())};
  edited.mesh.charts.clear();
  edited.mesh.keys.clear();
  edited.mesh.outer_border.clear();
  edited.mesh.chart_of_face.clear();
  return edited;
}

EditedRegion transferred(const EditedRegion& edited, const RegionMesh& from, const RegionMesh& to,
                         const std::vector<bool>& without) {
  const RegionMap map(from, to);
  const RegionMesh& mesh = edited.mesh;
  const auto stays = [&](std::uint32_t f) {
    return edited.face_source[f] == kNew || map.faces[edited.face_source[f]] != kNew;
  };
  std::vector<bool> used(mesh.points.size(), false), wanted(mesh.points.size(), false);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) used[v] = true, wanted[v] = wanted[v] || stays(f);

  Collector out(to);
  std::vector<std::uint32_t> vertex_of(mesh.points.size(), kNew), here(to.points.size(), kNew);
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (!without.empty() && without[v]) continue;
    const std::uint32_t source = edited.vertex_source[v];
    const std::uint32_t there = source == kNew ? kNew : map.vertices[source];
    if (used[v] ? !wanted[v] && there == kNew : source != kNew && there == kNew) continue;
    if (source != kNew && there == kNew) throw Error(Errc::conflict, "a vertex that the edit builds on is not there");
    vertex_of[v] = out.add_vertex(mesh, v, there);
    if (there != kNew) here[there] = vertex_of[v];
  }
  std::vector<bool> known(to.faces.size(), false), seen(to.points.size(), false);
  for (std::uint32_t f = 0; f < from.faces.size(); ++f)
    if (map.faces[f] != kNew) known[map.faces[f]] = true;
  for (const std::uint32_t v : map.vertices)
    if (v != kNew) seen[v] = true;
  for (std::uint32_t v = 0; v < to.points.size(); ++v)
    if (!seen[v]) here[v] = out.add_vertex(to, v, v);

  std::vector<std::uint32_t> face_of(mesh.faces.size(), kNew), face_here(to.faces.size(), kNew);
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (!stays(f)) continue;
    const Triangle& t = mesh.faces[f];
    const std::uint32_t source = edited.face_source[f];
    out.add_face(mesh, f, {vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]},
                 source == kNew ? kNew : map.faces[source]);
    face_of[f] = count++;
  }
  for (std::uint32_t f = 0; f < to.faces.size(); ++f) {
    if (known[f]) continue;
    const Triangle& t = to.faces[f];
    for (const std::uint32_t v : t)  // a corner that the edit left stays with the others
      if (here[v] == kNew) here[v] = out.add_vertex(to, v, v);
    out.add_face(to, f, {here[t[0]], here[t[1]], here[t[2]]}, f);
    face_here[f] = count++;
  }
  out.add_polygons(mesh, face_of);
  out.add_polygons(to, face_here);
  return out.finish();
}

namespace {

/// The second of two edits on top of the first.
class Joiner {
 public:
  Joiner(const EditedRegion& first, const EditedRegion& second, const RegionMesh& part, const RegionMesh& region)
      : first_(first), second_(second), part_(part), region_(region), map_(part, region), out_(region) {}

  EditedRegion run() {
    mark_faces_of_part();
    mark_vertices_gone();
    add_vertices();
    add_faces();
    return out_.finish();
  }

 private:
  void mark_faces_of_part() {
    of_part_.assign(region_.faces.size(), false);
    for (const std::uint32_t f : map_.faces) of_part_[f] = true;
  }

  [[nodiscard]] bool leaves(std::uint32_t face) const {
    return first_.face_source[face] != kNew && of_part_[first_.face_source[face]];
  }

  /// Those of the part that the second edit does not have, unless faces outside the part do.
  void mark_vertices_gone() {
    std::vector<bool> kept(part_.points.size(), false);
    for (const std::uint32_t source : second_.vertex_source)
      if (source != kNew) kept[source] = true;
    gone_.assign(region_.points.size(), false);
    for (std::uint32_t v = 0; v < kept.size(); ++v) gone_[map_.vertices[v]] = !kept[v];
    for (std::uint32_t f = 0; f < first_.mesh.faces.size(); ++f)
      for (const std::uint32_t v : first_.mesh.faces[f])
        if (const std::uint32_t source = first_.vertex_source[v]; source != kNew && !leaves(f)) gone_[source] = false;
  }

  void add_vertices() {
    std::vector<std::uint32_t> of_second(region_.points.size(), kNew);
    for (std::uint32_t v = 0; v < second_.vertex_source.size(); ++v)
      if (second_.vertex_source[v] != kNew) of_second[map_.vertices[second_.vertex_source[v]]] = v;
    first_vertex_.assign(first_.mesh.points.size(), kNew);
    second_vertex_.assign(second_.mesh.points.size(), kNew);
    for (std::uint32_t u = 0; u < first_.mesh.points.size(); ++u) {
      const std::uint32_t source = first_.vertex_source[u];
      if (source != kNew && gone_[source]) continue;
      first_vertex_[u] = out_.add_vertex(first_.mesh, u, source);
      if (source == kNew || of_second[source] == kNew) continue;
      second_vertex_[of_second[source]] = first_vertex_[u];
      merge(u, of_second[source], source, first_vertex_[u]);
    }
    for (std::uint32_t v = 0; v < second_.mesh.points.size(); ++v)
      if (second_.vertex_source[v] == kNew) second_vertex_[v] = out_.add_vertex(second_.mesh, v, kNew);
  }

  void add_faces() {
    std::vector<std::uint32_t> first_face(first_.mesh.faces.size(), kNew), second_face(second_.mesh.faces.size(), kNew);
    std::uint32_t count = 0;
    const auto vertices = [](const Triangle& t, const std::vector<std::uint32_t>& of) {
      return Triangle{of[t[0]], of[t[1]], of[t[2]]};
    };
    for (std::uint32_t f = 0; f < first_face.size(); ++f) {
      if (leaves(f)) continue;
      out_.add_face(first_.mesh, f, vertices(first_.mesh.faces[f], first_vertex_), first_.face_source[f]);
      first_face[f] = count++;
    }
    for (std::uint32_t f = 0; f < second_face.size(); ++f) {
      const std::uint32_t source = second_.face_source[f];
      out_.add_face(second_.mesh, f, vertices(second_.mesh.faces[f], second_vertex_),
                    source == kNew ? kNew : map_.faces[source]);
      second_face[f] = count++;
    }
    out_.add_polygons(first_.mesh, first_face);
    out_.add_polygons(second_.mesh, second_face);
  }

  /// What either edit did to a vertex that both have.
  void merge(std::uint32_t u, std::uint32_t v, std::uint32_t source, std::uint32_t to) {
    RegionMesh& mesh = out_.mesh();
    const auto both = [&](const auto& first, const auto& second, const auto& was, const char* what) {
      if (second == was) return first;
      if (first != was && first != second) refuse(source, what);
      return second;
    };
    mesh.points[to] = both(first_.mesh.points[u], second_.mesh.points[v], region_.points[source],
                           "moved their shared vertex to different places");
    if (!mesh.exact.empty())
      mesh.exact[to] = both(first_.mesh.exact[u], second_.mesh.exact[v], region_.exact[source],
                            "moved their shared vertex to different places");
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
      if (mesh.attributes[a].info.of != AttributeOf::vertex) continue;
      const std::size_t components = mesh.attributes[a].info.components;
      for (std::size_t k = 0; k < components; ++k)
        mesh.attributes[a].values[to * components + k] = std::bit_cast<double>(
            both(std::bit_cast<std::uint64_t>(first_.mesh.attributes[a].values[u * components + k]),
                 std::bit_cast<std::uint64_t>(second_.mesh.attributes[a].values[v * components + k]),
                 std::bit_cast<std::uint64_t>(region_.attributes[a].values[source * components + k]),
                 "gave their shared vertex different values"));
    }
  }

  [[noreturn]] void refuse(std::uint32_t source, const char* what) const {
    const LatticePoint p = region_.points[source];
    throw Error(Errc::invalid_argument, fmt::format("two patches {}", what),
                fmt::format("near lattice point {},{},{}", p.x, p.y, p.z), "check both regions out as one patch");
  }

  const EditedRegion& first_;
  const EditedRegion& second_;
  const RegionMesh& part_;
  const RegionMesh& region_;
  RegionMap map_;
  Collector out_;
  std::vector<bool> of_part_, gone_;
  std::vector<std::uint32_t> first_vertex_, second_vertex_;
};

}  // namespace

EditedRegion joined(const EditedRegion& first, const EditedRegion& second, const RegionMesh& part,
                    const RegionMesh& region) {
  return Joiner(first, second, part, region).run();
}

std::vector<Attribute> attributes_in_region(const EditedRegion& edited, const RegionMesh& region) {
  std::vector<Attribute> attributes = region.attributes;
  for (std::size_t a = 0; a < attributes.size(); ++a) {
    const std::size_t components = attributes[a].info.components;
    const std::vector<double>& from = edited.mesh.attributes[a].values;
    const auto put = [&](std::size_t to, std::size_t at) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at * components), components,
                  attributes[a].values.begin() + static_cast<std::ptrdiff_t>(to * components));
    };
    if (attributes[a].info.of == AttributeOf::vertex) {
      for (std::size_t v = 0; v < edited.vertex_source.size(); ++v)
        if (edited.vertex_source[v] != kNew) put(edited.vertex_source[v], v);
      continue;
    }
    const std::size_t per_face = attributes[a].info.of == AttributeOf::corner ? 3 : 1;
    for (std::size_t f = 0; f < edited.face_source.size(); ++f)
      for (std::size_t i = 0; edited.face_source[f] != kNew && i < per_face; ++i)
        put(per_face * edited.face_source[f] + i, per_face * f + i);
  }
  return attributes;
}

}  // namespace ramcdb::detail
