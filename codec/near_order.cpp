#include "codec/near_order.h"

#include <algorithm>
#include <array>
#include <limits>

namespace ramcdb::codec {

namespace {

/// So many of the points that are left, in the order of a space-filling curve, are looked at for the nearest one.
constexpr std::size_t kReach = 256;

/// Less along the curve by Z. Coordinates differ first where their highest different bit is.
bool less_by_z(LatticePoint p, LatticePoint q) {
  int axis = 0;
  std::uint32_t most = 0;
  for (int a = 0; a < 3; ++a) {
    const std::uint32_t differ = static_cast<std::uint32_t>(p[a]) ^ static_cast<std::uint32_t>(q[a]);
    if (most < differ && most < (most ^ differ)) {
      most = differ;
      axis = a;
    }
  }
  return p[axis] < q[axis];
}

double distance(LatticePoint p, LatticePoint q) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double way = static_cast<double>(p[a]) - q[a];
    sum += way * way;
  }
  return sum;
}

}  // namespace

std::vector<std::uint32_t> near_order(std::span<const LatticePoint> points, std::vector<std::uint32_t> chosen) {
  std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t i, std::uint32_t j) {
    return points[i] != points[j] ? less_by_z(points[i], points[j]) : i < j;
  });
  // The nearest of the next ones goes first; those that it passes keep their order.
  for (std::size_t at = 1; at < chosen.size(); ++at) {
    const std::size_t end = std::min(chosen.size(), at + kReach);
    std::size_t best = at;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = at; i < end; ++i) {
      const double way = distance(points[chosen[i]], points[chosen[at - 1]]);
      if (way < least) {
        least = way;
        best = i;
      }
    }
    std::rotate(chosen.begin() + static_cast<std::ptrdiff_t>(at), chosen.begin() + static_cast<std::ptrdiff_t>(best),
                chosen.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }
  return chosen;
}

}  // namespace ramcdb::codec
