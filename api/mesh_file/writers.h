#pragma once

#include <span>
#include <vector>

#include "api/mesh_file/new_file.h"

/// One writer per format. What is written was checked; each returns what its format could not hold.
namespace ramcdb::mesh_file {

[[nodiscard]] std::vector<Dropped> write_ply(NewFile& out, const MeshOutput& mesh, bool ascii);
[[nodiscard]] std::vector<Dropped> write_obj(NewFile& out, const MeshOutput& mesh);
[[nodiscard]] std::vector<Dropped> write_off(NewFile& out, const MeshOutput& mesh);
[[nodiscard]] std::vector<Dropped> write_stl(NewFile& out, const MeshOutput& mesh);

/// Faces of a mesh to write, one after another.
template <class Visit>
void for_each_face(const MeshOutput& mesh, Visit&& visit) {
  std::size_t first = 0;
  const std::size_t faces = mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    visit(f, mesh.corners.subspan(first, size), first);
    first += size;
  }
}

[[nodiscard]] inline std::size_t face_count(const MeshOutput& mesh) {
  return mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
}

/// "vertex attribute 'quality' (float)"
[[nodiscard]] Dropped dropped_attribute(const Attribute& attribute);

[[nodiscard]] inline std::span<const double> value_of(const Attribute& attribute, std::size_t at) {
  return std::span(attribute.values).subspan(at * attribute.info.components, attribute.info.components);
}

/// Writes a number of an attribute as text.
void write_number(NewFile& out, NumberType type, double number);

}  // namespace ramcdb::mesh_file
