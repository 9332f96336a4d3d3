#pragma once

#include <string>
#include <vector>

#include "ramcdb/region.h"

namespace CLI {
class App;
}

namespace ramcdb::cli {

/// REGION as texts; every option may be repeated, and all of them are united.
struct RegionOptions {
  std::vector<std::string> boxes, spheres, charts, points, frusta;
  bool all = false;
  unsigned grow = 0;
};

/// What a verb does with a region.
enum class RegionUse {
  charts,  ///< takes all charts that it meets
  parts,   ///< its boxes, balls and frusta cut through charts
};

void add_region(CLI::App& verb, RegionOptions& options, RegionUse use = RegionUse::charts);

/// Whether no shape is given.
[[nodiscard]] bool is_empty(const RegionOptions& options);

/// Throws UsageError when a text is malformed or no shape is given.
[[nodiscard]] Region region_of(const RegionOptions& options, const std::string& verb);

}  // namespace ramcdb::cli
