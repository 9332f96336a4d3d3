#include "api/match_state.h"

#include <algorithm>

#include "api/point_numbers.h"

namespace ramcdb::detail {
namespace {

std::uint64_t hash_of(std::span<const std::uint32_t> cycle) {
  return hash_of_cycle(static_cast<std::uint32_t>(cycle.size()), [&](std::uint32_t i) { return cycle[i]; });
}

std::vector<std::uint64_t> keys_of_faces(const Surface& s) {
  std::vector<std::uint64_t> keys(s.face_count());
  for (std::uint32_t f = 0; f < keys.size(); ++f) keys[f] = hash_of(s.vertices(f));
  return keys;
}

/// Whether corner i of a cycle is corner (i + turn) % size of a face.
bool is_turned(std::span<const std::uint32_t> face, std::uint32_t turn, std::span<const std::uint32_t> cycle) {
  std::size_t at = turn;
  for (const std::uint32_t v : cycle) {
    if (face[at] != v) return false;
    if (++at == face.size()) at = 0;
  }
  return true;
}

}  // namespace

Places::Places(const Surface& from_surface, const Rings& from_rings, const Surface& to_surface, const Rings& to_rings) {
  PointNumbers numbers(from_surface.points.size() + to_surface.points.size());
  from = numbers.number(from_surface.points);
  to = numbers.number(to_surface.points);
  const auto count = [&](const Rings& rings, const std::vector<std::uint32_t>& places, auto& counts, auto& firsts) {
    counts.assign(numbers.points().size(), 0);
    firsts.assign(numbers.points().size(), kNowhere);
    for (std::uint32_t v = 0; v < places.size(); ++v)
      if (rings.degree(v) && counts[places[v]]++ == 0) firsts[places[v]] = v;
  };
  count(from_rings, from, count_from, first_from);
  count(to_rings, to, count_to, first_to);
}

FaceMatch FaceFinder::find(std::span<const std::uint32_t> cycle) {
  const auto least = static_cast<std::uint32_t>(
      std::ranges::min_element(cycle, {}, [&](std::uint32_t v) { return rings_.degree(v); }) - cycle.begin());
  constexpr std::uint32_t kMany = 200;
  const auto size = static_cast<std::uint32_t>(cycle.size());
  if (rings_.degree(cycle[least]) > kMany) {
    if (!index_) index_.emplace(keys_of_faces(surface_));
    std::uint32_t f = index_->first(hash_of(cycle));
    while (f != kNowhere && turned(f, cycle).face == FaceMatch::kNone) f = index_->after(f);
    return f == kNowhere ? FaceMatch{} : turned(f, cycle);
  }
  for (const std::uint32_t c : rings_.of(cycle[least])) {
    const std::uint32_t f = rings_.face(c);
    if (taken_[f] || surface_.size(f) != size) continue;
    const std::uint32_t turn = (c - surface_.firsts[f] + size - least) % size;
    if (is_turned(surface_.vertices(f), turn, cycle)) return {f, turn};
  }
  return {};
}

FaceMatch FaceFinder::take(std::span<const std::uint32_t> cycle) {
  const FaceMatch match = find(cycle);
  if (match.face == FaceMatch::kNone) return match;
  taken_[match.face] = true;
  if (index_) (void)index_->take(hash_of(cycle), ~0U, [&](std::uint32_t f) { return f == match.face; });
  return match;
}

FaceMatch FaceFinder::turned(std::uint32_t face, std::span<const std::uint32_t> cycle) const {
  const auto vertices = surface_.vertices(face);
  for (std::uint32_t turn = 0; vertices.size() == cycle.size() && turn < cycle.size(); ++turn)
    if (is_turned(vertices, turn, cycle)) return {face, turn};
  return {};
}

MatchState::MatchState(const Surface& from_surface, const Surface& to_surface)
    : from(from_surface),
      to(to_surface),
      from_rings(from),
      to_rings(to),
      places(from, from_rings, to, to_rings),
      faces(from, from_rings),
      pairs(from.points.size(), to.points.size()) {}

bool MatchState::known_cycle(std::uint32_t face, std::vector<std::uint32_t>& cycle) const {
  cycle.clear();
  for (const std::uint32_t w : to.vertices(face)) {
    if (pairs.from(w) == kNowhere) return false;
    cycle.push_back(pairs.from(w));
  }
  return true;
}

}  // namespace ramcdb::detail
