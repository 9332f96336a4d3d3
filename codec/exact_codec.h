#pragma once

#include <span>
#include <vector>

#include "ramcdb/attributes.h"
#include "ramcdb/bytes.h"
#include "ramcdb/geometry.h"

/// Positions to the last bit, beside a lattice that is coarser: which of the floating-point numbers that snap to a
/// lattice coordinate each coordinate is. Where a lattice step holds one such number, or all coordinates are lattice
/// coordinates, that costs nothing. Decimal fractions cost the decimals that they have beyond those of a decimal
/// lattice; all else is mostly noise, which no prediction would make smaller.
namespace ramcdb::codec {

/// About how many bits a position costs beside its lattice point; 0 when that is all.
[[nodiscard]] unsigned exact_bits(const Point& p, const Lattice& lattice, NumberType type);

/// `exact` are positions that snap to `points`, their coordinates numbers of `type`: float32 or float64. Decoded again
/// and compared before it is returned. Throws invalid_argument when a coordinate is not of the type, or does not snap
/// to its point.
[[nodiscard]] Buffer encode_exact(std::span<const Point> exact, std::span<const LatticePoint> points,
                                  const Lattice& lattice, NumberType type);

/// Bytes may be hostile; what comes back snaps to `points`. Throws corrupt, also when points, lattice or type are not
/// those of the encoder (with high probability: a check of the coordinates is in the blob).
[[nodiscard]] std::vector<Point> decode_exact(Bytes blob, std::span<const LatticePoint> points, const Lattice& lattice,
                                              NumberType type);

}  // namespace ramcdb::codec
