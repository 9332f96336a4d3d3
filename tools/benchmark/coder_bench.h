#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ramcdb/figures.h"
#include "tools/benchmark/peer.h"

namespace ramcdb::benchmark {

/// One coder on one mesh, beside others in the same run. Speeds are medians over rounds in which the contestants take
/// turns, in faces per second, in memory; `decode_all` with as many threads as there are cores, where that is possible.
struct Contestant {
  std::string name;
  std::uint64_t bytes = 0;  ///< everything that opening the mesh takes; of ours without attributes
  /// Of ours: what `bytes` are made of, by the encoder's own count; index are pages, chart headers and tables.
  std::uint64_t connectivity = 0, geometry = 0, wires = 0, index = 0;
  CameBack back;  ///< Draco and others may drop degenerate faces and isolated vertices
  double encode = 0, decode = 0, decode_all = 0;

  /// What so many of its bytes are for each vertex that came back.
  [[nodiscard]] double bits_per_vertex(std::uint64_t of_bytes) const {
    return 8 * static_cast<double>(of_bytes) / static_cast<double>(back.vertices);
  }
  [[nodiscard]] double bits_per_vertex() const { return bits_per_vertex(bytes); }
};

struct CoderFigures {
  std::string mesh;
  std::uint64_t vertices = 0, faces = 0;
  std::vector<Contestant> contestants;  ///< ours first
  /// Random access: one chart out of a repository, opened for it, and the least that a whole-mesh coder must read.
  double chart_bytes = 0, chart_blobs = 0, chart_seconds = 0;

  [[nodiscard]] const Contestant& find(const std::string& name) const;
};

struct CoderOptions {
  unsigned bits = 12, rounds = 5;
  std::vector<std::uint32_t> chart_faces{5000};  ///< the first is the one that is timed
};

/// `scratch` is an empty folder that exists.
[[nodiscard]] CoderFigures measure_coder(const std::filesystem::path& file, const std::filesystem::path& scratch,
                                         const CoderOptions& options);

}  // namespace ramcdb::benchmark
