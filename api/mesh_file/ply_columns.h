#pragma once

#include <cstdint>
#include <vector>

#include "api/mesh_file/ply_header.h"

/// Which attribute a property of a PLY file belongs to.
namespace ramcdb::mesh_file::ply {

/// What becomes of the numbers of one property.
struct Target {
  enum class Kind : std::uint8_t { skip, axis, id_half, value, indices, texcoord };
  Kind kind = Kind::skip;
  std::uint8_t axis = 0;       ///< of `axis`: 0..2; of `id_half`: bits to shift
  std::size_t attribute = 0;   ///< of `value` and `texcoord`: in MeshData::attributes
  std::size_t component = 0;   ///< of `value`
  std::size_t components = 1;  ///< of its attribute
};

/// A target per property of the element "vertex" or "face". Colours, normals and texture coordinates of one type become
/// one attribute each, every other number one of its own; lists, and what goes beyond kMostAttributes, are named as
/// dropped. Adds the attributes, without values yet.
[[nodiscard]] std::vector<Target> plan_columns(const Element& element, MeshData& mesh, DroppedCounter& dropped);

/// Attributes that a header may make up, so that neither time nor memory follow it.
inline constexpr std::size_t kMostAttributes = 256;

}  // namespace ramcdb::mesh_file::ply
