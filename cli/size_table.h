#pragma once

#include <string>

#include "ramcdb/figures.h"

namespace ramcdb::cli {

/// What a mesh takes, by kind, in bytes and bits per vertex, as in the paper's table 4: overhead (wire-net, wires,
/// headers, tables) and charts, connectivity and geometry apart. Then how that compares with plain arrays of float32
/// coordinates and 32-bit indices.
[[nodiscard]] std::string size_table(const MeshInfo& info);

}  // namespace ramcdb::cli
