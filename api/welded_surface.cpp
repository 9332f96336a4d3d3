#include "api/welded_surface.h"

#include "api/point_numbers.h"

namespace ramcdb::detail {

WeldedSurface weld_by_place(const Surface& surface, std::span<const std::uint32_t> ids) {
  WeldedSurface welded;
  welded.firsts = surface.firsts;
  PointNumbers numbers(surface.points.size());
  std::vector<std::uint32_t> place;
  std::vector<std::uint64_t> keys;
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    place.push_back(numbers.number(surface.points[v]));
    keys.push_back(hash_of(place.back(), ids.empty() ? 0 : ids[v]));
  }
  const HashIndex index(std::move(keys));
  for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
    std::uint32_t first = index.first(hash_of(place[v], ids.empty() ? 0 : ids[v]));
    while (place[first] != place[v] || (!ids.empty() && ids[first] != ids[v])) first = index.after(first);
    welded.node.push_back(first == v ? static_cast<std::uint32_t>(welded.points.size()) : welded.node[first]);
    if (first == v) welded.points.push_back(surface.points[v]);
  }
  for (const std::uint32_t v : surface.corners) welded.corners.push_back(welded.node[v]);
  return welded;
}

}  // namespace ramcdb::detail
