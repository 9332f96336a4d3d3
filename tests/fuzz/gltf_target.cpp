#include "tests/fuzz/mesh_reader.h"

std::vector<ramcdb::fuzz::Seed> ramcdb::fuzz::seeds() { return mesh_seeds(".gltf", {}); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ramcdb::fuzz::read_and_check({reinterpret_cast<const char*>(data), size}, ramcdb::mesh_file::Format::gltf);
  return 0;
}
