#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ramcdb::detail {

/// Spreads every bit of a number over all bits (the end of SplitMix64).
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9;
  x ^= x >> 27;
  x *= 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Hash of two numbers in order; never 0.
[[nodiscard]] constexpr std::uint64_t hash_of(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t h = mixed(a * 0x9e3779b97f4a7c15 + mixed(b + 0x632be59bd9b4e019));
  return h ? h : 1;
}

/// Hash of a sequence that may begin anywhere: the same for all its turns; never 0.
template <class Value>
[[nodiscard]] std::uint64_t hash_of_cycle(std::uint32_t size, Value&& value) {
  std::uint64_t sum = size;
  for (std::uint32_t i = 0; i < size; ++i) sum += hash_of(value(i), value(i + 1 == size ? 0 : i + 1));
  return sum ? sum : 1;
}

/// Finds things by 64-bit keys, in flat arrays: equal keys in ascending order.
class HashIndex {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Item i has key i; items with key 0 are left out.
  explicit HashIndex(std::vector<std::uint64_t> keys)
      : keys_(std::move(keys)), heads_(std::bit_ceil(keys_.size() + 1), kNone), next_(keys_.size(), kNone) {
    for (auto i = static_cast<std::uint32_t>(keys_.size()); i-- > 0;) {
      if (!keys_[i]) continue;
      std::uint32_t& head = heads_[slot(keys_[i])];
      next_[i] = std::exchange(head, i);
    }
  }

  /// The first item with a key, or kNone.
  [[nodiscard]] std::uint32_t first(std::uint64_t key) const { return same(heads_[slot(key)], key); }
  /// The next item with the same key, or kNone.
  [[nodiscard]] std::uint32_t after(std::uint32_t item) const { return same(next_[item], keys_[item]); }
  /// Takes out the first item with a key that `accept` takes, of the first so many that it is asked for; kNone if none.
  template <class Accept>
  std::uint32_t take(std::uint64_t key, std::uint32_t tries, Accept&& accept) {
    for (std::uint32_t* link = &heads_[slot(key)]; *link != kNone; link = &next_[*link]) {
      if (keys_[*link] != key) continue;
      if (accept(*link)) return std::exchange(*link, next_[*link]);
      if (--tries == 0) break;
    }
    return kNone;
  }

 private:
  [[nodiscard]] std::size_t slot(std::uint64_t key) const { return (key ^ (key >> 32)) & (heads_.size() - 1); }
  [[nodiscard]] std::uint32_t same(std::uint32_t item, std::uint64_t key) const {
    while (item != kNone && keys_[item] != key) item = next_[item];
    return item;
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> heads_, next_;
};

}  // namespace ramcdb::detail
