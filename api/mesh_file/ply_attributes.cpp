#include "api/mesh_file/ply_attributes.h"

#include <fmt/format.h>

#include <span>

namespace ramcdb::mesh_file::ply {
namespace {

struct Group {
  std::vector<std::string_view> fields;
  const char* name;
  Meaning meaning;
};

/// Longest first, so that alpha is not left out.
const std::vector<Group>& groups() {
  static const std::vector<Group> kGroups{
      {{"red", "green", "blue", "alpha"}, "color", Meaning::color},
      {{"red", "green", "blue"}, "color", Meaning::color},
      {{"r", "g", "b", "a"}, "color", Meaning::color},
      {{"r", "g", "b"}, "color", Meaning::color},
      {{"diffuse_red", "diffuse_green", "diffuse_blue"}, "color", Meaning::color},
      {{"nx", "ny", "nz"}, "normal", Meaning::normal},
      {{"texture_u", "texture_v"}, "texture", Meaning::texture},
      {{"u", "v"}, "texture", Meaning::texture},
      {{"s", "t"}, "texture", Meaning::texture},
  };
  return kGroups;
}

NumberType number_type(Type type) { return static_cast<NumberType>(static_cast<int>(type) + 1); }

class Planner {
 public:
  Planner(const Element& element, std::vector<Attribute>& attributes)
      : element_(element), attributes_(attributes), columns_(element.properties.size()) {}

  std::vector<Column> run() {
    for (const Group& group : groups()) add_group(group);
    for (std::size_t p = 0; p < columns_.size(); ++p)
      if (is_free(p)) add({p}, element_.properties[p].name, Meaning::other);
    for (std::size_t p = 0; p < columns_.size(); ++p) add_texture_list(p);
    return std::move(columns_);
  }

 private:
  [[nodiscard]] bool is_free(std::size_t p) const {
    const Property& property = element_.properties[p];
    return property.role == Role::none && !property.count_type && columns_[p].attribute == Column::kNone;
  }

  void add_group(const Group& group) {
    std::vector<std::size_t> members;
    for (const std::string_view field : group.fields)
      for (std::size_t p = 0; p < columns_.size(); ++p)
        if (is_free(p) && element_.properties[p].name == field && members.size() < group.fields.size() &&
            (members.empty() || element_.properties[p].type == element_.properties[members[0]].type)) {
          members.push_back(p);
          break;
        }
    if (members.size() == group.fields.size()) add(members, group.name, group.meaning);
  }

  void add(const std::vector<std::size_t>& members, const std::string& name, Meaning meaning) {
    Attribute attribute;
    attribute.info.name = free_name(name);
    attribute.info.of = element_.name == "vertex" ? AttributeOf::vertex : AttributeOf::face;
    attribute.info.type = number_type(element_.properties[members[0]].type);
    attribute.info.components = static_cast<std::uint8_t>(members.size());
    attribute.info.meaning = meaning;
    attribute.values.resize(element_.count * members.size());
    for (std::size_t k = 0; k < members.size(); ++k) {
      attribute.info.fields.push_back(element_.properties[members[k]].name);
      columns_[members[k]] = {attributes_.size(), k, false};
    }
    attributes_.push_back(std::move(attribute));
  }

  /// MeshLab's wedge coordinates.
  void add_texture_list(std::size_t p) {
    const Property& property = element_.properties[p];
    const bool floats = property.type == Type::float32 || property.type == Type::float64;
    if (element_.name != "face" || !property.count_type || property.role != Role::none || !floats ||
        property.name != "texcoord")
      return;
    Attribute attribute;
    attribute.info.name = free_name("texture");
    attribute.info.of = AttributeOf::corner;
    attribute.info.type = number_type(property.type);
    attribute.info.components = 2;
    attribute.info.meaning = Meaning::texture;
    columns_[p] = {attributes_.size(), 0, true};
    attributes_.push_back(std::move(attribute));
  }

  [[nodiscard]] bool is_taken(std::string_view name) const {
    for (const Attribute& attribute : attributes_)
      if (attribute.info.name == name) return true;
    return false;
  }

  [[nodiscard]] std::string free_name(const std::string& name) const {
    if (!is_taken(name)) return name;
    std::string longer = element_.name + "." + name;
    for (int n = 2; is_taken(longer); ++n) longer = fmt::format("{}.{}_{}", element_.name, name, n);
    return longer;
  }

  const Element& element_;
  std::vector<Attribute>& attributes_;
  std::vector<Column> columns_;
};

}  // namespace

std::vector<Column> plan_attributes(const Element& element, std::vector<Attribute>& attributes) {
  return Planner(element, attributes).run();
}

}  // namespace ramcdb::mesh_file::ply
