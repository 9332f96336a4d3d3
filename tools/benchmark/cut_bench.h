#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace ramcdb::benchmark {

/// What a mesh takes when it is cut into charts by us, and by METIS.
struct CutFigures {
  std::string mesh;
  std::uint64_t vertices = 0;
  /// Everything in the dense profile: charts, wires, pages, tables, checksums. `metis`: METIS (k-way, least
  /// communication volume) in front, then our refinement.
  std::uint64_t ours = 0, metis = 0;
  std::uint64_t charts = 0, metis_charts = 0;
};

[[nodiscard]] CutFigures measure_cut(const std::filesystem::path& file, unsigned bits, std::uint32_t chart_faces);

}  // namespace ramcdb::benchmark
