#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/file_bytes.h"

/// What a PLY file says about itself, before its values.
namespace ramcdb::mesh_file::ply {

using Type = NumberType;

/// What becomes of a property.
enum class Role { x, y, z, id_high, id_low, indices, texcoord, none };

struct Property {
  std::string name, type_name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< of a list
  Role role = Role::none;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// Fewest bytes that one of it takes.
  [[nodiscard]] std::size_t least_bytes(bool ascii) const;
  [[nodiscard]] bool has(Role role) const {
    return std::any_of(properties.begin(), properties.end(), [&](const Property& p) { return p.role == role; });
  }
};

enum class Encoding { ascii, little, big };

struct Header {
  std::optional<Encoding> encoding;
  std::vector<Element> elements;
  std::vector<std::string> references;  ///< "texture skin.png", from comments
  std::size_t size = 0, lines = 0;

  [[nodiscard]] const Element* find(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
  }
};

/// Reads the header. Throws with the line for what it does not know, and for more elements than the file has room for.
[[nodiscard]] Header read_header(const FileBytes& file);

}  // namespace ramcdb::mesh_file::ply
