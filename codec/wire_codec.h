#pragma once

#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// Codes the inner points of a wire; its two ends are corners, known from the wire-net. A wire without inner points
/// codes to no bytes at all, and is not to be stored. Equal input gives equal bytes on every machine.
[[nodiscard]] Buffer encode_wire(const Wire& wire);

/// \param inner_points as the wire-net says; the blob must hold just so many. Throws corrupt otherwise.
[[nodiscard]] Wire decode_wire(Bytes blob, LatticePoint begin, LatticePoint end, std::uint32_t inner_points);

}  // namespace ramcdb::codec
