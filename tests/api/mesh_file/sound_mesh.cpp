#include "tests/api/mesh_file/sound_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/mesh_file/attribute_names.h"

namespace ramcdb::test {
namespace {

/// One value each, all of the type; names that exist; a name of its own.
bool is_sound(const Attribute& attribute, const mesh_file::MeshData& mesh) {
  const AttributeInfo& info = attribute.info;
  const std::size_t count = info.of == AttributeOf::vertex   ? mesh.positions.size()
                            : info.of == AttributeOf::corner ? mesh.corners.size()
                                                             : mesh.face_count();
  const auto range = mesh_file::range_of(info.type);
  return info.components >= 1 && attribute.values.size() == count * info.components &&
         (info.fields.empty() || info.fields.size() == info.components) &&
         std::all_of(attribute.values.begin(), attribute.values.end(),
                     [&](double value) {
                       return range.holds(value) &&
                              (info.names.empty() || value < static_cast<double>(info.names.size()));
                     }) &&
         std::count_if(mesh.attributes.begin(), mesh.attributes.end(),
                       [&](const Attribute& other) { return other.info.name == info.name; }) == 1;
}

}  // namespace

bool is_sound(const mesh_file::MeshData& mesh) {
  const auto finite = [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  const auto exists = [&](std::uint32_t v) { return v < mesh.positions.size(); };
  const std::size_t corners = mesh.face_sizes.empty()
                                  ? mesh.face_count() * 3
                                  : std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), std::size_t{0});
  return !mesh.positions.empty() && corners == mesh.corners.size() &&
         std::all_of(mesh.positions.begin(), mesh.positions.end(), finite) &&
         std::all_of(mesh.corners.begin(), mesh.corners.end(), exists) &&
         (mesh.vertex_ids.empty() || mesh.vertex_ids.size() == mesh.positions.size()) &&
         std::all_of(mesh.attributes.begin(), mesh.attributes.end(),
                     [&](const Attribute& attribute) { return is_sound(attribute, mesh); });
}

}  // namespace ramcdb::test
