#pragma once

#include <array>
#include <cstdint>

#include "codec/fast_tables.h"
#include "ramcdb/bytes.h"

namespace ramcdb::codec {

/// Weights of one class of the fan predictor, in 1/128: how much of the six vectors around a pivot makes up the way to
/// a new vertex (codec/dense_predictor.h names the vectors and classes).
using FanWeights = std::array<std::int16_t, 6>;
/// Weights of one class of the plane stage, in 1/128: how much three tangent planes move the last coordinate.
using PlaneWeights = std::array<std::int16_t, 3>;

inline constexpr std::size_t kFanClasses = 96;
inline constexpr std::size_t kPlaneClasses = 16;

/// Coder tables of one mesh: predictor weights that the dense chart coder starts from. They are trained once, at
/// import, stored as a blob of their own, and named by every chart that was coded with them. Only sizes depend on their
/// values: any table codes any chart. A new one is the built-in table (TableId 0), which is part of the format.
struct CoderTables {
  std::array<FanWeights, kFanClasses> fan;
  std::array<PlaneWeights, kPlaneClasses> plane;
  FastTables fast;

  CoderTables();
  friend bool operator==(const CoderTables&, const CoderTables&) = default;
};

/// The table as a blob; classes with the built-in weights take one bit. Throws invalid_argument for weights beyond
/// +-kMaxWeight.
[[nodiscard]] Buffer encode_tables(const CoderTables& tables);

/// Throws corrupt for bytes that encode_tables did not write, unsupported_version for a newer format.
[[nodiscard]] CoderTables decode_tables(Bytes blob);

/// Weights beyond this (128 times an edge) say nothing about a surface, only about a damaged blob.
inline constexpr int kMaxWeight = 1 << 14;

}  // namespace ramcdb::codec
