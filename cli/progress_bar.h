#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "cli/progress_line.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {

/// Accompanies long work: shows on standard error how far it is, where that is a terminal and the user did not ask for
/// quiet, and ends the work on Ctrl-C. The line is drawn by a thread of its own, so that it also appears and its time
/// also runs while the work reports nothing; it is wiped when the work is over.
class ProgressBar {
 public:
  /// `total_bytes` is for the rate: what the work goes through, 0 where it is not known.
  ProgressBar(std::string_view verb, bool quiet, double total_bytes = 0);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// For the library; it throws cancelled after Ctrl-C. It lives no longer than the bar.
  [[nodiscard]] Progress callback();

 private:
  using Clock = std::chrono::steady_clock;

  void report(std::string_view stage, double done);
  void draw_until_stopped();
  void draw();

  std::mutex mutex_;  ///< guards state_, stage_begin_ and stopped_
  ProgressState state_;
  Clock::time_point stage_begin_ = Clock::now();
  bool stopped_ = false;
  std::condition_variable stop_;
  std::thread painter_;  ///< only with a terminal
};

}  // namespace ramcdb::cli
