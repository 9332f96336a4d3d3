#include "api/file_attributes.h"

#include <algorithm>
#include <cmath>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNoPlace = ~std::uint32_t{0};

bool can_give(const AttributeInfo& from, const AttributeInfo& to) {
  const bool place = from.of == to.of || (from.of == AttributeOf::vertex && to.of == AttributeOf::corner);
  return place && from.components >= std::min<std::uint8_t>(to.components, 3) && from.meaning == to.meaning;
}

/// Programs name attributes as they like: by name first, then by meaning.
const Attribute* find_in(const mesh_file::MeshData& file, const AttributeInfo& wanted) {
  for (const Attribute& attribute : file.attributes)
    if (attribute.info.name == wanted.name && can_give(attribute.info, wanted)) return &attribute;
  if (wanted.meaning == Meaning::other || wanted.meaning == Meaning::group) return nullptr;
  const Attribute* found = nullptr;
  for (const Attribute& attribute : file.attributes)
    if (attribute.info.meaning == wanted.meaning && can_give(attribute.info, wanted)) {
      if (found) return nullptr;
      found = &attribute;
    }
  return found;
}

/// The largest number of a colour type.
double full_level(NumberType type) {
  switch (type) {
    case NumberType::uint8:
      return 255;
    case NumberType::uint16:
      return 65535;
    default:
      return 1;
  }
}

class Converter {
 public:
  Converter(const AttributeInfo& from, AttributeInfo& to) : from_(from), to_(to) {
    if (to.meaning == Meaning::color) scale_ = full_level(to.type) / full_level(from.type);
    for (const std::string& name : from.names) value_of_name_.push_back(value_of(name));
  }

  [[nodiscard]] double operator()(double number) const {
    if (!value_of_name_.empty() && number >= 0 && number < static_cast<double>(value_of_name_.size()))
      return value_of_name_[static_cast<std::size_t>(number)];
    if (scale_ != 1) number *= scale_;
    return is_float(to_.type) || std::isnan(number) ? number : std::floor(number + 0.5);
  }

 private:
  /// The number of a name in the region's list. (A name that the mesh does not have cannot be given to a face.)
  double value_of(const std::string& name) const {
    const auto it = std::find(to_.names.begin(), to_.names.end(), name);
    if (it == to_.names.end())
      throw Error(Errc::invalid_argument, "the mesh has no " + to_.name + " '" + name + "'", {},
                  "use the names that it was imported with");
    return static_cast<double>(it - to_.names.begin());
  }

  const AttributeInfo& from_;
  AttributeInfo& to_;
  double scale_ = 1;
  std::vector<double> value_of_name_;
};

}  // namespace

std::uint64_t take_values(const mesh_file::MeshData& file, const FilePlaces& places, RegionMesh& mesh) {
  std::uint64_t missing = 0;
  const auto place_of = [&](AttributeOf of, AttributeOf given, std::size_t at) {
    if (of == AttributeOf::vertex) return places.vertices[at];
    if (of == AttributeOf::face) return places.faces[at];
    const std::uint32_t corner = places.corners[at];
    return given == AttributeOf::vertex && corner != kNoPlace ? file.corners[corner] : corner;
  };
  for (Attribute& attribute : mesh.attributes) {
    const Attribute* given = find_in(file, attribute.info);
    missing += given == nullptr;
    if (!given) continue;
    const Converter convert(given->info, attribute.info);
    const std::size_t components = attribute.info.components, theirs = given->info.components;
    for (std::size_t at = 0; at < attribute.count(); ++at) {
      const std::uint32_t place = place_of(attribute.info.of, given->info.of, at);
      if (place == kNoPlace) continue;
      for (std::size_t k = 0; k < std::min(components, theirs); ++k)
        attribute.values[at * components + k] = convert(given->values[place * theirs + k]);
    }
  }
  return missing;
}

std::vector<const Attribute*> attributes_without_place(const mesh_file::MeshData& file, const RegionMesh& mesh) {
  std::vector<const Attribute*> unused;
  for (const Attribute& attribute : file.attributes)
    if (std::ranges::none_of(mesh.attributes, [&](const Attribute& a) { return find_in(file, a.info) == &attribute; }))
      unused.push_back(&attribute);
  return unused;
}

}  // namespace ramcdb::detail
