#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "ramcdb/attributes.h"
#include "ramcdb/geometry.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Positions in memory or on disk, which can be gone through again and again.
struct PositionSource {
  std::uint64_t count = 0;
  /// Calls its argument with all of them, some at a time, until it returns false.
  std::function<void(const std::function<bool(std::span<const Point>)>&)> walk;

  /// Those must outlive the source.
  [[nodiscard]] static PositionSource of(std::span<const Point> positions);
};

/// float32 when all coordinates are such numbers, else float64.
[[nodiscard]] NumberType type_of(std::span<const Point> positions);
/// The number as it is after it was kept as this type: float32 or float64.
[[nodiscard]] inline double as_type(double number, NumberType type) {
  return type == NumberType::float32 ? static_cast<double>(static_cast<float>(number)) : number;
}

/// The lattice that import options ask for.
///
/// - the one that is given;
/// - of a number of bits: step = largest extent / (2^bits - 1), origin at the low corner of the mesh's box;
/// - of a precision: step = 2 * precision, or a round number, see ImportOptions::precision;
/// - lossless: the round step that makes the mesh smallest, tried on a sample: one of which all coordinates are
///   multiples, or most; or 2^k about as wide as the gaps between the larger ones of these numbers, where what is finer
///   is noise.
///
/// \param type of the positions. Throws invalid_argument for options out of range, limit_exceeded when the mesh does
/// not fit the lattice.
[[nodiscard]] Lattice choose_lattice(const PositionSource& positions, NumberType type, const ImportOptions& options);

}  // namespace ramcdb::detail
