#pragma once

#include <algorithm>
#include <span>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/file_bytes.h"
#include "api/mesh_file/mesh_file.h"
#include "api/mesh_file/new_file.h"

/// What the writers of the formats share.
namespace ramcdb::mesh_file {

/// One writer per format; `write_mesh` has checked the mesh. What the format cannot hold is counted.
void write_ply(NewFile& out, const MeshOutput& mesh, bool ascii, DroppedCounter& dropped);
void write_obj(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped);
void write_off(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped);
void write_stl(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped);
void write_gltf(NewFile& out, const std::filesystem::path& file, const MeshOutput& mesh, DroppedCounter& dropped);
void write_glb(NewFile& out, const std::filesystem::path& file, const MeshOutput& mesh, DroppedCounter& dropped);

[[nodiscard]] inline NumberType number_type(Scalar scalar) {
  return scalar == Scalar::float32 ? NumberType::float32 : NumberType::float64;
}

[[nodiscard]] inline std::size_t face_count(const MeshOutput& mesh) {
  return mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
}

/// The corners of faces, one face after another.
class FaceWalk {
 public:
  explicit FaceWalk(const MeshOutput& mesh) : sizes_(mesh.face_sizes) {}

  /// Positions in `corners` of the next face.
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  Range next() {
    const std::size_t begin = at_;
    at_ += sizes_.empty() ? 3 : sizes_[face_++];
    return {begin, at_};
  }

 private:
  std::span<const std::uint32_t> sizes_;
  std::size_t at_ = 0, face_ = 0;
};

/// The attribute is left out, or its names are.
inline void drop_attribute(DroppedCounter& dropped, const AttributeView& attribute) {
  constexpr std::string_view kOf[] = {"", "vertex", "corner", "face"};
  dropped.add(
      std::string(kOf[static_cast<std::size_t>(attribute.info.of)]) + " attribute '" + shown(attribute.info.name) + "'",
      attribute.count());
}
inline void drop_names(DroppedCounter& dropped, const AttributeView& attribute) {
  dropped.add("names of attribute '" + shown(attribute.info.name) + "'", attribute.info.names.size());
}

/// Whether a line of text can hold it.
[[nodiscard]] inline bool is_one_line(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= ' ' || c == '\t'; });
}
inline void drop_reference(DroppedCounter& dropped, std::string_view reference) {
  dropped.add("reference '" + shown(reference) + "'");
}

/// A component of a colour as 0..1, whatever its type.
[[nodiscard]] inline double unit_color(double value, NumberType type) {
  return is_float(type) ? value : value / range_of(type).most;
}

/// Whether value i of the attribute is none: NaN in all components.
[[nodiscard]] inline bool is_none(const AttributeView& attribute, std::size_t i) {
  const auto value = std::span(attribute.values).subspan(i * attribute.info.components, attribute.info.components);
  return std::all_of(value.begin(), value.end(), [](double number) { return number != number; });
}

/// "x y z", the shortest text.
inline void write_point(NewFile& out, const Point& p, NumberType type) {
  for (int a = 0; a < 3; ++a) {
    if (a) out.text(" ");
    out.number(p[a], type);
  }
}

}  // namespace ramcdb::mesh_file
