#include "api/edited_region_builder.h"

#include <algorithm>
#include <limits>

namespace ramcdb::detail {
EditedRegionBuilder::EditedRegionBuilder(const Snapshot::Impl& at, const RegionMesh& region)
    : at_(at), region_(region) {
  out_.mesh.points.reserve(region.points.size());
  out_.mesh.faces.reserve(region.faces.size());
}

std::uint32_t EditedRegionBuilder::add_vertex(std::uint32_t source, const Point& position) {
  const Point kept = at_.record().rounded(position);
  out_.mesh.points.push_back(at_.record().lattice.snap(kept));
  if (at_.record().exact) out_.mesh.exact.push_back(kept);
  out_.vertex_source.push_back(source);
  return static_cast<std::uint32_t>(out_.mesh.points.size() - 1);
}

std::uint32_t EditedRegionBuilder::add_face(const Triangle& vertices, std::uint32_t source) {
  out_.mesh.faces.push_back(vertices);
  out_.face_source.push_back(source);
  return static_cast<std::uint32_t>(out_.mesh.faces.size() - 1);
}

void EditedRegionBuilder::add_polygon(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> faces) {
  RegionMesh& mesh = out_.mesh;
  mesh.polygon_of_face.resize(mesh.faces.size(), kNew);
  for (const std::uint32_t f : faces) mesh.polygon_of_face[f] = static_cast<std::uint32_t>(mesh.polygon_sizes.size());
  mesh.polygon_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  mesh.polygon_corners.insert(mesh.polygon_corners.end(), corners.begin(), corners.end());
}

void EditedRegionBuilder::take_new(const RegionMesh& from, std::vector<std::uint32_t> vertices,
                                   std::vector<std::uint32_t> faces) {
  new_from_ = &from;
  new_vertices_ = std::move(vertices);
  new_faces_ = std::move(faces);
  std::vector<std::vector<std::uint32_t>> faces_of(from.polygon_sizes.size());
  for (std::uint32_t f = 0; f < from.polygon_of_face.size(); ++f)
    if (new_faces_[f] != kNew) faces_of[from.polygon_of_face[f]].push_back(new_faces_[f]);
  std::vector<std::uint32_t> corners;
  for (std::size_t p = 0, first = 0; p < faces_of.size(); first += from.polygon_sizes[p++]) {
    if (from.polygon_sizes[p] == 3 || faces_of[p].size() + 2 != from.polygon_sizes[p]) continue;
    corners.clear();
    for (std::size_t i = first; i < first + from.polygon_sizes[p]; ++i)
      corners.push_back(3 * new_faces_[from.polygon_corners[i] / 3] + from.polygon_corners[i] % 3);
    add_polygon(corners, faces_of[p]);
  }
}

EditedRegion EditedRegionBuilder::finish(std::span<const Attribute> attributes) {
  keep_polygons();
  take_values(attributes);
  return std::move(out_);
}

void EditedRegionBuilder::keep_polygons() {
  RegionMesh& mesh = out_.mesh;
  mesh.polygon_of_face.resize(mesh.faces.size(), kNew);
  std::vector<std::uint32_t> now(region_.faces.size(), kNew), number(region_.polygon_sizes.size(), 0);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    if (out_.face_source[f] != kNew) now[out_.face_source[f]] = f;
  for (std::uint32_t f = 0; f < region_.polygon_of_face.size(); ++f)
    if (now[f] == kNew) number[region_.polygon_of_face[f]] = kNew;
  for (std::size_t p = 0, first = 0; p < region_.polygon_sizes.size(); first += region_.polygon_sizes[p++]) {
    if (number[p] == kNew) continue;
    number[p] = static_cast<std::uint32_t>(mesh.polygon_sizes.size());
    mesh.polygon_sizes.push_back(region_.polygon_sizes[p]);
    for (std::size_t i = first; i < first + region_.polygon_sizes[p]; ++i)
      mesh.polygon_corners.push_back(3 * now[region_.polygon_corners[i] / 3] + region_.polygon_corners[i] % 3);
  }
  for (std::uint32_t f = 0; f < region_.polygon_of_face.size(); ++f)
    if (now[f] != kNew) mesh.polygon_of_face[now[f]] = number[region_.polygon_of_face[f]];
  if (std::ranges::all_of(mesh.polygon_sizes, [](std::uint32_t size) { return size == 3; })) {
    mesh.polygon_of_face.clear();
    mesh.polygon_sizes.clear();
    mesh.polygon_corners.clear();
  }
  add_triangles(mesh);
}

void EditedRegionBuilder::take_values(std::span<const Attribute> attributes) {
  for (const Attribute& before : attributes) {
    const std::size_t components = before.info.components;
    const std::size_t per_face = before.info.of == AttributeOf::corner ? 3 : 1;
    Attribute& now = out_.mesh.attributes.emplace_back(Attribute{before.info, {}});
    const auto take = [&](std::size_t to, std::size_t from, std::size_t count) {
      std::copy_n(before.values.begin() + static_cast<std::ptrdiff_t>(from * components), count * components,
                  now.values.begin() + static_cast<std::ptrdiff_t>(to * components));
    };
    const bool of_vertices = before.info.of == AttributeOf::vertex;
    const auto& sources = of_vertices ? out_.vertex_source : out_.face_source;
    now.values.assign(sources.size() * components * (of_vertices ? 1 : per_face),
                      std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (sources[i] == kNew) continue;
      if (of_vertices)
        take(i, sources[i], 1);
      else
        take(per_face * i, per_face * sources[i], per_face);
    }
    if (new_from_) take_new_values(out_.mesh.attributes.size() - 1);
  }
}

void EditedRegionBuilder::take_new_values(std::size_t attribute) {
  const Attribute& from = new_from_->attributes[attribute];
  Attribute& to = out_.mesh.attributes[attribute];
  const std::size_t per = from.info.components * (from.info.of == AttributeOf::corner ? 3 : std::size_t{1});
  const auto& became = from.info.of == AttributeOf::vertex ? new_vertices_ : new_faces_;
  for (std::size_t i = 0; i < became.size(); ++i)
    if (became[i] != kNew)
      std::copy_n(from.values.begin() + static_cast<std::ptrdiff_t>(per * i), per,
                  to.values.begin() + static_cast<std::ptrdiff_t>(per * became[i]));
}

}  // namespace ramcdb::detail
