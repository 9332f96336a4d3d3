#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/layer_order.h"
#include "ramcdb/attributes.h"
#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// What the numbers of a value mean together, as far as it helps coding.
enum class ValueKind : std::uint8_t {
  numbers,
  color,      ///< components 0, 1, 2 are red, green, blue: coded as green and two differences
  direction,  ///< two components of kDirectionBits bits: an OctahedronPoint, signed
};
inline constexpr std::uint8_t kDirectionBits = 16;

/// How the values of a layer are laid out. Part of what a decoder has to know beforehand; not in the blob.
struct LayerShape {
  AttributeOf of = AttributeOf::vertex;
  std::uint8_t components = 1;  ///< 1..16
  std::uint8_t bits = 32;       ///< 1..64: every number is below 2^bits; predictions wrap around there
  ValueKind kind = ValueKind::numbers;

  friend bool operator==(const LayerShape&, const LayerShape&) = default;
};

/// Values of a layer in a chart: `shape.components` numbers for each of its vertices, of its corners (3 * face + 0..2)
/// or of its faces, in the chart's numbering; and which of them there are. Numbers of absent values are 0.
struct LayerValues {
  std::vector<std::uint64_t> numbers;
  std::vector<bool> absent;  ///< empty: none is

  friend bool operator==(const LayerValues&, const LayerValues&) = default;
};

/// How many values a chart has.
[[nodiscard]] std::size_t value_count(const Chart& chart, AttributeOf of);

/// Codes a layer of a chart. Depends on the chart's connectivity and border, not on positions: codes made before
/// vertices moved are good afterwards, as long as `LayerOrder` visits the same vertices and faces. Decoded again and
/// compared before it is returned. Throws invalid_argument for counts that are not the chart's, numbers of 2^bits or
/// more and directions that are no points of the octahedron.
[[nodiscard]] Buffer encode_layer(const LayerValues& values, const LayerShape& shape, const Chart& chart,
                                  const LayerOrder& order);

/// Bytes may be hostile. Throws corrupt, also when chart or shape are not those of the encoder (with high probability:
/// a check of the values is in the blob).
[[nodiscard]] LayerValues decode_layer(Bytes blob, const LayerShape& shape, const Chart& chart,
                                       const LayerOrder& order);

}  // namespace ramcdb::codec
