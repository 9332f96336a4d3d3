#include "api/mesh_file/gltf_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <tuple>

#include "api/mesh_file/attribute_names.h"

namespace ramcdb::mesh_file::gltf {
namespace {

/// What a name stands for in the file.
struct Word {
  int order = 6;
  std::size_t number = 0;
  Meaning meaning = Meaning::other;
};

Word word_of(std::string_view name) {
  if (name == "NORMAL") return {0, 0, Meaning::normal};
  if (name == "TANGENT") return {1, 0, Meaning::other};
  constexpr std::tuple<std::string_view, int, Meaning> kNumbered[] = {{"TEXCOORD_", 2, Meaning::texture},
                                                                      {"COLOR_", 3, Meaning::color},
                                                                      {"JOINTS_", 4, Meaning::other},
                                                                      {"WEIGHTS_", 5, Meaning::other}};
  for (const auto& [base, order, meaning] : kNumbered)
    if (const auto number = number_behind(name, base, false)) return {order, *number, meaning};
  return {};
}

bool fits(Meaning meaning, std::size_t components) {
  switch (meaning) {
    case Meaning::color:
      return components == 3 || components == 4;
    case Meaning::normal:
      return components == 3;
    case Meaning::texture:
      return components == 2;
    default:
      return true;
  }
}

std::string house_name(std::string_view name, const Word& word) {
  if (word.order == 0) return "normal";
  if (word.order == 2 || word.order == 3) {
    const std::string_view base = word.order == 2 ? "texture" : "color";
    return word.number ? fmt::format("{}_{}", base, word.number) : std::string(base);
  }
  if (word.order == 6 && name.size() > 1 && name[0] == '_' && !is_reserved(name.substr(1))) name.remove_prefix(1);
  return std::string(name);
}

/// What the accessors of one name have together.
class Merge {
 public:
  void add(const Accessor& accessor) {
    components_ = std::max(components_, accessor.components);
    one_type_ &= !any_ || (type_ == *accessor.type && normalized_ == accessor.normalized);
    any_large_ |= accessor.type == NumberType::uint32;
    type_ = *accessor.type;
    normalized_ = accessor.normalized;
    any_ = true;
  }

  [[nodiscard]] std::size_t components() const { return components_; }
  [[nodiscard]] bool is_mask() const { return one_type_ && type_ == NumberType::uint16 && components_ == 1; }
  [[nodiscard]] bool is_ids() const { return one_type_ && type_ == NumberType::uint16 && components_ == kIdWords; }
  /// Integers stay integers where all are of one type, and nothing forgets that they are normalized.
  [[nodiscard]] bool keeps_type(const Word& word) const {
    return one_type_ && (is_float(type_) || !normalized_ || word.meaning == Meaning::color || word.order == 5);
  }
  [[nodiscard]] NumberType type(const Word& word) const {
    return keeps_type(word) ? type_ : any_large_ ? NumberType::float64 : NumberType::float32;
  }

