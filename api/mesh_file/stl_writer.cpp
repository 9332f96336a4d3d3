#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "api/mesh_file/triangulate.h"
#include "api/mesh_file/writers.h"

/// Binary STL: polygons as triangles, each with a normal of its own and its polygon's attribute bytes.
namespace ramcdb::mesh_file {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of STL and PLY writers");

/// The unit normal that STL wants, zero for triangles without area or too large for it.
std::array<float, 3> facet_normal(const Point& a, const Point& b, const Point& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {static_cast<float>(nx / length), static_cast<float>(ny / length), static_cast<float>(nz / length)};
}

bool is_facet_bytes(const AttributeInfo& info) {
  return info.name == "attribute" && info.of == AttributeOf::face && info.type == NumberType::uint16 &&
         info.components == 1;
}

}  // namespace

void write_stl(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped) {
  const AttributeView* bytes = nullptr;
  for (const AttributeView& attribute : mesh.attributes)
    if (is_facet_bytes(attribute.info) && !bytes)
      bytes = &attribute;
    else
      drop_attribute(dropped, attribute);
  for (const std::string& reference : mesh.references) drop_reference(dropped, reference);
  Triangulation cut;  // triangles are as they are
  if (!mesh.face_sizes.empty()) cut = triangulate(mesh.positions, mesh.corners, mesh.face_sizes);
  const std::size_t count = mesh.face_sizes.empty() ? mesh.corners.size() / 3 : cut.corners.size();
  std::array<char, 80> header{};
  constexpr std::string_view kTitle = "binary STL written by ramcdb";
  std::copy(kTitle.begin(), kTitle.end(), header.begin());
  out.text({header.data(), header.size()});
  out.binary(static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto corner = static_cast<std::uint32_t>(3 * i);
    const Triangle t = mesh.face_sizes.empty() ? Triangle{corner, corner + 1, corner + 2} : cut.corners[i];
    const Point* p[3];
    for (std::size_t c = 0; c < 3; ++c) p[c] = &mesh.positions[mesh.corners[t[c]]];
    for (const float n : facet_normal(*p[0], *p[1], *p[2])) out.binary(n);
    for (const Point* at : p)
      for (int a = 0; a < 3; ++a) out.binary(static_cast<float>((*at)[a]));
    const double value = bytes ? bytes->values[mesh.face_sizes.empty() ? i : cut.face[i]] : 0;
    out.binary(static_cast<std::uint16_t>(value > 0 ? value : 0));  // NaN is 0
  }
}

}  // namespace ramcdb::mesh_file
