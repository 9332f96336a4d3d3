#pragma once

#include <functional>

namespace ramcdb::chartify {

/// Gets the share of a piece of work that is done, 0 .. 1, on the calling thread; may throw to cancel. Empty where
/// nobody asks.
using Progress = std::function<void(double done)>;

inline void report(const Progress& progress, double done) {
  if (progress) progress(done);
}

/// For a part of a piece of work, which goes from one share of it to another. `whole` must outlive it.
[[nodiscard]] inline Progress part_of(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double done) { whole(from + (to - from) * done); };
}

}  // namespace ramcdb::chartify
