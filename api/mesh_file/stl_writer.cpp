#include <array>
#include <cmath>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {
namespace {

/// The unit normal that STL wants, zero for triangles without area or too large for it.
std::array<float, 3> facet_normal(const Point& a, const Point& b, const Point& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {static_cast<float>(nx / length), static_cast<float>(ny / length), static_cast<float>(nz / length)};
}

/// What the two bytes behind a facet hold.
const Attribute* facet_attribute(const MeshOutput& mesh) {
  for (const Attribute& attribute : mesh.attributes)
    if (attribute.info.of == AttributeOf::face && attribute.info.name == "attribute" &&
        attribute.info.type == NumberType::uint16 && attribute.info.components == 1)
      return &attribute;
  return nullptr;
}

}  // namespace

std::vector<Dropped> write_stl(NewFile& out, const MeshOutput& mesh) {
  MeshData polygons;
  polygons.positions.assign(mesh.positions.begin(), mesh.positions.end());
  polygons.corners.assign(mesh.corners.begin(), mesh.corners.end());
  polygons.face_sizes.assign(mesh.face_sizes.begin(), mesh.face_sizes.end());
  const Triangulation cut = triangulate(polygons);
  const Attribute* bytes = facet_attribute(mesh);

  std::array<char, 80> header{};
  constexpr std::string_view kTitle = "binary STL written by ramcdb";
  std::copy(kTitle.begin(), kTitle.end(), header.begin());
  out.text({header.data(), header.size()});
  out.binary(static_cast<std::uint32_t>(cut.corners.size()));
  for (std::size_t f = 0; f < cut.corners.size(); ++f) {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.positions[mesh.corners[cut.corners[f][i]]];
    for (const float n : facet_normal(p[0], p[1], p[2])) out.binary(n);
    for (const Point& corner : p)
      for (int a = 0; a < 3; ++a) out.binary(static_cast<float>(corner[a]));
    out.binary(static_cast<std::uint16_t>(bytes ? bytes->values[cut.face[f]] : 0));
  }
  std::vector<Dropped> dropped;
  if (cut.polygons) dropped.push_back({"polygons (written as triangles)", cut.polygons});
  for (const Attribute& attribute : mesh.attributes)
    if (&attribute != bytes) dropped.push_back(dropped_attribute(attribute));
  return dropped;
}

}  // namespace ramcdb::mesh_file
