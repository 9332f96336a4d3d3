#pragma once

#include <functional>
#include <string_view>

#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Says that a stage begins.
inline void begin_stage(const Progress& progress, std::string_view name) {
  if (progress) progress(name, 0);
}

/// Says so, and returns what tells the share of it that is done; empty when nobody asks. `progress` must outlive it.
[[nodiscard]] inline std::function<void(double)> stage(const Progress& progress, std::string_view name) {
  if (!progress) return {};
  begin_stage(progress, name);
  return [&progress, name](double done) { progress(name, done); };
}

}  // namespace ramcdb::detail
