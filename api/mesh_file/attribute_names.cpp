#include "api/mesh_file/attribute_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace ramcdb::mesh_file {
namespace {

template <class T>
NumberRange whole_numbers(NumberType type) {
  return {static_cast<double>(std::numeric_limits<T>::min()), static_cast<double>(std::numeric_limits<T>::max()), type};
}

}  // namespace

NumberRange range_of(NumberType type) {
  switch (type) {
    case NumberType::int8:
      return whole_numbers<std::int8_t>(type);
    case NumberType::uint8:
      return whole_numbers<std::uint8_t>(type);
    case NumberType::int16:
      return whole_numbers<std::int16_t>(type);
    case NumberType::uint16:
      return whole_numbers<std::uint16_t>(type);
    case NumberType::int32:
      return whole_numbers<std::int32_t>(type);
    case NumberType::uint32:
      return whole_numbers<std::uint32_t>(type);
    case NumberType::float32:
    case NumberType::float64:
      break;
  }
  return {0, 0, type};
}

std::vector<std::string> customary_fields(const AttributeInfo& info) {
  const auto first = [&](std::vector<std::string> names) {
    names.resize(info.components);
    return names;
  };
  if (info.meaning == Meaning::color && (info.components == 3 || info.components == 4))
    return first({"red", "green", "blue", "alpha"});
  if (info.meaning == Meaning::normal && info.components == 3) return {"nx", "ny", "nz"};
  if (info.meaning == Meaning::texture && info.components == 2) return {"s", "t"};
  if (info.components == 1) return {info.name};
  std::vector<std::string> fields;
  for (int c = 0; c < info.components; ++c) fields.push_back(fmt::format("{}_{}", info.name, c));
  return fields;
}

std::string unique_name(const std::vector<Attribute>& attributes, AttributeOf of, std::string_view name) {
  const auto taken = [&](std::string_view wanted) {
    return std::any_of(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.info.name == wanted; });
  };
  std::string unique(name);
  if (taken(unique) && of != AttributeOf::vertex)
    unique = fmt::format("{}.{}", of == AttributeOf::face ? "face" : "corner", name);
  const std::string numbered = unique;
  for (int i = 2; taken(unique); ++i) unique = fmt::format("{}_{}", numbered, i);
  return unique;
}

}  // namespace ramcdb::mesh_file
