#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ramcdb::benchmark {

/// Wall-clock seconds that `work` takes.
inline double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// CPU time that this process, or its children that ended, have used: user and system, seconds.
inline double cpu_seconds(int who = RUSAGE_SELF) {
  rusage used{};
  getrusage(who, &used);
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(used.ru_utime) + of(used.ru_stime);
}

/// CPU time of this process by the stage that an operation says it is at, as it tells its progress; and how long it
/// said nothing at most: in between it cannot be cancelled.
class StageClock {
 public:
  /// What is used until the first stage is counted as this one's.
  explicit StageClock(std::string first) : stage_(std::move(first)) {}

  /// Valid as long as this is.
  [[nodiscard]] std::function<void(std::string_view, double)> callback() {
    return [this](std::string_view stage, double) {
      hear();
      if (stage != stage_) begin(std::string(stage));
    };
  }
  void begin(std::string stage) {
    hear();
    const double now = cpu_seconds();
    seconds_[stage_] += now - since_;
    since_ = now;
    stage_ = std::move(stage);
  }
  [[nodiscard]] double seconds(const std::string& stage) const {
    const auto it = seconds_.find(stage);
    return it == seconds_.end() ? 0 : it->second;
  }

  /// Wall-clock seconds.
  [[nodiscard]] double longest_silence() const { return longest_silence_; }

 private:
  using Clock = std::chrono::steady_clock;

  void hear() {
    const auto now = Clock::now();
    longest_silence_ = std::max(longest_silence_, std::chrono::duration<double>(now - heard_).count());
    heard_ = now;
  }

  std::string stage_;
  Clock::time_point heard_ = Clock::now();
  double longest_silence_ = 0;
  double since_ = cpu_seconds();
  std::map<std::string, double> seconds_;
};

/// REQUIRES: not empty.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ramcdb::benchmark
