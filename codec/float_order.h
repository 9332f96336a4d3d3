#pragma once

#include <bit>
#include <cstdint>

#include "ramcdb/attributes.h"

/// Floating-point numbers as whole numbers that count upwards with them: neighbours differ by one, -0 comes right
/// before +0. The bits of a positive number with the sign set; those of a negative one all turned over.
namespace ramcdb::codec {

namespace float_order_detail {

template <class Float, class Bits>
std::uint64_t to_order(double number) {
  const auto bits = std::bit_cast<Bits>(static_cast<Float>(number));
  constexpr Bits kSign = Bits{1} << (8 * sizeof(Bits) - 1);
  return bits & kSign ? static_cast<Bits>(~bits) : static_cast<Bits>(bits | kSign);
}

template <class Float, class Bits>
double from_order(std::uint64_t number) {
  const auto bits = static_cast<Bits>(number);
  constexpr Bits kSign = Bits{1} << (8 * sizeof(Bits) - 1);
  return static_cast<double>(std::bit_cast<Float>(static_cast<Bits>(bits & kSign ? bits ^ kSign : ~bits)));
}

}  // namespace float_order_detail

/// `type` is float32 or float64; numbers are rounded to float32 first where it is that.
[[nodiscard]] inline std::uint64_t float_order(double number, NumberType type) {
  return type == NumberType::float32 ? float_order_detail::to_order<float, std::uint32_t>(number)
                                     : float_order_detail::to_order<double, std::uint64_t>(number);
}
[[nodiscard]] inline double from_float_order(std::uint64_t order, NumberType type) {
  return type == NumberType::float32 ? float_order_detail::from_order<float, std::uint32_t>(order)
                                     : float_order_detail::from_order<double, std::uint64_t>(order);
}

}  // namespace ramcdb::codec
