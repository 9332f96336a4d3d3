#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/mesh_file/writers.h"

/// What a glTF file is made of, planned from a mesh before a byte is written.
namespace ramcdb::mesh_file::gltf {

inline constexpr std::uint32_t kNoCorner = 0xffffffff;

/// Vertices as they are written: those of the mesh in their order, each followed by its copies for corners that differ.
struct Vertices {
  std::vector<std::uint32_t> source;     ///< vertex of the mesh; empty: vertex i is i
  std::vector<std::uint32_t> corner;     ///< one with its values, kNoCorner for vertices without faces; likewise
  std::vector<std::uint32_t> of_corner;  ///< per corner of the mesh; empty: MeshOutput::corners
  std::size_t count = 0;

  [[nodiscard]] std::uint32_t vertex(std::size_t i) const {
    return source.empty() ? static_cast<std::uint32_t>(i) : source[i];
  }
};

/// Copies vertices whose corners have different values of one of `attributes`, which are of corners.
[[nodiscard]] Vertices split_vertices(const MeshOutput& mesh, const std::vector<const AttributeView*>& attributes,
                                      DroppedCounter& dropped);

/// Triangles of one object that have one material.
struct Part {
  std::optional<std::size_t> material;  ///< in Groups::materials
  std::size_t first = 0, count = 0;     ///< triangles, in Groups::triangles
};

struct Object {
  std::string name;  ///< may be empty
  std::vector<Part> parts;
  std::size_t first = 0, count = 0;  ///< vertices that its accessors hold
};

struct Groups {
  std::vector<std::string> materials;
  std::vector<Object> objects;           ///< none when there is no face
  std::vector<std::uint32_t> triangles;  ///< vertices of triangles, part after part
};

/// Cuts polygons, and puts the triangles in order. Objects get vertices of their own where no vertex lies between those
/// of another; else all have all, so that each vertex is written once.
[[nodiscard]] Groups group_faces(const MeshOutput& mesh, const Vertices& vertices, const AttributeView* objects,
                                 const AttributeView* materials, DroppedCounter& dropped);

/// An attribute's numbers as they are written, each vertex at a multiple of four bytes.
struct OutColumn {
  std::string name;
  const AttributeView* attribute = nullptr;  ///< null: vertex ids
  NumberType type = NumberType::float32;
  std::size_t components = 0;
  bool normalized = false;  ///< integers that stand for 0..1
  bool unit = false;        ///< floats 0..1 of an integer colour
  bool mask = false;        ///< not the attribute's numbers but which of them are none, a bit each
  std::size_t bits = 0;     ///< of a mask: components of the column that it is for

  [[nodiscard]] std::size_t stride() const { return (components * size_of(type) + 3) / 4 * 4; }
};

/// The columns that glTF has a place for; the attributes of faces that it has none for, and others, are counted.
class Columns {
 public:
  Columns(const MeshOutput& mesh, DroppedCounter& dropped);

  [[nodiscard]] const std::vector<OutColumn>& all() const { return all_; }
  [[nodiscard]] const AttributeView* objects() const { return objects_; }
  [[nodiscard]] const AttributeView* materials() const { return materials_; }
  [[nodiscard]] std::vector<const AttributeView*> of_corners() const;
  /// Adds a mask for each column that some vertices have no value of: glTF has no number that says so.
  void add_masks(const Vertices& vertices);

 private:
  void place(const AttributeView& attribute);
  void place_of_face(const AttributeView& attribute);
  bool place_custom(const AttributeView& attribute);
  bool add(const AttributeView& attribute, std::string name, NumberType type, std::size_t components);
  void number(std::string_view word, std::string_view base, std::vector<const AttributeView*>& attributes);

  DroppedCounter& dropped_;
  std::vector<OutColumn> all_;
  std::vector<const AttributeView*> textures_, colors_;
  const AttributeView *objects_ = nullptr, *materials_ = nullptr, *normal_ = nullptr;
};

/// The number of an attribute's column at a written vertex; NaN: there is none.
[[nodiscard]] inline double attribute_number(const OutColumn& column, const Vertices& vertices, std::size_t i,
                                             std::size_t component) {
  const AttributeView& attribute = *column.attribute;
  std::size_t at = vertices.vertex(i);
  if (attribute.info.of == AttributeOf::corner) {
    if (vertices.corner[i] == kNoCorner) return std::numeric_limits<double>::quiet_NaN();
    at = vertices.corner[i];
  }
  const double value = attribute.values[at * attribute.info.components + component];
  return column.unit ? unit_color(value, attribute.info.type) : value;
}

/// The number of a column at a written vertex; NaN: there is none, of a mask: it says nothing.
[[nodiscard]] inline double number_at(const OutColumn& column, const Vertices& vertices, std::size_t i,
                                      std::size_t component) {
  if (!column.mask) return attribute_number(column, vertices, i, component);
  unsigned bits = 0;
  for (std::size_t c = 0; c < column.bits; ++c) {
    const double value = attribute_number(column, vertices, i, c);
    bits |= static_cast<unsigned>(value != value) << c;
  }
  return bits ? static_cast<double>(bits) : std::numeric_limits<double>::quiet_NaN();
}

/// A number that no float32 is, or that glTF has none for, is written as the nearest, or 0, and counted.
void count_changes(const OutColumn& column, const Vertices& vertices, std::size_t first, std::size_t count,
                   DroppedCounter& dropped);

/// Whether no vertex of these has a value.
[[nodiscard]] bool has_none(const OutColumn& column, const Vertices& vertices, std::size_t first, std::size_t count);

/// The plan of a whole file. Its buffer holds positions, then an attribute after another, then indices of all
/// triangles.
struct Plan {
  /// Throws invalid_argument where float32 and a translation cannot hold the coordinates of a float64 mesh.
  Plan(const std::filesystem::path& file, const MeshOutput& mesh, DroppedCounter& dropped);

  [[nodiscard]] float coordinate(std::size_t i, int axis) const {
    return static_cast<float>(mesh.positions[vertices.vertex(i)][axis] - translation[axis]);
  }

  const MeshOutput& mesh;
  Point translation;  ///< of all nodes
  Columns columns;
  Vertices vertices;
  Groups groups;
  std::vector<std::size_t> offsets;  ///< of columns in the buffer
  std::size_t indices_offset = 0, length = 0;
  NumberType index_type = NumberType::uint32;
};

inline constexpr std::string_view kDataUri = "data:application/octet-stream;base64,";

/// The file's JSON; where `embedded`, the base64 of the buffer is to stand behind the first kDataUri in it. Counts what
/// values lose.
[[nodiscard]] std::string compose_json(const Plan& plan, bool embedded, DroppedCounter& dropped);

}  // namespace ramcdb::mesh_file::gltf
