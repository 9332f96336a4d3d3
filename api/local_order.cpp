#include "api/local_order.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace ramcdb::detail {
namespace {

/// The lower 21 bits with two zeros before each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Vertices along Morton's curve.
std::vector<std::uint32_t> along_curve(std::span<const LatticePoint> points) {
  LatticeBox box;
  for (const LatticePoint p : points) box.add(p);
  std::uint32_t extent = 0;
  for (int a = 0; a < 3; ++a) extent = std::max(extent, static_cast<std::uint32_t>(box.hi[a] - box.lo[a]));
  const int shift = std::max(0, static_cast<int>(std::bit_width(extent)) - 21);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    std::uint64_t key = 0;
    for (int a = 0; a < 3; ++a) key |= spread(static_cast<std::uint32_t>(points[v][a] - box.lo[a]) >> shift) << a;
    keys.emplace_back(key, v);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  for (const auto& [key, v] : keys) order.push_back(v);
  return order;
}

/// Faces by their first vertex in an order, by counting.
std::vector<std::uint32_t> faces_along(const Surface& s, const std::vector<std::uint32_t>& rank) {
  std::vector<std::uint32_t> least(s.face_count()), ends(s.points.size() + 1, 0), order(s.face_count());
  for (std::uint32_t f = 0; f < least.size(); ++f) {
    least[f] = ~0U;
    for (const std::uint32_t v : s.vertices(f)) least[f] = std::min(least[f], rank[v]);
    ++ends[least[f] + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  for (std::uint32_t f = 0; f < least.size(); ++f) order[ends[least[f]]++] = f;
  return order;
}

}  // namespace

bool is_scattered(const Surface& surface) {
  constexpr std::size_t kInCaches = 20'000;
  if (surface.points.size() < kInCaches) return false;
  std::uint64_t far = 0;
  for (std::uint32_t f = 0; f < surface.face_count(); ++f) {
    const auto [lo, hi] = std::ranges::minmax(surface.vertices(f));
    far += hi - lo > surface.points.size() / 8;
  }
  return far * 4 > surface.face_count();
}

LocalOrder in_local_order(const Surface& surface) {
  LocalOrder order;
  order.vertex = along_curve(surface.points);
  std::vector<std::uint32_t> rank(order.vertex.size());
  for (std::uint32_t i = 0; i < rank.size(); ++i) rank[order.vertex[i]] = i;
  order.face = faces_along(surface, rank);
  for (const std::uint32_t v : order.vertex) order.points.push_back(surface.points[v]);
  order.corners.reserve(surface.corners.size());
  order.firsts.push_back(0);
  for (const std::uint32_t f : order.face) {
    for (const std::uint32_t v : surface.vertices(f)) order.corners.push_back(rank[v]);
    order.firsts.push_back(static_cast<std::uint32_t>(order.corners.size()));
  }
  return order;
}

}  // namespace ramcdb::detail
