#include "api/mesh_file/gltf_plan.h"

#include <algorithm>
#include <cmath>

namespace ramcdb::mesh_file::gltf {
namespace {

/// Whether a float32, moved by the translation as readers move it, is this number.
bool holds(double value, double translation) {
  const double local = value - translation;
  return std::abs(local) <= NumberRange::kMostFloat &&
         static_cast<double>(static_cast<float>(local)) + translation == value;
}

Point choose_translation(const std::filesystem::path& file, const MeshOutput& mesh) {
  Point translation;
  if (mesh.scalar == Scalar::float32) return translation;
  for (int a = 0; a < 3; ++a) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Point& p : mesh.positions) {
      least = std::min(least, p[a]);
      most = std::max(most, p[a]);
    }
    const double candidates[] = {0, mesh.origin[a], std::floor(least / 2 + most / 2), least};
    const auto* found = std::find_if(std::begin(candidates), std::end(candidates), [&](double candidate) {
      return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                         [&](const Point& p) { return holds(p[a], candidate); });
    });
    if (found == std::end(candidates))
      throw Error(Errc::invalid_argument, "glTF holds 32-bit floats, too coarse for these coordinates", file.string(),
                  "write .ply, .obj or .off; nothing was written");
    translation[a] = *found;
  }
  return translation;
}

}  // namespace

Plan::Plan(const std::filesystem::path& file, const MeshOutput& output, DroppedCounter& dropped)
    : mesh(output),
      translation(choose_translation(file, output)),
      columns(output, dropped),
      vertices(split_vertices(output, columns.of_corners(), dropped)),
      groups(group_faces(output, vertices, columns.objects(), columns.materials(), dropped)) {
  for (const std::string& reference : output.references) drop_reference(dropped, reference);
  columns.add_masks(vertices);
  length = 12 * vertices.count;
  for (const OutColumn& column : columns.all()) {
    offsets.push_back(length);
    length += column.stride() * vertices.count;
  }
  indices_offset = length;
  std::size_t largest = 0;
  for (const Object& object : groups.objects) largest = std::max(largest, object.count);
  index_type = largest <= 0xffff ? NumberType::uint16 : NumberType::uint32;
  length += groups.triangles.size() * size_of(index_type);
}

}  // namespace ramcdb::mesh_file::gltf
