#pragma once

#include <filesystem>
#include <vector>

#include "tools/benchmark/coder_bench.h"

namespace ramcdb::benchmark {

/// Draws all coders as SVG: size against Draco cl10 (geometric mean over the meshes) over decoding speed (median).
/// REQUIRES: all meshes have the same contestants.
void write_plot(const std::vector<CoderFigures>& figures, const std::filesystem::path& file);

}  // namespace ramcdb::benchmark
