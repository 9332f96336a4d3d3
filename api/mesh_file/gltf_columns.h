#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/mesh_file/gltf_scene.h"

/// Attributes of vertices: what glTF calls them, and what they are here. Reader and writer follow the same table:
///   NORMAL      normal             floats
///   TEXCOORD_n  texture, _n for n > 0   floats
///   COLOR_n     color, _n for n > 0     floats 0..1, or uint8, uint16
///   TANGENT, JOINTS_n, WEIGHTS_n   named so, meaning other
///   _NAME       NAME, meaning other; with the _ where NAME is one of these words
namespace ramcdb::mesh_file::gltf {

/// Our vertex ids: four uint16, the lowest first.
inline constexpr std::string_view kIdName = "_RAMCDB_ID";
inline constexpr std::size_t kIdWords = 4;

/// Before the name of an attribute: uint16, whose bit c says that component c is none. Without it, 0 would be a value.
inline constexpr std::string_view kMaskName = "_RAMCDB_NONE_";

/// Words that mean something to glTF or to a mesh that is read from it.
[[nodiscard]] bool is_reserved(std::string_view name);
/// The number of "TEXCOORD_2" or "texture_2" behind `base`; "texture" alone is 0 where `alone`. Nothing else is one.
[[nodiscard]] std::optional<std::size_t> number_behind(std::string_view name, std::string_view base, bool alone);

/// The values of one name, of all blocks.
struct Column {
  enum class Kind : std::uint8_t { plain, normal, tangent, id };
  std::string name;  ///< in the file
  Kind kind = Kind::plain;
  bool unit = false;  ///< normalized integers become floats
  bool mask = false;  ///< blocks may have one
  AttributeInfo info;
};

/// One per name, in the order normals, tangents, texture coordinates, colours, joints, weights, others. Where blocks
/// have other types, the column has the one that holds all.
[[nodiscard]] std::vector<Column> plan_columns(const Scene& scene, const Document& document);

/// Takes the memory, NaN, and reads the column of all blocks.
void read_column(const Column& column, const Scene& scene, const Document& document, Accessors& accessors,
                 MeshData& mesh);

}  // namespace ramcdb::mesh_file::gltf
