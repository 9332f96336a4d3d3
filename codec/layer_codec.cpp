#include "codec/layer_codec.h"

#include <xxhash.h>

#include <algorithm>

#include "codec/layer_walk.h"
#include "codec/range_coder.h"
#include "codec/varint.h"

namespace ramcdb::codec {

// layer  = format:1 flags:1 check:fixed32 stream
// flags  = 1 if some values are absent, else 0
// check  = the lower half of XXH3-64 over the values in their order: each number as 8 bytes, lowest first, then a byte
//          that says whether the value is absent, if flags = 1
// stream = as in codec/layer_walk.h

namespace {

constexpr std::uint8_t kLayerFormat = 1, kSomeAbsent = 1;

/// Red and blue are mostly like green.
void to_differences(LayerValues& values, const LayerShape& shape, const Ring& ring) {
  for (std::size_t i = 0; i + shape.components <= values.numbers.size(); i += shape.components) {
    std::uint64_t* n = values.numbers.data() + i;
    const std::uint64_t r = n[0], g = n[1], b = n[2];
    n[0] = g;
    n[1] = ring.wrap(r - g);
    n[2] = ring.wrap(b - g);
  }
}

void from_differences(LayerValues& values, const LayerShape& shape, const Ring& ring) {
  for (std::size_t i = 0; i + shape.components <= values.numbers.size(); i += shape.components) {
    std::uint64_t* n = values.numbers.data() + i;
    const std::uint64_t g = n[0], r = n[1], b = n[2];
    n[0] = ring.wrap(r + g);
    n[1] = g;
    n[2] = ring.wrap(b + g);
  }
}

bool has_differences(const LayerShape& shape) { return shape.kind == ValueKind::color && shape.components >= 3; }

bool are_directions(const LayerValues& values, const Ring& ring) {
  for (std::size_t i = 0; i + 2 <= values.numbers.size(); i += 2)
    if (!is_octahedron_point(direction_of(values.numbers[i], values.numbers[i + 1], ring))) return false;
  return true;
}

/// Absent values count as 0 everywhere.
void clear_absent(LayerValues& values, const LayerShape& shape) {
  for (std::size_t v = 0; v < values.absent.size(); ++v)
    if (values.absent[v])
      std::fill_n(values.numbers.begin() + static_cast<std::ptrdiff_t>(v * shape.components), shape.components, 0);
}

/// Calls `visit` with the number of every value, in the order that they are coded in.
template <class Visit>
void for_each_value(AttributeOf of, const LayerOrder& order, Visit&& visit) {
  if (of == AttributeOf::vertex) {
    for (const std::uint32_t v : order.vertices()) visit(v);
    return;
  }
  for (const std::uint32_t entry : order.entries())
    if (of == AttributeOf::face)
      visit(entry / 3);
    else
      for (const std::uint32_t c : {entry, LayerOrder::next(entry), LayerOrder::prev(entry)}) visit(c);
}

std::uint32_t check_of(const LayerValues& values, const LayerShape& shape, const LayerOrder& order) {
  Buffer bytes;
  bytes.reserve(8 * values.numbers.size() + values.absent.size());
  for_each_value(shape.of, order, [&](std::uint32_t at) {
    for (std::size_t k = 0; k < shape.components; ++k)
      for (int shift = 0; shift < 64; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(values.numbers[at * std::size_t{shape.components} + k] >> shift));
    if (!values.absent.empty()) bytes.push_back(values.absent[at]);
  });
  return static_cast<std::uint32_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

void require_values(const LayerValues& values, const LayerShape& shape, const Chart& chart) {
  const std::size_t count = value_count(chart, shape.of);
  const bool is_direction = shape.kind == ValueKind::direction;
  if (shape.components < 1 || shape.components > 16 || shape.bits < 1 || shape.bits > 64 ||
      (is_direction && (shape.components != 2 || shape.bits != kDirectionBits)))
    throw Error(Errc::invalid_argument, "a layer has a shape that cannot be coded");
  if (values.numbers.size() != count * shape.components || (!values.absent.empty() && values.absent.size() != count))
    throw Error(Errc::invalid_argument, "a layer has another number of values than its chart");
  const Ring ring(shape.bits);
  if (!std::all_of(values.numbers.begin(), values.numbers.end(), [&](std::uint64_t n) { return ring.wrap(n) == n; }))
    throw Error(Errc::invalid_argument, "a layer has numbers that are wider than it says");
  if (is_direction && !are_directions(values, ring))
    throw Error(Errc::invalid_argument, "a layer has directions that are none");
}

}  // namespace

std::size_t value_count(const Chart& chart, AttributeOf of) {
  return of == AttributeOf::vertex ? chart.positions.size() : (of == AttributeOf::corner ? 3 : 1) * chart.faces.size();
}

Buffer encode_layer(const LayerValues& values, const LayerShape& shape, const Chart& chart, const LayerOrder& order) {
  require_values(values, shape, chart);
  LayerValues coded = values;
  const bool some_absent = std::find(coded.absent.begin(), coded.absent.end(), true) != coded.absent.end();
  if (!some_absent) coded.absent.clear();
  clear_absent(coded, shape);
  const LayerValues plain = coded;
  if (has_differences(shape)) to_differences(coded, shape, Ring(shape.bits));
  RangeEncoder coder;
  LayerWalk(coder, coded, shape, chart, order, some_absent).run();
  Buffer blob{kLayerFormat, some_absent ? kSomeAbsent : std::uint8_t{0}};
  put_fixed32(blob, check_of(plain, shape, order));
  const Buffer stream = coder.finish();
  blob.insert(blob.end(), stream.begin(), stream.end());
  if (decode_layer(blob, shape, chart, order) != plain)
    throw Error(Errc::invalid_argument, "a layer cannot be coded", {}, "report this: it is a bug");
  return blob;
}

LayerValues decode_layer(Bytes blob, const LayerShape& shape, const Chart& chart, const LayerOrder& order) {
  ByteReader reader(blob, "layer blob");
  if (reader.byte() != kLayerFormat) reader.fail("has an unknown format");
  const std::uint8_t flags = reader.byte();
  if (flags > kSomeAbsent) reader.fail("has unknown flags");
  const std::uint32_t check = reader.fixed32();
  LayerValues values;
  const std::size_t count = value_count(chart, shape.of);
  values.numbers.assign(count * shape.components, 0);
  if (flags) values.absent.assign(count, false);
  RangeDecoder coder(reader.rest());
  LayerWalk(coder, values, shape, chart, order, flags == kSomeAbsent).run();
  coder.finish();
  if (has_differences(shape)) from_differences(values, shape, Ring(shape.bits));
  clear_absent(values, shape);
  if (check_of(values, shape, order) != check) reader.fail("is damaged, or belongs to another chart");
  return values;
}

}  // namespace ramcdb::codec
