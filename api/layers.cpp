#include "api/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "codec/float_order.h"
#include "codec/octahedron.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using nlohmann::json;

constexpr int kTableFormat = 1;
constexpr unsigned kGridBits = 48;
constexpr std::uint64_t kDirectionMask = (std::uint64_t{1} << codec::kDirectionBits) - 1;

unsigned bits_of(NumberType type) {
  switch (type) {
    case NumberType::int8:
    case NumberType::uint8:
      return 8;
    case NumberType::int16:
    case NumberType::uint16:
      return 16;
    case NumberType::int32:
    case NumberType::uint32:
    case NumberType::float32:
      return 32;
    case NumberType::float64:
      return 64;
  }
  return 64;
}

bool is_signed(NumberType type) {
  return type == NumberType::int8 || type == NumberType::int16 || type == NumberType::int32;
}

/// How finely numbers are kept that programs compute with; 0: all of them.
double step_for(Meaning meaning) {
  switch (meaning) {
    case Meaning::normal:
    case Meaning::color:
      return 1.0 / (1 << 12);
    case Meaning::texture:
      return 1.0 / (1 << 16);
    default:
      return 0;
  }
}

/// Of the points of the octahedron around a direction the nearest one, at most sqrt(2) / unit away from it.
codec::OctahedronPoint nearest_point(std::span<const double> d) {
  constexpr double kUnit = codec::kOctahedronUnit;
  const double sum = std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]);
  if (sum == 0) return codec::OctahedronPoint::none();
  const auto u = static_cast<std::int32_t>(std::floor(d[0] / sum * kUnit));
  const auto v = static_cast<std::int32_t>(std::floor(d[1] / sum * kUnit));
  codec::OctahedronVector nearest;
  double most = -2;
  for (const std::int32_t x : {u, u + 1})
    for (const std::int32_t y : {v, v + 1}) {
      const std::int32_t z = codec::kOctahedronUnit - std::abs(x) - std::abs(y);
      if (z < 0) continue;
      const codec::OctahedronVector to{x, y, d[2] < 0 ? -z : z};
      const auto tx = static_cast<double>(to.x), ty = static_cast<double>(to.y), tz = static_cast<double>(to.z);
      const double along = (d[0] * tx + d[1] * ty + d[2] * tz) / std::sqrt(tx * tx + ty * ty + tz * tz);
      if (along > most) most = along, nearest = to;
    }
  return codec::octahedron_point(nearest);
}

std::array<double, 3> direction_at(codec::OctahedronPoint p) {
  const codec::OctahedronVector at = codec::octahedron_vector(p);
  const auto x = static_cast<double>(at.x), y = static_cast<double>(at.y), z = static_cast<double>(at.z);
  const double length = std::sqrt(x * x + y * y + z * z);
  if (length == 0) return {0, 0, 0};
  return {x / length, y / length, z / length};
}

/// How far a number of a direction comes back from itself at most.
constexpr double kDirectionError = 2.0 / codec::kOctahedronUnit;

bool is_direction(std::span<const double> value) {
  for (const double number : value)
    if (!(std::abs(number) <= 2)) return false;
  const std::array<double, 3> back = direction_at(nearest_point(value));
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(back[k] - value[k]) > kDirectionError) return false;
  return true;
}

bool on_grid(double number, double step) {
  return std::abs(number / step) < static_cast<double>(std::uint64_t{1} << (kGridBits - 2));
}

bool is_absent(std::span<const double> value) {
  return std::all_of(value.begin(), value.end(), [](double number) { return std::isnan(number); });
}

/// Whether `fits` holds for each value that is there.
template <class Fits>
bool all_values(const mesh_file::AttributeView& attribute, const Fits& fits) {
  const std::size_t components = attribute.info.components;
  for (std::size_t i = 0; i + components <= attribute.values.size(); i += components) {
    const auto value = attribute.values.subspan(i, components);
    if (!is_absent(value) && !fits(value)) return false;
  }
  return true;
}

[[noreturn]] void refuse(const Layer& layer, double number) {
  throw Error(Errc::invalid_argument, fmt::format("attribute '{}' cannot hold {}", layer.info.name, number), {},
              "keep its numbers within the type that it has");
}

