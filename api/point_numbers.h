#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "api/hash_index.h"
#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// Numbers points in the order in which they first come.
class PointNumbers {
 public:
  /// \param most how many points may come
  explicit PointNumbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), kFree) {}

  std::uint32_t number(LatticePoint p) {
    const auto bits = [](std::int32_t x) { return std::uint64_t{static_cast<std::uint32_t>(x)}; };
    std::size_t slot = hash_of((bits(p.x) << 32) | bits(p.y), bits(p.z)) & (slots_.size() - 1);
    while (slots_[slot] != kFree && points_[slots_[slot]] != p) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == kFree) {
      slots_[slot] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(p);
    }
    return slots_[slot];
  }
  [[nodiscard]] std::size_t count() const { return points_.size(); }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};
  std::vector<std::uint32_t> slots_;
  std::vector<LatticePoint> points_;
};

}  // namespace ramcdb::detail
