#include "api/mesh_file/ply_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ramcdb::mesh_file::ply {
namespace {

/// Properties that are one value together; the last may be missing where `least` says so.
struct Group {
  Meaning meaning;
  const char* name;
  std::size_t least;
  std::array<std::string_view, 4> fields;
};

constexpr Group kGroups[] = {
    {Meaning::color, "color", 3, {"red", "green", "blue", "alpha"}},
    {Meaning::color, "color", 3, {"r", "g", "b", "a"}},
    {Meaning::color, "color", 3, {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}},
    {Meaning::normal, "normal", 3, {"nx", "ny", "nz", ""}},
    {Meaning::texture, "texture", 2, {"u", "v", "", ""}},
    {Meaning::texture, "texture", 2, {"s", "t", "", ""}},
    {Meaning::texture, "texture", 2, {"texture_u", "texture_v", "", ""}},
};

class Planner {
 public:
  Planner(const Element& element, MeshData& mesh, DroppedCounter& dropped)
      : element_(element),
        of_(element.name == "vertex" ? AttributeOf::vertex : AttributeOf::face),
        ids_(element.has(Role::id_high) && element.has(Role::id_low)),
        mesh_(mesh),
        dropped_(dropped),
        targets_(element.properties.size()),
        planned_(element.properties.size()) {}

  std::vector<Target> run() {
    for (std::size_t p = 0; p < targets_.size(); ++p)
      if (!planned_[p]) plan(p);
    return std::move(targets_);
  }

 private:
  void plan(std::size_t p) {
    const Property& property = element_.properties[p];
    Target& target = targets_[p];
    if (property.role <= Role::z) {
      target.kind = Target::Kind::axis;
      target.axis = static_cast<std::uint8_t>(property.role);
    } else if (property.role <= Role::id_low && ids_) {
      target.kind = Target::Kind::id_half;
      target.axis = property.role == Role::id_high ? 32 : 0;
    } else if (property.role == Role::indices) {
      target.kind = Target::Kind::indices;
    } else if (property.role == Role::texcoord && room()) {
      target.kind = Target::Kind::texcoord;
      target.attribute = add({p, p}, AttributeOf::corner, Meaning::texture, "texture");
    } else if (property.count_type || !room()) {
      dropped_.add(fmt::format("{} property '{}' ({}{})", element_.name, shown(property.name),
                               property.count_type ? "list of " : "", property.type_name),
                   element_.count);
    } else {
      plan_value(p);
    }
  }

  [[nodiscard]] bool room() const { return mesh_.attributes.size() < kMostAttributes; }

  void plan_value(std::size_t p) {
    const std::string& name = element_.properties[p].name;
    for (const Group& group : kGroups) {
      if (std::find(group.fields.begin(), group.fields.end(), name) == group.fields.end()) continue;
      const auto members = members_of(group);
      if (std::find(members.begin(), members.end(), p) != members.end())
        return place(members, group.meaning, group.name);
    }
    place({p}, Meaning::other, name);
  }

  /// The properties of the group, or none when they are not all there, not of one type, or taken.
  [[nodiscard]] std::vector<std::size_t> members_of(const Group& group) const {
    std::vector<std::size_t> members;
    for (const std::string_view field : group.fields) {
      const std::size_t p = find(field);
      if (p == element_.properties.size()) break;
      if (!members.empty() && element_.properties[p].type != element_.properties[members.front()].type) break;
      members.push_back(p);
    }
    if (members.size() < group.least) members.clear();
    return members;
  }

  /// The first number of this name that is no part of another attribute.
  [[nodiscard]] std::size_t find(std::string_view name) const {
    for (std::size_t p = 0; p < planned_.size(); ++p) {
      const Property& property = element_.properties[p];
      if (property.name == name && !property.count_type && property.role == Role::none && !planned_[p]) return p;
    }
    return planned_.size();
  }

  void place(const std::vector<std::size_t>& members, Meaning meaning, std::string_view name) {
    const std::size_t attribute = add(members, of_, meaning, name);
    for (std::size_t c = 0; c < members.size(); ++c) {
      targets_[members[c]] = {Target::Kind::value, 0, attribute, c, members.size()};
      planned_[members[c]] = true;
    }
  }

  std::size_t add(const std::vector<std::size_t>& members, AttributeOf of, Meaning meaning, std::string_view name) {
    Attribute attribute;
    AttributeInfo& info = attribute.info;
    info.name = unique_name(mesh_.attributes, of, name);
    info.of = of;
    info.type = element_.properties[members.front()].type;
    info.components = static_cast<std::uint8_t>(members.size());
    info.meaning = meaning;
    for (const std::size_t p : members)
      if (of != AttributeOf::corner) info.fields.push_back(element_.properties[p].name);
    if (info.fields == customary_fields(info)) info.fields.clear();
    mesh_.attributes.push_back(std::move(attribute));
    return mesh_.attributes.size() - 1;
  }

  const Element& element_;
  AttributeOf of_;
  bool ids_;
  MeshData& mesh_;
  DroppedCounter& dropped_;
  std::vector<Target> targets_;
  std::vector<bool> planned_;
};

}  // namespace

std::vector<Target> plan_columns(const Element& element, MeshData& mesh, DroppedCounter& dropped) {
  return Planner(element, mesh, dropped).run();
}

}  // namespace ramcdb::mesh_file::ply
