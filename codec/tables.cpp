#include "codec/tables.h"

#include <xxhash.h>

#include "codec/built_in_weights.h"
#include "codec/varint.h"

namespace ramcdb::codec {

namespace {

/// A table blob:
///
///   table   = format:1 fan_mask:12 plane_mask:2 weights* check:4
///   weights = 6 (fan) or 3 (plane) signed varints       for each class whose bit is set, ascending
///
/// Bit i of a mask, lowest first, says that class i differs from the built-in table. check: the lower half of XXH3-64
/// over all bytes before it. Formats that were ever written: 1.
constexpr std::uint8_t kTableFormat = 1;

std::uint32_t check_of(Bytes bytes) { return static_cast<std::uint32_t>(XXH3_64bits(bytes.data(), bytes.size())); }

template <class Classes>
void put_mask(Buffer& out, const Classes& classes, const Classes& built_in) {
  for (std::size_t i = 0; i < classes.size(); i += 8) {
    unsigned bits = 0;
    for (std::size_t j = 0; j < 8; ++j) bits |= static_cast<unsigned>(classes[i + j] != built_in[i + j]) << j;
    out.push_back(static_cast<std::uint8_t>(bits));
  }
}

template <class Classes>
void put_weights(Buffer& out, const Classes& classes, const Classes& built_in) {
  for (std::size_t i = 0; i < classes.size(); ++i)
    if (classes[i] != built_in[i])
      for (const std::int16_t weight : classes[i]) {
        if (weight < -kMaxWeight || weight > kMaxWeight)
          throw Error(Errc::invalid_argument, "a weight of a coder table is beyond reason");
        put_signed_varint(out, weight);
      }
}

template <class Classes>
void take_weights(ByteReader& reader, Bytes mask, Classes& classes) {
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if ((mask[i / 8] >> (i % 8) & 1) == 0) continue;
    for (std::int16_t& weight : classes[i]) {
      const std::int64_t value = reader.signed_varint();
      if (value < -kMaxWeight || value > kMaxWeight) reader.fail("has a weight beyond reason");
      weight = static_cast<std::int16_t>(value);
    }
  }
}

}  // namespace

CoderTables::CoderTables() : fan(kBuiltInFanWeights), plane(kBuiltInPlaneWeights) {}

Buffer encode_tables(const CoderTables& tables) {
  const CoderTables built_in;
  Buffer out{kTableFormat};
  put_mask(out, tables.fan, built_in.fan);
  put_mask(out, tables.plane, built_in.plane);
  put_weights(out, tables.fan, built_in.fan);
  put_weights(out, tables.plane, built_in.plane);
  put_fixed32(out, check_of(out));
  return out;
}

CoderTables decode_tables(Bytes blob) {
  ByteReader reader(blob, "table blob");
  if (const std::uint8_t format = reader.byte(); format != kTableFormat) {
    if (format > kTableFormat) throw Error(Errc::unsupported_version, "a table blob of a newer format");
    reader.fail("is of no known format");
  }
  CoderTables tables;
  const Bytes fan_mask = reader.take(kFanClasses / 8);
  const Bytes plane_mask = reader.take(kPlaneClasses / 8);
  take_weights(reader, fan_mask, tables.fan);
  take_weights(reader, plane_mask, tables.plane);
  const Bytes checked = blob.first(blob.size() - reader.rest().size());
  if (reader.fixed32() != check_of(checked)) reader.fail("is damaged");
  reader.expect_end();
  return tables;
}

}  // namespace ramcdb::codec
