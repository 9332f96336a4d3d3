#include "cli/progress_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/text.h"

namespace ramcdb::cli {
namespace {

constexpr std::size_t kShortestBar = 8;
constexpr std::size_t kLongestBar = 30;

std::string rate_text(const ProgressState& state) {
  const double share_per_second = state.done / state.stage_seconds;
  if (state.total_bytes > 0) return fmt::format("{:.1f} MB/s", share_per_second * state.total_bytes / 1e6);
  return fmt::format("{:.1f} %/s", 100 * share_per_second);
}

std::string bar_text(double done, std::size_t length) {
  const auto filled = static_cast<std::size_t>(done * static_cast<double>(length));
  return '[' + std::string(filled, '#') + std::string(length - filled, '-') + ']';
}

}  // namespace

std::string progress_line(const ProgressState& state, std::size_t width) {
  const double done = std::isfinite(state.done) ? std::clamp(state.done, 0.0, 1.0) : 0;
  std::string head = state.stage.empty() ? state.verb : state.verb + ": " + state.stage;
  std::string tail = fmt::format(" {:3.0f} %", 100 * done);
  const bool moving = done > 0 && state.stage_seconds > 0;

  if (moving) {
    const std::string left = "  " + duration(state.stage_seconds * (1 - done) / done) + " left";
    const std::string rate = "  " + rate_text(state);
    if (head.size() + tail.size() + rate.size() + left.size() <= width)
      tail += rate + left;
    else if (head.size() + tail.size() + left.size() <= width)
      tail += left;
  }
  const std::size_t used = head.size() + tail.size() + 4;  // two spaces and two brackets
  if (used + kShortestBar <= width) head += "  " + bar_text(done, std::min(kLongestBar, width - used));
  return (head + tail).substr(0, width);
}

}  // namespace ramcdb::cli
