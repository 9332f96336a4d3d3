#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ramcdb::chartify {

/// A priority queue of faces that charts want, for keys that never fall behind the last popped one by more than the
/// ring; last in, first out among equal keys.
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
  Entry pop(std::uint64_t& key) {
    while (ring_[key_ % kBuckets].empty()) ++key_;
    key = key_;
    std::vector<Entry>& bucket = ring_[key_ % kBuckets];
    const Entry entry = bucket.back();
    bucket.pop_back();
    --size_;
    return entry;
  }

 private:
  std::array<std::vector<Entry>, kBuckets> ring_;
  std::uint64_t key_ = 0;
  std::size_t size_ = 0;
};

}  // namespace ramcdb::chartify
