#include "codec/page_codec.h"
#include "tests/codec/page_families.h"
#include "tests/fuzz/coder_input.h"

/// A page that is decoded keeps the rules, and comes back from its own blob.
namespace ramcdb::fuzz {

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (const auto& [name, page] : codec::testing::pages())
    all.push_back(CoderSeed().named("page-" + std::to_string(all.size()), codec::encode_page(page)));
  return all;
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  Page page;
  if (fuzz::refuses([&] { page = codec::decode_page(Bytes(data, size)); })) return 0;
  codec::validate_page(page, "decoded");
  fuzz::require(codec::decode_page(codec::encode_page(page)) == page, "another page comes back");
  return 0;
}
