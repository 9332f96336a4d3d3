#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ramcdb/attributes.h"
#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// Equal to the last bit: -0 is not 0.
[[nodiscard]] inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
[[nodiscard]] inline bool same_bits(const Point& a, const Point& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

/// Whether two vertices, corners or faces have the same values of all attributes of such; an absent value (NaN) is as
/// any other that is absent. REQUIRES: the attributes of both are the same ones
[[nodiscard]] inline bool same_values(AttributeOf of, std::span<const Attribute> a, std::size_t at,
                                      std::span<const Attribute> b, std::size_t there) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    const std::size_t components = b[i].info.components;
    for (std::size_t k = 0; b[i].info.of == of && k < components; ++k) {
      const double x = a[i].values[at * components + k], y = b[i].values[there * components + k];
      if (!same_bits(x, y) && !(std::isnan(x) && std::isnan(y))) return false;
    }
  }
  return true;
}

}  // namespace ramcdb::detail