[[noreturn]] void refuse_direction(const Layer& layer, std::span<const double> value) {
  throw Error(Errc::invalid_argument,
              fmt::format("attribute '{}' cannot hold ({}, {}, {})", layer.info.name, value[0], value[1], value[2]), {},
              "it keeps directions: scale them to length 1, or import with --lossless-attributes to keep lengths");
}

std::uint64_t to_number(const Layer& layer, double number) {
  switch (layer.coding) {
    case LayerCoding::float_bits:
      return codec::float_order(number, layer.info.type);
    case LayerCoding::grid: {
      if (!on_grid(number, layer.step)) refuse(layer, number);
      const auto whole = static_cast<std::int64_t>(std::floor(number / layer.step + 0.5));
      return static_cast<std::uint64_t>(whole) & ((std::uint64_t{1} << kGridBits) - 1);
    }
    default: {
      const unsigned bits = bits_of(layer.info.type);
      const double most = std::ldexp(1.0, static_cast<int>(bits - is_signed(layer.info.type)));
      if (!(number >= (is_signed(layer.info.type) ? -most : 0) && number < most) || number != std::floor(number))
        refuse(layer, number);
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(number)) & ((std::uint64_t{1} << bits) - 1);
    }
  }
}

double from_number(const Layer& layer, std::uint64_t number) {
  const auto extended = [&](unsigned bits) {
    return static_cast<double>(static_cast<std::int64_t>(number << (64 - bits)) >> (64 - bits));
  };
  switch (layer.coding) {
    case LayerCoding::float_bits:
      return codec::from_float_order(number, layer.info.type);
    case LayerCoding::grid:
      return extended(kGridBits) * layer.step;
    default:
      return is_signed(layer.info.type) ? extended(bits_of(layer.info.type)) : static_cast<double>(number);
  }
}

json layer_json(const Layer& layer) {
  return {{"i", layer.id},
          {"n", layer.info.name},
          {"o", static_cast<int>(layer.info.of)},
          {"t", static_cast<int>(layer.info.type)},
          {"k", layer.info.components},
          {"m", static_cast<int>(layer.info.meaning)},
          {"f", layer.info.fields},
          {"v", layer.info.names},
          {"c", static_cast<int>(layer.coding)},
          {"s", layer.step}};
}

/// A stored number of an enumeration with values 1..last.
template <class Enum>
Enum enum_from(const json& j, Enum last) {
  const int value = j.get<int>();
  if (value < 1 || value > static_cast<int>(last)) throw Error(Errc::corrupt, "unknown kind of layer");
  return static_cast<Enum>(value);
}

Layer layer_from(const json& j) {
  Layer layer;
  layer.id = j.at("i").get<std::uint16_t>();
  layer.info.name = j.at("n").get<std::string>();
  layer.info.of = enum_from(j.at("o"), AttributeOf::face);
  layer.info.type = enum_from(j.at("t"), NumberType::float64);
  layer.info.components = j.at("k").get<std::uint8_t>();
  layer.info.meaning = enum_from(j.at("m"), Meaning::group);
  layer.info.fields = j.at("f").get<std::vector<std::string>>();
  layer.info.names = j.at("v").get<std::vector<std::string>>();
  layer.coding = enum_from(j.at("c"), LayerCoding::direction);
  layer.step = j.at("s").get<double>();
  const bool bad_grid = layer.coding == LayerCoding::grid && !(layer.step > 0 && std::isfinite(layer.step));
  const bool bad_direction = layer.coding == LayerCoding::direction && layer.info.components != 3;
  if (layer.info.components < 1 || layer.info.components > 16 || bad_grid || bad_direction || layer.id == 0)
    throw Error(Errc::corrupt, "a layer that cannot be");
  return layer;
}

}  // namespace

codec::LayerShape Layer::shape() const {
  using codec::ValueKind;
  if (coding == LayerCoding::direction) return {info.of, 2, codec::kDirectionBits, ValueKind::direction};
  const bool is_color = info.meaning == Meaning::color && info.components >= 3;
  const unsigned bits = coding == LayerCoding::grid ? kGridBits : bits_of(info.type);
  return {info.of, info.components, static_cast<std::uint8_t>(bits), is_color ? ValueKind::color : ValueKind::numbers};
}

