#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "api/hash_index.h"
#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// Numbers points in the order in which they first come.
class PointNumbers {
 public:
  /// \param expected how many points may come, equal ones counted each time; more are fine
  explicit PointNumbers(std::size_t expected) : slots_(std::bit_ceil(expected / 2 + 8), kFree) {}

  std::vector<std::uint32_t> number(std::span<const LatticePoint> points) {
    // Most of the time goes into waiting for memory: it is asked for some points ahead.
    constexpr std::size_t kAhead = 16;
    std::vector<std::uint32_t> numbers(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i + kAhead < points.size()) __builtin_prefetch(&slots_[home(points[i + kAhead])]);
      numbers[i] = number(points[i]);
    }
    return numbers;
  }
  std::uint32_t number(LatticePoint p) {
    std::size_t slot = home(p);
    while (slots_[slot] != kFree && points_[slots_[slot]] != p) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] != kFree) return slots_[slot];
    const auto number = static_cast<std::uint32_t>(points_.size());
    slots_[slot] = number;
    points_.push_back(p);
    if (2 * points_.size() > slots_.size()) grow();
    return number;
  }
  /// By number.
  [[nodiscard]] const std::vector<LatticePoint>& points() const { return points_; }

 private:
  [[nodiscard]] std::size_t home(LatticePoint p) const {
    const auto bits = [](std::int32_t x) { return std::uint64_t{static_cast<std::uint32_t>(x)}; };
    return hash_of((bits(p.x) << 32) | bits(p.y), bits(p.z)) & (slots_.size() - 1);
  }
  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      std::size_t slot = home(points_[i]);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }

  static constexpr std::uint32_t kFree = ~std::uint32_t{0};
  std::vector<std::uint32_t> slots_;
  std::vector<LatticePoint> points_;
};

}  // namespace ramcdb::detail
