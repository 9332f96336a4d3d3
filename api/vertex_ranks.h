#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ramcdb::detail {

/// Vertices that are named in any order, any number of times, and where each stands among all of them.
struct VertexRanks {
  explicit VertexRanks(std::span<const std::uint32_t> named);

  std::vector<std::uint32_t> vertices;  ///< ascending, each once
  std::vector<std::uint32_t> rank;      ///< per name its place in `vertices`
};

}  // namespace ramcdb::detail
