#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/mesh_file/gltf_columns.h"
#include "api/mesh_file/gltf_plan.h"

namespace ramcdb::mesh_file::gltf {
namespace {

bool all_floats(const AttributeView& attribute) {
  const NumberRange range = range_of(NumberType::float32);
  return std::all_of(attribute.values.begin(), attribute.values.end(),
                     [&](double value) { return range.holds(value); });
}

bool too_large(const AttributeView& attribute) {
  return std::any_of(attribute.values.begin(), attribute.values.end(),
                     [](double value) { return std::isfinite(value) && std::abs(value) > NumberRange::kMostFloat; });
}

bool is_small(NumberType type) { return !is_float(type) && size_of(type) <= 2; }

/// The type that an attribute has in the file, unless glTF wants another; nothing: there is none that holds it.
std::optional<NumberType> plain_type(const AttributeView& attribute) {
  const NumberType type = attribute.info.type;
  if (is_small(type)) return type;
  if (is_float(type)) return too_large(attribute) ? std::nullopt : std::optional(NumberType::float32);
  return all_floats(attribute) ? std::optional(NumberType::float32) : std::nullopt;
}

bool is_unsigned_small(NumberType type) { return type == NumberType::uint8 || type == NumberType::uint16; }

/// The inverse of the reader's name.
std::string custom_name(const std::string& name) {
  const bool is_marked = name.size() > 1 && name[0] == '_' && is_reserved(std::string_view(name).substr(1));
  return is_marked ? name : "_" + name;
}

}  // namespace

Columns::Columns(const MeshOutput& mesh, DroppedCounter& dropped) : dropped_(dropped) {
  for (const AttributeView& attribute : mesh.attributes)
    if (attribute.info.of == AttributeOf::face)
      place_of_face(attribute);
    else
      place(attribute);
  number("TEXCOORD_", "texture", textures_);
  number("COLOR_", "color", colors_);
  if (!mesh.vertex_ids.empty()) {
    OutColumn ids;
    ids.name = kIdName;
    ids.type = NumberType::uint16;
    ids.components = kIdWords;
    std::erase_if(all_, [](const OutColumn& column) { return column.name == kIdName; });
    all_.push_back(ids);
  }
}

void Columns::place_of_face(const AttributeView& attribute) {
  const AttributeInfo& info = attribute.info;
  const bool named = info.components == 1 && !info.names.empty();
  if (named && info.meaning == Meaning::material && !materials_)
    materials_ = &attribute;
  else if (named && info.meaning == Meaning::group && info.name == "object" && !objects_)
    objects_ = &attribute;
  else
    drop_attribute(dropped_, attribute);
}

void Columns::place(const AttributeView& attribute) {
  const AttributeInfo& info = attribute.info;
  if (!info.names.empty()) drop_names(dropped_, attribute);
  const bool holds = !too_large(attribute);
  const std::size_t n = info.components;
  if (info.meaning == Meaning::normal && n == 3 && holds && !normal_) {
    normal_ = &attribute;
    add(attribute, "NORMAL", NumberType::float32, 3);
  } else if (info.meaning == Meaning::texture && (n == 2 || n == 3) && holds) {
    textures_.push_back(&attribute);
  } else if (info.meaning == Meaning::color && (n == 3 || n == 4) && holds) {
    colors_.push_back(&attribute);
  } else if (!place_custom(attribute)) {
    drop_attribute(dropped_, attribute);
  }
}

bool Columns::place_custom(const AttributeView& attribute) {
  const AttributeInfo& info = attribute.info;
  const auto type = plain_type(attribute);
  const bool matrix = info.components == 9 || info.components == 16;
  if (!type || (info.components > 4 && !matrix) || (matrix && *type != NumberType::float32)) return false;
  const bool four = info.components == 4;
  if (info.name == "TANGENT" && four && *type == NumberType::float32) return add(attribute, info.name, *type, 4);
  if (number_behind(info.name, "JOINTS_", false) && four && is_unsigned_small(*type))
    return add(attribute, info.name, *type, 4);
  if (number_behind(info.name, "WEIGHTS_", false) && four && (is_unsigned_small(*type) || is_float(*type))) {
    add(attribute, info.name, *type, 4);
    all_.back().normalized = !is_float(*type);
    return true;
  }
  return add(attribute, custom_name(info.name), *type, info.components);
}

bool Columns::add(const AttributeView& attribute, std::string name, NumberType type, std::size_t components) {
  const std::string wanted = name;
  const auto taken = [&] {
    return std::any_of(all_.begin(), all_.end(), [&](const OutColumn& column) { return column.name == name; });
  };
  for (int i = 2; taken(); ++i) name = fmt::format("{}_{}", wanted, i);
  OutColumn column;
  column.name = std::move(name);
  column.attribute = &attribute;
  column.type = type;
  column.components = components;
  all_.push_back(std::move(column));
  return true;
}

void Columns::number(std::string_view word, std::string_view base, std::vector<const AttributeView*>& attributes) {
  // "texture_2" stands behind "texture_1"; those of other names behind all.
  std::stable_sort(attributes.begin(), attributes.end(), [&](const AttributeView* a, const AttributeView* b) {
    constexpr auto kLast = static_cast<std::size_t>(-1);
    return number_behind(a->info.name, base, true).value_or(kLast) <
           number_behind(b->info.name, base, true).value_or(kLast);
  });
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    const AttributeView& attribute = *attributes[i];
    const AttributeInfo& info = attribute.info;
    const bool color = info.meaning == Meaning::color;
    const bool integer = color && is_unsigned_small(info.type);
    add(attribute, fmt::format("{}{}", word, i), integer ? info.type : NumberType::float32,
        color ? info.components : 2);
    all_.back().normalized = integer;
    all_.back().unit = color && !integer && !is_float(info.type);
    if (!color && info.components == 3)
      dropped_.add(fmt::format("third number of attribute '{}'", shown(info.name)), attribute.count());
  }
}

