#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/built_in_prior.h"
#include "codec/range_coder.h"
#include "ramcdb/error.h"

/// What the dense coder learns while it codes a chart: one adaptive bit per decision and context. Every chart starts
/// from the same state, so that it opens alone.
namespace ramcdb::codec {

/// A bit's beginning, as the built-in prior says it: the probability of a one in 1/8192, and in the lowest three bits
/// how many earlier bits it stands for, one of kPriorBits.
inline constexpr std::array<std::uint16_t, 8> kPriorBits{0, 2, 5, 10, 20, 40, 80, 120};
inline AdaptiveBit built_in_bit(std::uint16_t prior) {
  return {static_cast<std::uint16_t>(prior & 0xfff8), kPriorBits[prior & 7]};
}

/// How many edges a pivot has inside its open corner: unary, by the corner's angle and the faces the pivot has already.
class FanSizeModel {
 public:
  /// Calls `visit` with every bit that has a built-in beginning, in a fixed order.
  template <class Visit>
  void visit_built_in(Visit&& visit) {
    for (auto& row : bits_)
      for (auto& bits : row)
        for (std::size_t i = 0; i < 6; ++i) visit(bits[i]);
  }

  /// \param angle in quadrants \param faces of the pivot \param max the largest size that can be meant
  template <class Coder>
  std::uint32_t code(Coder& coder, float angle, std::uint32_t faces, bool on_border, std::size_t max,
                     std::uint32_t size) {
    const auto angle_class = std::min<std::size_t>(39, static_cast<std::size_t>(10 * angle));
    auto& bits = bits_[angle_class][on_border ? 9 : std::min<std::size_t>(8, faces)];
    std::uint32_t n = 0;
    while (coder.code(bits[std::min<std::size_t>(15, n)], size > n)) {
      if (++n > max) throw Error(Errc::corrupt, "a chart has more faces than it declares");
    }
    return n;
  }

 private:
  std::array<std::array<std::array<AdaptiveBit, 16>, 10>, 40> bits_;
};

/// How far a coordinate is from its prediction, in one context: zero?, sign, exponent in unary, two more bits of the
/// magnitude, the rest raw. The rounded-off fraction of the prediction tells which neighbour is the likelier.
class MissModel {
 public:
  template <class Visit>
  void visit_built_in(Visit&& visit) {
    for (AdaptiveBit& bit : nonzero_) visit(bit);
    for (AdaptiveBit& bit : negative_) visit(bit);
    for (std::size_t i = 0; i < 12; ++i) visit(exponent_[i]);
    for (std::size_t i = 1; i < 7; ++i) visit(second_[i]);
  }

  /// \param fraction prediction less its rounded value, in [-1/2, 1/2]
  template <class Coder>
  std::int32_t code(Coder& coder, float fraction, std::int32_t miss) {
    const float size = fraction < 0 ? -fraction : fraction;
    const std::size_t third = std::size_t{size >= 0.17F} + std::size_t{size >= 0.33F};
    if (!coder.code(nonzero_[third], miss != 0)) return 0;
    const bool flip = fraction < 0;
    const bool negative = coder.code(negative_[third], (miss < 0) != flip) != flip;

    const std::uint32_t wanted = miss < 0 ? 0u - static_cast<std::uint32_t>(miss) : static_cast<std::uint32_t>(miss);
    const int wanted_exponent = static_cast<int>(std::bit_width(wanted)) - 1;
    int exponent = 0;
    while (exponent < 31 &&
           coder.code(exponent_[static_cast<std::size_t>(std::min(15, exponent))], wanted_exponent > exponent))
      ++exponent;

    std::uint32_t magnitude = 1;
    int left = exponent;
    const auto cap = static_cast<std::size_t>(std::min(15, exponent));
    if (left > 0) {
      magnitude = 2 | static_cast<std::uint32_t>(coder.code(second_[cap], (wanted >> --left) & 1));
      if (left > 0) {
        auto& bit = third_[2 * cap + (magnitude & 1)];
        magnitude = magnitude << 1 | static_cast<std::uint32_t>(coder.code(bit, (wanted >> --left) & 1));
      }
    }
    magnitude = magnitude << left | coder.code_raw(wanted & ((1u << left) - 1), left);
    return static_cast<std::int32_t>(negative ? 0u - magnitude : magnitude);
  }

 private:
  std::array<AdaptiveBit, 3> nonzero_;
  std::array<AdaptiveBit, 3> negative_;
  std::array<AdaptiveBit, 16> exponent_;
  std::array<AdaptiveBit, 16> second_;
  std::array<AdaptiveBit, 32> third_;
};

/// All of a chart's models.
struct DenseModels {
  static constexpr int kActivities = 16;
  static constexpr int kEdgeSizes = 10;

  FanSizeModel fan_size;
  std::array<std::array<AdaptiveBit, 16>, 4> join;  ///< by edges left at the pivot, by size of the front
  AdaptiveUnsigned join_rank;
  std::array<AdaptiveSigned, 3> seed;      ///< corners of a closed component, by axis
  std::array<AdaptiveSigned, 3> isolated;  ///< vertices without faces, by axis
  /// Whether a coordinate is the i-th candidate, by axis and where the two before were found.
  std::array<std::array<std::array<std::array<AdaptiveBit, 4>, 5>, 5>, 3> aligned;
  std::array<MissModel, 3 * kActivities * kEdgeSizes> misses;

  /// Begins with what is built in: for fine lattices, whose misses have many bits, and for others.
  static const DenseModels& built_in(bool is_fine) {
    static const std::array<DenseModels, 2> both{DenseModels(kBuiltInPrior[0]), DenseModels(kBuiltInPrior[1])};
    return both[is_fine];
  }

  template <class Visit>
  void visit_built_in(Visit&& visit) {
    fan_size.visit_built_in(visit);
    for (auto& bits : join)
      for (AdaptiveBit& bit : bits) visit(bit);
    for (MissModel& model : misses) model.visit_built_in(visit);
  }

  /// \param kind 0, 1: first and second tangential axis, 2: the axis along the normal
  MissModel& miss(int kind, int activity, int edge_size) {
    return misses[static_cast<std::size_t>((kind * kActivities + activity) * kEdgeSizes + edge_size)];
  }

 private:
  template <class Prior>
  explicit DenseModels(const Prior& prior) {
    const std::uint16_t* next = prior.data();
    visit_built_in([&](AdaptiveBit& bit) { bit = built_in_bit(*next++); });
  }
};

}  // namespace ramcdb::codec
