#include "codec/tables.h"

#include <xxhash.h>

#include "codec/built_in_weights.h"
#include "codec/fast_table_coder.h"
#include "codec/range_coder.h"
#include "codec/varint.h"

namespace ramcdb::codec {

namespace {

// table   = format:1 check:fixed32 stream
// stream  = class* fast_part                fan classes, then plane classes, ascending; codec/fast_table_coder.h
// class   = own:bit difference{6 or 3}      differences to the built-in weights, if it has weights of its own
// check   = the lower half of XXH3-64 over all weights and the fast tables' digest, each fixed32. Formats that were
// ever
//           written: 1.
constexpr std::uint8_t kTableFormat = 1;

/// The classes of one kind, for encoder and decoder alike.
template <class Coder, class Classes>
void code_classes(Coder& coder, Classes& classes, const Classes& built_in) {
  AdaptiveBit own;
  AdaptiveSigned difference;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (!coder.code(own, classes[i] != built_in[i])) continue;
    for (std::size_t k = 0; k < classes[i].size(); ++k) {
      const std::int64_t weight = std::int64_t{difference.code(coder, classes[i][k] - built_in[i][k])} + built_in[i][k];
      if (weight < -kMaxWeight || weight > kMaxWeight)
        throw Error(Errc::corrupt, "a table blob has a weight beyond reason");
      classes[i][k] = static_cast<std::int16_t>(weight);
    }
    if (classes[i] == built_in[i]) throw Error(Errc::corrupt, "a table blob says what is built in");
  }
}

template <class Coder>
void code_tables(Coder& coder, CoderTables& tables) {
  const CoderTables built_in;
  code_classes(coder, tables.fan, built_in.fan);
  code_classes(coder, tables.plane, built_in.plane);
  FastNumbers fast = tables.fast.numbers();
  FastTablePart(coder).code(fast);
  if (!Coder::kEncodes) tables.fast = FastTables(fast);
}

std::uint32_t check_of(const CoderTables& tables) {
  Buffer bytes;
  const auto add = [&](const auto& classes) {
    for (const auto& weights : classes)
      for (const std::int16_t weight : weights) put_fixed32(bytes, static_cast<std::uint32_t>(weight));
  };
  add(tables.fan);
  add(tables.plane);
  for (int shift = 0; shift < 64; shift += 32)
    put_fixed32(bytes, static_cast<std::uint32_t>(tables.fast.digest() >> shift));
  return static_cast<std::uint32_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

void require_weights(const CoderTables& tables) {
  const auto require = [](const auto& classes) {
    for (const auto& weights : classes)
      for (const std::int16_t weight : weights)
        if (weight < -kMaxWeight || weight > kMaxWeight)
          throw Error(Errc::invalid_argument, "a weight of a coder table is beyond reason");
  };
  require(tables.fan);
  require(tables.plane);
}

}  // namespace

CoderTables::CoderTables() : fan(kBuiltInFanWeights), plane(kBuiltInPlaneWeights) {}

Buffer encode_tables(const CoderTables& tables) {
  require_weights(tables);
  Buffer out{kTableFormat};
  put_fixed32(out, check_of(tables));
  CoderTables coded = tables;
  RangeEncoder coder;
  code_tables(coder, coded);
  const Buffer stream = coder.finish();
  out.insert(out.end(), stream.begin(), stream.end());
  return out;
}

CoderTables decode_tables(Bytes blob) {
  ByteReader reader(blob, "table blob");
  if (const std::uint8_t format = reader.byte(); format != kTableFormat) {
    if (format > kTableFormat) throw Error(Errc::unsupported_version, "a table blob of a newer format");
    reader.fail("is of no known format");
  }
  const std::uint32_t check = reader.fixed32();
  CoderTables tables;
  RangeDecoder coder(reader.rest());
  code_tables(coder, tables);
  coder.finish();
  if (check_of(tables) != check) reader.fail("is damaged");
  return tables;
}

}  // namespace ramcdb::codec