std::vector<const AttributeView*> Columns::of_corners() const {
  std::vector<const AttributeView*> attributes;
  for (const OutColumn& column : all_)
    if (column.attribute && column.attribute->info.of == AttributeOf::corner) attributes.push_back(column.attribute);
  return attributes;
}

void Columns::add_masks(const Vertices& vertices) {
  for (std::size_t k = 0, columns = all_.size(); k < columns; ++k) {
    if (!all_[k].attribute) continue;
    OutColumn mask = all_[k];
    mask.name = fmt::format("{}{}", kMaskName, mask.name);
    mask.type = NumberType::uint16;
    mask.bits = std::exchange(mask.components, 1);
    mask.mask = true;
    mask.normalized = false;
    if (!has_none(mask, vertices, 0, vertices.count)) all_.push_back(std::move(mask));
  }
}

bool has_none(const OutColumn& column, const Vertices& vertices, std::size_t first, std::size_t count) {
  if (!column.attribute) return false;
  for (std::size_t i = first; i < first + count; ++i)
    for (std::size_t c = 0; c < column.components; ++c)
      if (!std::isnan(number_at(column, vertices, i, c))) return false;
  return true;
}

void count_changes(const OutColumn& column, const Vertices& vertices, std::size_t first, std::size_t count,
                   DroppedCounter& dropped) {
  if (!column.attribute || column.mask) return;
  std::uint64_t absent = 0, infinite = 0, rounded = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    bool is_absent = false, is_infinite = false, is_rounded = false;
    for (std::size_t c = 0; c < column.components; ++c) {
      const double value = number_at(column, vertices, i, c);
      is_absent |= std::isnan(value);
      is_infinite |= std::isinf(value);
      is_rounded |=
          is_float(column.type) && std::isfinite(value) && static_cast<double>(static_cast<float>(value)) != value;
    }
    // A vertex without faces never had what corners have.
    const bool of_nothing = column.attribute->info.of == AttributeOf::corner && vertices.corner[i] == kNoCorner;
    absent += is_absent && !of_nothing;
    infinite += is_infinite;
    rounded += is_rounded;
  }
  const std::string name = fmt::format("attribute '{}'", shown(column.attribute->info.name));
  dropped.add(fmt::format("vertices without {} (0 to other programs)", name), absent);
  dropped.add(fmt::format("values of {} that are not finite (written as 0)", name), infinite);
  dropped.add(fmt::format("values of {} that are no 32-bit floats (rounded)", name), rounded);
}

}  // namespace ramcdb::mesh_file::gltf
