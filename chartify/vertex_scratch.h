#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ramcdb::chartify {

/// Values of some vertices of a large mesh, all of which are forgotten at once. Takes memory by their number.
template <class Value>
class VertexScratch {
 public:
  void clear() {
    ++age_;
    size_ = 0;
  }

  /// A new value where there is none. Valid until the next call.
  Value& operator[](std::uint32_t vertex) {
    if (2 * size_ >= slots_.size()) grow();
    Slot& slot = slots_[place_of(vertex)];
    if (slot.age != age_) {
      slot = {vertex, age_, {}};
      ++size_;
    }
    return slot.value;
  }

  /// nullptr where there is none.
  [[nodiscard]] const Value* find(std::uint32_t vertex) const {
    if (slots_.empty()) return nullptr;
    const Slot& slot = slots_[place_of(vertex)];
    return slot.age == age_ ? &slot.value : nullptr;
  }

 private:
  struct Slot {
    std::uint32_t vertex = 0;
    std::uint32_t age = 0;  ///< of other ages: free
    Value value{};
  };

  /// Its slot, or the free one that it would get.
  [[nodiscard]] std::size_t place_of(std::uint32_t vertex) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = vertex * std::uint64_t{0x9e3779b97f4a7c15} >> 32 & mask;
    while (slots_[at].age == age_ && slots_[at].vertex != vertex) at = (at + 1) & mask;
    return at;
  }

  void grow() {
    constexpr std::size_t kFirst = 1024;
    std::vector<Slot> old(slots_.empty() ? kFirst : 2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.age == age_) slots_[place_of(slot.vertex)] = slot;
  }

  std::vector<Slot> slots_;  ///< a power of 2
  std::size_t size_ = 0;
  std::uint32_t age_ = 1;
};

}  // namespace ramcdb::chartify
