#include "api/lattice_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ramcdb/error.h"

namespace ramcdb::detail {

Lattice choose_lattice(std::span<const Point> positions, const ImportOptions& options) {
  if (options.lattice) return *options.lattice;
  Point lo = positions.front(), hi = positions.front();
  for (const Point& p : positions)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  if (options.precision != 0) {
    if (!(options.precision > 0) || !std::isfinite(options.precision))
      throw Error(Errc::invalid_argument, fmt::format("precision {} is not a positive number", options.precision), {},
                  "give the largest coordinate error you accept, in model units");
    const Lattice lattice{lo, 2 * options.precision};
    if (extent / lattice.step > kMaxLatticeCoordinate)
      throw Error(Errc::limit_exceeded, fmt::format("precision {:.9g} is too fine", options.precision),
                  fmt::format("largest extent {:.9g}", extent),
                  fmt::format("use {:.9g} or more", extent / kMaxLatticeCoordinate));
    return lattice;
  }
  if (options.bits < 1 || options.bits > 30)
    throw Error(Errc::invalid_argument, fmt::format("{} bits are out of range", options.bits), {}, "use 1 to 30");
  // A mesh without extent still needs a step: any will do, all of it is one lattice point.
  if (extent == 0) return {lo, 1.0};
  return {lo, extent / static_cast<double>((1U << options.bits) - 1)};
}

}  // namespace ramcdb::detail
