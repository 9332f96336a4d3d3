#include "api/welded_surface.h"

#include <utility>

#include "api/point_numbers.h"

namespace ramcdb::detail {
namespace {

/// Nodes of places become nodes of places with equal ids.
void tell_apart(const Surface& surface, std::span<const std::uint32_t> ids, WeldedSurface& welded) {
  const std::vector<std::uint32_t> place = std::move(welded.node);
  std::vector<std::uint64_t> keys(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) keys[v] = hash_of(place[v], ids[v]);
  const HashIndex index(std::move(keys));
  welded.node.clear();
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    std::uint32_t first = index.first(hash_of(place[v], ids[v]));
    while (place[first] != place[v] || ids[first] != ids[v]) first = index.after(first);
    welded.node.push_back(first == v ? static_cast<std::uint32_t>(welded.points.size()) : welded.node[first]);
    if (first == v) welded.points.push_back(surface.points[v]);
  }
}

}  // namespace

WeldedSurface weld_by_place(const Surface& surface, std::span<const std::uint32_t> ids) {
  WeldedSurface welded;
  welded.firsts = surface.firsts;
  PointNumbers numbers(surface.points.size());
  welded.node = numbers.number(surface.points);
  if (ids.empty())
    welded.points = numbers.points();
  else
    tell_apart(surface, ids, welded);
  welded.corners.reserve(surface.corners.size());
  for (const std::uint32_t v : surface.corners) welded.corners.push_back(welded.node[v]);
  return welded;
}

}  // namespace ramcdb::detail
