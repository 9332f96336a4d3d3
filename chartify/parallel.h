#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace ramcdb {

/// Calls work(i) for i = 0 .. count - 1 on up to `threads` threads. `progress`, when given, gets the share that is
/// done, on the calling thread. The first exception of any of them ends the rest and is thrown here.
inline void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work,
                         const std::function<void(double)>& progress = {}) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto guarded = [&](auto&& step) {
    try {
      step();
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };
  const auto drain = [&](bool reports) {
    for (std::size_t i; !stop && (i = next++) < count;) {
      guarded([&] { work(i); });
      if (reports && progress) guarded([&] { progress(static_cast<double>(i) / static_cast<double>(count)); });
    }
  };
  {
    std::vector<std::jthread> helpers;
    const std::size_t extra = std::min<std::size_t>(threads > 1 ? threads - 1 : 0, count > 1 ? count - 1 : 0);
    for (std::size_t t = 0; t < extra; ++t) helpers.emplace_back([&] { drain(false); });
    drain(true);
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls work(begin, end) for ranges that together are 0 .. count - 1, on up to `threads` threads. They are the same
/// for any number of threads. `progress` as in parallel_for.
inline void parallel_ranges(std::size_t count, unsigned threads,
                            const std::function<void(std::size_t begin, std::size_t end)>& work,
                            const std::function<void(double)>& progress = {}) {
  constexpr std::size_t kRange = 1 << 16;
  parallel_for((count + kRange - 1) / kRange, threads,
               [&](std::size_t i) { work(i * kRange, std::min(count, (i + 1) * kRange)); }, progress);
}

/// Calls take(i, work(i)) for i = 0 .. count - 1 in this order, on the calling thread; `work` runs on up to `threads`
/// threads, for up to `held` numbers at a time. `progress` as in parallel_for: the share for which work has been done.
template <class Work, class Take>
void parallel_in_order(std::size_t count, std::size_t held, unsigned threads, Work&& work, Take&& take,
                       const std::function<void(double)>& progress) {
  using Result = std::invoke_result_t<Work, std::size_t>;
  for (std::size_t begin = 0; begin < count; begin += held) {
    std::vector<std::optional<Result>> results(std::min(held, count - begin));
    parallel_for(
        results.size(), threads, [&](std::size_t i) { results[i].emplace(work(begin + i)); },
        [&](double done) {
          progress((static_cast<double>(begin) + done * static_cast<double>(results.size())) /
                   static_cast<double>(count));
        });
    for (std::size_t i = 0; i < results.size(); ++i) {
      take(begin + i, std::move(*results[i]));
      results[i].reset();
    }
  }
}

/// Calls both, `aside` on a thread of its own if there may be two. The first exception of either is thrown.
inline void run_beside(unsigned threads, const std::function<void()>& aside, const std::function<void()>& here) {
  if (threads < 2) {
    aside();
    return here();
  }
  std::exception_ptr failure;
  {
    const std::jthread helper([&] {
      try {
        aside();
      } catch (...) {
        failure = std::current_exception();
      }
    });
    here();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ramcdb
