#include "cli/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "cli/interrupt.h"

namespace ramcdb::cli {
namespace {

using namespace std::chrono_literals;

// Late enough that quick work shows nothing, well within the second that people wait without doubt.
constexpr auto kFirstLine = 400ms;
constexpr auto kBetweenLines = 100ms;
constexpr const char* kWipeLine = "\r\033[K";

/// Columns to draw in: one less than the terminal has, since writing into the last one wraps on some.
std::size_t usable_columns() {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return 79;
  return size.ws_col - std::size_t{1};
}

}  // namespace

ProgressBar::ProgressBar(std::string_view verb, bool quiet, double total_bytes) {
  state_.verb = verb;
  state_.total_bytes = total_bytes;
  catch_interrupts();
  if (!quiet && isatty(STDERR_FILENO) == 1) painter_ = std::thread([this] { draw_until_stopped(); });
}

ProgressBar::~ProgressBar() {
  if (!painter_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stop_.notify_one();
  painter_.join();
}

Progress ProgressBar::callback() {
  return [this](std::string_view stage, double done) { report(stage, done); };
}

void ProgressBar::report(std::string_view stage, double done) {
  if (interrupted())
    throw Error(Errc::cancelled, "stopped by Ctrl-C", state_.verb,
                "everything is as it was before; run the command again to do it");
  if (!painter_.joinable()) return;
  const std::lock_guard lock(mutex_);
  if (stage != state_.stage) {
    state_.stage = stage;
    stage_begin_ = Clock::now();
  }
  state_.done = done;
}

void ProgressBar::draw_until_stopped() {
  std::unique_lock lock(mutex_);
  bool drawn = false;
  for (auto wait = kFirstLine; !stop_.wait_for(lock, wait, [this] { return stopped_; }); wait = kBetweenLines) {
    draw();
    drawn = true;
  }
  if (drawn) std::fputs(kWipeLine, stderr);
}

void ProgressBar::draw() {
  state_.stage_seconds = std::chrono::duration<double>(Clock::now() - stage_begin_).count();
  ProgressState shown = state_;
  if (interrupted()) shown.stage = "stopping";
  std::fputs((kWipeLine + progress_line(shown, usable_columns())).c_str(), stderr);
}

}  // namespace ramcdb::cli
