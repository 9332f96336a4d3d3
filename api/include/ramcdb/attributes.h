#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What a mesh holds beside positions and faces, as plain values: colours, normals, texture coordinates, materials,
/// groups, and any other number of a vertex, a corner of a face, or a face.
namespace ramcdb {

/// What has a value each. A corner is a vertex as one face sees it; corners come face after face.
enum class AttributeOf : std::uint8_t { vertex = 1, corner = 2, face = 3 };

/// The type of an attribute's numbers, as in its file.
enum class NumberType : std::uint8_t { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64 };

/// What programs take an attribute for.
enum class Meaning : std::uint8_t {
  other = 1,
  color,     ///< 3 or 4 components: red, green, blue, alpha; integers 0..max of the type, or floats 0..1
  normal,    ///< 3 components
  texture,   ///< 2 or 3 components: texture coordinates
  material,  ///< 1 component: index into `names`
  group,     ///< 1 component: index into `names`
};

struct AttributeInfo {
  std::string name;  ///< no two of one mesh are equal
  AttributeOf of = AttributeOf::vertex;
  NumberType type = NumberType::float32;
  std::uint8_t components = 1;  ///< numbers per value, 1..16
  Meaning meaning = Meaning::other;
  std::vector<std::string> fields;  ///< per component its name in a PLY file; empty: the customary ones
  std::vector<std::string> names;   ///< of materials and groups, by value

  friend bool operator==(const AttributeInfo&, const AttributeInfo&) = default;
};

struct Attribute {
  AttributeInfo info;
  /// `info.components` numbers per vertex, corner or face. A double holds every number of every type exactly. NaN in
  /// all components of a value says that there is none.
  std::vector<double> values;

  [[nodiscard]] std::size_t count() const { return values.size() / info.components; }
};

[[nodiscard]] constexpr bool is_float(NumberType type) {
  return type == NumberType::float32 || type == NumberType::float64;
}

}  // namespace ramcdb
