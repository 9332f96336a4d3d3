#include "codec/tables.h"

#include <xxhash.h>

#include "codec/built_in_weights.h"
#include "codec/fast_table_coder.h"
#include "codec/varint.h"

namespace ramcdb::codec {

namespace {

/// A table blob:
///
///   table   = format:1 parts:1 [dense] [fast_part] check:4
///   dense   = fan_mask:12 plane_mask:2 weights*
///   weights = 6 (fan) or 3 (plane) signed varints       for each class whose bit is set, ascending
///
/// parts: bit 0 says that the dense profile's weights differ from the built-in ones, bit 1 that the fast profile's
/// tables do (fast_part: codec/fast_table_coder.h); a part that does not differ is left out. Bit i of a mask, lowest
/// first, says that class i differs from the built-in table. check: the lower half of XXH3-64 over all bytes before it.
/// Formats that were ever written: 1.
constexpr std::uint8_t kTableFormat = 1;
constexpr unsigned kDensePart = 1, kFastPart = 2;

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
  const bool dense = tables.fan != built_in.fan || tables.plane != built_in.plane, fast = tables.fast != built_in.fast;
  Buffer out{kTableFormat, static_cast<std::uint8_t>((dense ? kDensePart : 0) | (fast ? kFastPart : 0))};
  if (dense) {
    put_mask(out, tables.fan, built_in.fan);
    put_mask(out, tables.plane, built_in.plane);
    put_weights(out, tables.fan, built_in.fan);
    put_weights(out, tables.plane, built_in.plane);
  }
  if (fast) {
    const Buffer part = encode_fast_tables(tables.fast);
    out.insert(out.end(), part.begin(), part.end());
  }
  put_fixed32(out, check_of(out));
  return out;
}

CoderTables decode_tables(Bytes blob) {
  ByteReader reader(blob, "table blob");
  if (const std::uint8_t format = reader.byte(); format != kTableFormat) {
    if (format > kTableFormat) throw Error(Errc::unsupported_version, "a table blob of a newer format");
    reader.fail("is of no known format");
  }
  const unsigned parts = reader.byte();
  if (parts > (kDensePart | kFastPart)) reader.fail("has parts that are not known");
  CoderTables tables;
  if (parts & kDensePart) {
    const Bytes fan_mask = reader.take(kFanClasses / 8);
    const Bytes plane_mask = reader.take(kPlaneClasses / 8);
    take_weights(reader, fan_mask, tables.fan);
    take_weights(reader, plane_mask, tables.plane);
  }
  if (reader.rest().size() < 4) reader.fail("ends too early");
  const Bytes fast = reader.take(reader.rest().size() - 4);
  if (reader.fixed32() != check_of(blob.first(blob.size() - 4))) reader.fail("is damaged");
  if (parts & kFastPart)
    tables.fast = decode_fast_tables(fast);
  else if (!fast.empty())
    reader.fail("has bytes behind its end");
  return tables;
}

}  // namespace ramcdb::codec
