#include "codec/tables.h"
#include "tests/fuzz/coder_input.h"

/// A table that is decoded has weights in bounds, and comes back from its own blob.
namespace ramcdb::fuzz {

std::vector<Seed> seeds() {
  codec::CoderTables other;
  other.fan[5][2] = codec::kMaxWeight;
  other.plane[3][0] = -codec::kMaxWeight;
  return {CoderSeed().named("built-in", codec::encode_tables({})),
          CoderSeed().named("other", codec::encode_tables(other))};
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  codec::CoderTables tables;
  if (fuzz::refuses([&] { tables = codec::decode_tables(Bytes(data, size)); })) return 0;
  fuzz::require(codec::decode_tables(codec::encode_tables(tables)) == tables, "another table comes back");
  return 0;
}
