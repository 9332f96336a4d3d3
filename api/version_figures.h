#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ramcdb::detail {

/// What a version tells logs about itself; stored as JSON with its row.
struct VersionFigures {
  std::string operation;  ///< "import", "commit"
  std::uint64_t charts_touched = 0, vertices_moved = 0, vertices_added = 0, vertices_removed = 0;
  double max_displacement = 0;  ///< model units
  std::uint64_t bytes_written = 0;
};

[[nodiscard]] std::string encode_figures(const VersionFigures& figures);
/// Unreadable text gives empty figures: they are for show only.
[[nodiscard]] VersionFigures decode_figures(std::string_view text);

}  // namespace ramcdb::detail
