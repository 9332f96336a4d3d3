#pragma once

#include <limits>
#include <string>
#include <vector>

#include "api/mesh_file/ply_header.h"
#include "ramcdb/attributes.h"

/// Which properties of a PLY file become which attributes.
namespace ramcdb::mesh_file::ply {

/// What becomes of one property, beside its role.
struct Column {
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t attribute = kNone;  ///< position among the mesh's attributes
  std::size_t component = 0;
  bool is_texture_list = false;  ///< of faces: two numbers per corner
};

/// Adds the attributes of an element ("vertex" or "face") to `attributes`, with `element.count` values each (texture
/// lists: none yet), and says for each property where it goes. Properties of one type that customarily belong together
/// (red green blue, nx ny nz, u v, s t) become one attribute. Names that are taken get the element's name in front.
[[nodiscard]] std::vector<Column> plan_attributes(const Element& element, std::vector<Attribute>& attributes);

/// The range of an integer type.
struct Range {
  double low, high;
};
[[nodiscard]] inline Range range_of(Type type) {
  constexpr Range kRanges[] = {{-128, 127},      {0, 255}, {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647.0},
                               {0, 4294967295.0}};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return type == Type::float32 || type == Type::float64 ? Range{-kFar, kFar} : kRanges[static_cast<std::size_t>(type)];
}

}  // namespace ramcdb::mesh_file::ply
