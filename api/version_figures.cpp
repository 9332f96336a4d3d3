#include "api/version_figures.h"

#include <nlohmann/json.hpp>

namespace ramcdb::detail {

using nlohmann::json;

std::string encode_figures(const VersionFigures& figures) {
  return json{{"operation", figures.operation},
              {"charts_touched", figures.charts_touched},
              {"vertices_moved", figures.vertices_moved},
              {"vertices_added", figures.vertices_added},
              {"vertices_removed", figures.vertices_removed},
              {"max_displacement", figures.max_displacement},
              {"bytes_written", figures.bytes_written}}
      .dump();
}

VersionFigures decode_figures(std::string_view text) {
  VersionFigures figures;
  try {
    const json j = json::parse(text);
    figures.operation = j.value("operation", "");
    figures.charts_touched = j.value("charts_touched", std::uint64_t{0});
    figures.vertices_moved = j.value("vertices_moved", std::uint64_t{0});
    figures.vertices_added = j.value("vertices_added", std::uint64_t{0});
    figures.vertices_removed = j.value("vertices_removed", std::uint64_t{0});
    figures.max_displacement = j.value("max_displacement", 0.0);
    figures.bytes_written = j.value("bytes_written", std::uint64_t{0});
  } catch (const json::exception&) {
    figures = {};
  }
  return figures;
}

}  // namespace ramcdb::detail