double Layer::max_error() const {
  return coding == LayerCoding::grid ? step / 2 : coding == LayerCoding::direction ? kDirectionError : 0;
}

const Layer* LayerTable::find(std::uint16_t id) const {
  const auto it = std::find_if(layers.begin(), layers.end(), [&](const Layer& layer) { return layer.id == id; });
  return it == layers.end() ? nullptr : &*it;
}

const Layer* LayerTable::polygons() const {
  const auto it = std::find_if(layers.begin(), layers.end(),
                               [](const Layer& layer) { return layer.coding == LayerCoding::polygons; });
  return it == layers.end() ? nullptr : &*it;
}

Buffer encode_layer_table(const LayerTable& table) {
  json layers = json::array();
  for (const Layer& layer : table.layers) layers.push_back(layer_json(layer));
  return json::to_cbor(json{{"format", kTableFormat}, {"layers", layers}, {"references", table.references}});
}

LayerTable decode_layer_table(Bytes blob, std::string_view where) {
  try {
    const json j = json::from_cbor(blob.begin(), blob.end());
    if (j.at("format").get<int>() != kTableFormat)
      throw Error(Errc::unsupported_version, "the layer table has a newer format", where, "use a newer ramcdb");
    LayerTable table;
    for (const json& layer : j.at("layers")) table.layers.push_back(layer_from(layer));
    table.references = j.at("references").get<std::vector<std::string>>();
    return table;
  } catch (const json::exception& e) {
    throw Error(Errc::corrupt, std::string("the layer table is damaged: ") + e.what(), where, "run `ramcdb verify`");
  }
}

Layer polygon_layer(std::uint16_t id) {
  Layer layer{id, {}, LayerCoding::polygons, 0};
  layer.info.name = "polygons";
  layer.info.of = AttributeOf::face;
  return layer;
}

Layer layer_for(const mesh_file::AttributeView& attribute, std::uint16_t id, bool lossless) {
  Layer layer{id, attribute.info, LayerCoding::integer, 0};
  if (!is_float(attribute.info.type)) return layer;
  layer.coding = LayerCoding::float_bits;
  const double step = step_for(attribute.info.meaning);
  if (lossless || step == 0) return layer;
  if (attribute.info.meaning == Meaning::normal && attribute.info.components == 3 &&
      all_values(attribute, is_direction)) {
    layer.coding = LayerCoding::direction;
  } else if (all_values(attribute, [&](std::span<const double> value) {
               return std::all_of(value.begin(), value.end(), [&](double number) { return on_grid(number, step); });
             })) {
    layer.coding = LayerCoding::grid;
    layer.step = step;
  }
  return layer;
}

bool to_numbers(const Layer& layer, std::span<const double> value, std::span<std::uint64_t> numbers) {
  if (is_absent(value) && layer.coding != LayerCoding::float_bits) {
    std::fill(numbers.begin(), numbers.end(), 0);
    return false;
  }
  if (layer.coding == LayerCoding::direction) {
    if (!is_direction(value)) refuse_direction(layer, value);
    const codec::OctahedronPoint p = nearest_point(value);
    numbers[0] = static_cast<std::uint64_t>(std::int64_t{p.u}) & kDirectionMask;
    numbers[1] = static_cast<std::uint64_t>(std::int64_t{p.v}) & kDirectionMask;
    return true;
  }
  for (std::size_t k = 0; k < value.size(); ++k) numbers[k] = to_number(layer, value[k]);
  return true;
}

void from_numbers(const Layer& layer, std::span<const std::uint64_t> numbers, std::span<double> value) {
  if (layer.coding == LayerCoding::direction) {
    const auto extended = [](std::uint64_t x) { return static_cast<std::int32_t>(static_cast<std::int16_t>(x)); };
    const std::array<double, 3> d = direction_at({extended(numbers[0]), extended(numbers[1])});
    const bool is_float32 = layer.info.type == NumberType::float32;
    for (std::size_t k = 0; k < 3; ++k) value[k] = is_float32 ? double{static_cast<float>(d[k])} : d[k];
    return;
  }
  for (std::size_t k = 0; k < value.size(); ++k) value[k] = from_number(layer, numbers[k]);
}

}  // namespace ramcdb::detail
