#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ramcdb::benchmark {

/// What positions to the last bit take.
struct LosslessFigures {
  std::string mesh;
  bool doubles = false;  ///< float64 coordinates, else float32
  std::uint64_t vertices = 0;
  std::uint64_t positions = 0;  ///< bytes of charts' geometry, exact positions and wires, when imported with --lossless
  std::uint64_t everything = 0;  ///< payload without attributes
  /// The coordinates as exported, each XORed with that of the vertex before, in byte planes, through zstd -19.
  std::uint64_t xor_zstd = 0;
};

/// `scratch` is an empty folder that exists.
[[nodiscard]] LosslessFigures measure_lossless(const std::filesystem::path& file, const std::filesystem::path& scratch);

}  // namespace ramcdb::benchmark
