#pragma once

#include <cstddef>
#include <string>

namespace ramcdb::cli {

/// How far a piece of long work is.
struct ProgressState {
  std::string verb, stage;
  double done = 0;           ///< share of the stage, 0..1
  double stage_seconds = 0;  ///< since the stage began
  double total_bytes = 0;    ///< that the whole stage goes through, for the rate; 0 gives percent per second
};

/// One line of at most `width` characters. What does not fit is left out: first the bar, then the rate, then the time.
[[nodiscard]] std::string progress_line(const ProgressState& state, std::size_t width);

}  // namespace ramcdb::cli
