#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ramcdb::chartify {

/// A priority queue of faces that charts want, for keys that never fall behind the last popped one by more than the
/// ring.
class BucketQueue {
 public:
  static constexpr std::size_t kBuckets = 1024;  // more than any step, so that the ring never laps itself

  struct Entry {
    std::uint32_t face, chart;
  };

  void push(std::uint64_t key, Entry entry) {
    ring_[key % kBuckets].push_back(entry);
    ++size_;
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Replaces `entries` by those of the least key, in the order in which they were pushed. REQUIRES: not empty
  std::uint64_t pop_all(std::vector<Entry>& entries) {
    while (ring_[key_ % kBuckets].empty()) ++key_;
    entries.clear();
    entries.swap(ring_[key_ % kBuckets]);
    size_ -= entries.size();
    return key_;
  }

 private:
  std::array<std::vector<Entry>, kBuckets> ring_;
  std::uint64_t key_ = 0;
  std::size_t size_ = 0;
};

}  // namespace ramcdb::chartify