 private:
  std::size_t components_ = 0;
  NumberType type_ = NumberType::float32;
  bool normalized_ = false, one_type_ = true, any_large_ = false, any_ = false;
};

Column column_of(const std::string& name, const Merge& merge) {
  Column column;
  column.name = name;
  Word word = word_of(name);
  if (name == kIdName && merge.is_ids()) column.kind = Column::Kind::id;
  if (!fits(word.meaning, merge.components())) word = {};
  if (word.order == 0) column.kind = Column::Kind::normal;
  if (word.order == 1 && merge.components() == 4) column.kind = Column::Kind::tangent;
  column.info.name = house_name(name, word);
  column.info.meaning = word.meaning;
  column.info.type = merge.type(word);
  column.info.components = static_cast<std::uint8_t>(merge.components());
  // Directions are turned as numbers that mean lengths.
  if (column.kind == Column::Kind::normal || column.kind == Column::Kind::tangent)
    column.info.type = NumberType::float32;
  column.unit = is_float(column.info.type);
  return column;
}

/// Colours without alpha are opaque; what else a block has fewer components of is none.
void widen(const double* from, std::size_t has, const AttributeInfo& info, std::size_t count, double* to) {
  const double rest = info.meaning != Meaning::color ? kNone : is_float(info.type) ? 1 : range_of(info.type).most;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < info.components; ++c) to[i * info.components + c] = c < has ? from[i * has + c] : rest;
}

double to_float(double value) { return static_cast<double>(static_cast<float>(value)); }

void turn(const Column& column, const Transform& transform, std::size_t count, double* values) {
  const std::size_t n = column.info.components;
  for (double* at = values; at != values + count * n; at += n) {
    const Point d{at[0], at[1], at[2]};
    const Point turned = column.kind == Column::Kind::normal ? transform.normal(d) : unit(transform.direction(d));
    for (int a = 0; a < 3; ++a) at[a] = to_float(turned[a]);
    if (column.kind == Column::Kind::tangent && transform.mirrors()) at[3] = -at[3];
  }
}

void read_block(const Column& column, const Block& block, Index accessor, const Document& document,
                const Transform& transform, Accessors& accessors, double* to) {
  const std::size_t n = column.info.components, has = document.accessors[accessor].components;
  if (has == n) {
    accessors.read(accessor, column.unit, to);
  } else {
    std::vector<double> values(block.count * has);
    accessors.read(accessor, column.unit, values.data());
    widen(values.data(), has, column.info, block.count, to);
  }
  if (column.info.type == NumberType::float32 && document.accessors[accessor].type != NumberType::float32)
    std::transform(to, to + block.count * n, to, to_float);
  const bool directs = column.kind == Column::Kind::normal || column.kind == Column::Kind::tangent;
  if (directs && !transform.keeps_directions()) turn(column, transform, block.count, to);
}

void apply_mask(Index accessor, const Block& block, std::size_t components, Accessors& accessors, double* to) {
  std::vector<double> masks(block.count);
  accessors.read(accessor, false, masks.data());
  for (std::size_t i = 0; i < block.count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      if (static_cast<unsigned>(masks[i]) >> c & 1U) to[i * components + c] = kNone;
}

void add_ids(const std::vector<double>& words, MeshData& mesh) {
  mesh.vertex_ids.resize(words.size() / kIdWords);
  for (std::size_t v = 0; v < mesh.vertex_ids.size(); ++v)
    for (std::size_t w = 0; w < kIdWords; ++w)
      mesh.vertex_ids[v] |= static_cast<std::uint64_t>(words[v * kIdWords + w]) << (16 * w);
}

}  // namespace

bool is_reserved(std::string_view name) {
  constexpr std::string_view kWords[] = {"POSITION", "normal", "material", "object"};
  if (std::find(std::begin(kWords), std::end(kWords), name) != std::end(kWords)) return true;
  return word_of(name).order != 6 || number_behind(name, "texture", true) || number_behind(name, "color", true);
}

std::optional<std::size_t> number_behind(std::string_view name, std::string_view base, bool alone) {
  if (!name.starts_with(base)) return std::nullopt;
  name.remove_prefix(base.size());
  if (alone) {
    if (name.empty()) return 0;
    if (name[0] != '_') return std::nullopt;
    name.remove_prefix(1);
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool plain = error == std::errc() && end == name.data() + name.size() && name == fmt::format("{}", number);
  if (!plain || (alone && number == 0)) return std::nullopt;
  return number;
}

std::vector<Column> plan_columns(const Scene& scene, const Document& document) {
  std::map<std::string, Merge> merges;
  std::map<std::string, std::size_t> vertices;
  for (const Block& block : scene.blocks)
    for (const auto& [name, accessor] : block.attributes) {
      merges[name].add(document.accessors[accessor]);
      vertices[name] += block.count;
    }
  std::vector<Column> columns;
  const auto mask_of = [&](const std::string& name) { return merges.find(std::string(kMaskName) + name); };
  for (const auto& [name, merge] : merges) {
    if (name.starts_with(kMaskName) && merge.is_mask() && merges.contains(name.substr(kMaskName.size()))) continue;
    columns.push_back(column_of(name, merge));
    columns.back().mask = mask_of(name) != merges.end() && mask_of(name)->second.is_mask();
    // Ids that some vertices lack say nothing of the others.
    if (columns.back().kind == Column::Kind::id && vertices[name] != scene.vertices)
      columns.back().kind = Column::Kind::plain;
  }
  const auto place = [](const Column& column) {
    const Word word = word_of(column.name);
    return std::tuple(word.order, word.number);
  };
  std::stable_sort(columns.begin(), columns.end(),
                   [&](const Column& a, const Column& b) { return place(a) < place(b); });
  return columns;
}

void read_column(const Column& column, const Scene& scene, const Document& document, Accessors& accessors,
                 MeshData& mesh) {
  const std::size_t n = column.info.components;
  std::vector<double> values(scene.vertices * n, kNone);
  for (const Block& block : scene.blocks)
    if (const auto it = block.attributes.find(column.name); it != block.attributes.end()) {
      double* to = values.data() + block.first * n;
      read_block(column, block, it->second, document, scene.transforms[block.transform], accessors, to);
      if (!column.mask) continue;
      const auto mask = block.attributes.find(std::string(kMaskName) + column.name);
      if (mask != block.attributes.end()) apply_mask(mask->second, block, n, accessors, to);
    }
  if (column.kind == Column::Kind::id) return add_ids(values, mesh);
  Attribute attribute{column.info, std::move(values)};
  attribute.info.name = unique_name(mesh.attributes, AttributeOf::vertex, column.info.name);
  mesh.attributes.push_back(std::move(attribute));
}

}  // namespace ramcdb::mesh_file::gltf
