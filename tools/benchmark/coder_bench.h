#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "ramcdb/figures.h"

namespace ramcdb::benchmark {

/// Size and speed of our coder and of Draco on one mesh, on the same lattice, in the same run. Speeds are medians over
/// rounds in which the contestants take turns, in faces per second, on one thread, without disk.
struct CoderFigures {
  std::string mesh;
  MeshInfo info;  ///< of a repository that holds nothing but the mesh
  double cut = 0, encode = 0, decode = 0;
  struct Peer {
    std::uint64_t bytes = 0;
    std::uint64_t faces = 0;  ///< that came back: Draco drops degenerate faces
    double encode = 0, decode = 0;
  };
  Peer draco10, draco7;
};

/// `scratch` is an empty folder that exists.
[[nodiscard]] CoderFigures measure_coder(const std::filesystem::path& file, const std::filesystem::path& scratch,
                                         unsigned bits, unsigned rounds);

}  // namespace ramcdb::benchmark
