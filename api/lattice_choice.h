#pragma once

#include <span>

#include "ramcdb/geometry.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// The lattice that import options ask for: step = largest extent / (2^bits - 1) over the mesh's box, or 2 * precision,
/// origin at the box's low corner; or the one that is given. Throws invalid_argument for options out of range,
/// limit_exceeded when the mesh does not fit the lattice.
[[nodiscard]] Lattice choose_lattice(std::span<const Point> positions, const ImportOptions& options);

}  // namespace ramcdb::detail
