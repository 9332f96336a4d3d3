#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "codec/layer_codec.h"
#include "ramcdb/attributes.h"
#include "ramcdb/bytes.h"

namespace ramcdb::detail {

/// How the numbers of an attribute become whole numbers. Stored; never reused.
enum class LayerCoding : std::uint8_t {
  integer = 1,     ///< as they are
  float_bits = 2,  ///< a float's bits, so ordered that they count upwards with the number: lossless
  grid = 3,        ///< round(number / step)
  polygons = 4,    ///< no attribute: which triangles are one polygon
  direction = 5,   ///< three floats of length 1, or three zeros, as a point of the octahedron (codec/octahedron.h)
};

/// One layer of a mesh: an attribute, or its polygons. Charts have a blob each.
struct Layer {
  std::uint16_t id = 0;  ///< 1, 2, ... within the mesh
  AttributeInfo info;
  LayerCoding coding = LayerCoding::integer;
  double step = 0;  ///< of a grid

  [[nodiscard]] codec::LayerShape shape() const;
  /// The largest error that coding makes in a number; 0 where it makes none.
  [[nodiscard]] double max_error() const;
  friend bool operator==(const Layer&, const Layer&) = default;
};

/// All layers of a mesh, and what else of its file is kept.
struct LayerTable {
  std::vector<Layer> layers;            ///< ascending by id
  std::vector<std::string> references;  ///< to other files, such as "mtllib a.mtl"

  [[nodiscard]] bool empty() const { return layers.empty() && references.empty(); }
  [[nodiscard]] const Layer* find(std::uint16_t id) const;
  [[nodiscard]] const Layer* polygons() const;
  friend bool operator==(const LayerTable&, const LayerTable&) = default;
};

/// As CBOR.
[[nodiscard]] Buffer encode_layer_table(const LayerTable& table);
/// Throws corrupt, naming `where`.
[[nodiscard]] LayerTable decode_layer_table(Bytes blob, std::string_view where);

/// The layer that says which triangles are one polygon.
[[nodiscard]] Layer polygon_layer(std::uint16_t id);

/// The layer that an attribute is stored as, unless `lossless` or it cannot hold the numbers: normals of length 1 as
/// directions; other floats that programs compute with (colours, normals, texture coordinates) on a grid; all else
/// without loss.
[[nodiscard]] Layer layer_for(const mesh_file::AttributeView& attribute, std::uint16_t id, bool lossless);

/// One value of an attribute as a layer codes it: `numbers` gets shape().components of them. False when it is absent.
/// Numbers that the layer cannot hold (not whole, out of range) throw invalid_argument naming the attribute.
[[nodiscard]] bool to_numbers(const Layer& layer, std::span<const double> value, std::span<std::uint64_t> numbers);
/// The way back: from shape().components numbers to info.components ones.
void from_numbers(const Layer& layer, std::span<const std::uint64_t> numbers, std::span<double> value);

}  // namespace ramcdb::detail
