#include "api/face_matching.h"

#include <algorithm>

#include "api/local_order.h"
#include "api/match_walk.h"
#include "api/vertex_claims.h"

namespace ramcdb::detail {
namespace {

/// Ids may be left over from other vertices, as where a tool sorted these without them: then places tell more.
void pair_by_claims(MatchState& state, std::vector<std::uint32_t> ids) {
  if (!ids.empty()) {
    std::vector<bool> without_id;
    for (const std::uint32_t v : ids) without_id.push_back(v == kNowhere);
    const VertexClaims by_id(state, std::move(ids));
    const std::uint64_t most = std::min(state.from.face_count(), state.to.face_count());
    if (by_id.faces() * 2 >= most || by_id.faces() >= VertexClaims(state, claims_by_place(state)).faces()) {
      if (by_id.faces() > 0 && by_id.faces() * 2 >= most) state.without_id = std::move(without_id);
      by_id.settle_by_faces(state, true);
    }
  }
  const VertexClaims by_place(state, claims_by_place(state));
  by_place.settle_by_faces(state, false);
  by_place.settle_by_edges(state);
}

/// Vertices with faces that have no pair, by place and then by number.
std::vector<std::uint32_t> unpaired(const Rings& rings, const std::vector<std::uint32_t>& places, auto&& is_paired) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t v = 0; v < places.size(); ++v)
    if (rings.degree(v) && !is_paired(v)) left.push_back(v);
  std::ranges::stable_sort(left, {}, [&](std::uint32_t v) { return places[v]; });
  return left;
}

/// Vertices that lie where one lay, but with nothing else around them that stayed: where several lie, those that are
/// left, in their order.
void pair_what_lies_in_place(MatchState& state) {
  const Places& places = state.places;
  const auto mine = unpaired(state.from_rings, places.from, [&](auto v) { return state.pairs.to(v) != kNowhere; });
  const auto theirs = unpaired(state.to_rings, places.to, [&](auto w) { return state.pairs.from(w) != kNowhere; });
  for (std::size_t i = 0, j = 0; i < mine.size() && j < theirs.size();) {
    const std::uint32_t place = places.from[mine[i]], other = places.to[theirs[j]];
    std::size_t i_end = i, j_end = j;
    while (place <= other && i_end < mine.size() && places.from[mine[i_end]] == place) ++i_end;
    while (other <= place && j_end < theirs.size() && places.to[theirs[j_end]] == other) ++j_end;
    for (std::size_t k = 0; k < std::min(i_end - i, j_end - j); ++k) state.pairs.set(mine[i + k], theirs[j + k]);
    i = i_end;
    j = j_end;
  }
}

void pair_by_geometry(MatchState& state, std::vector<std::uint32_t> ids) {
  pair_by_claims(state, std::move(ids));
  MatchWalk(state, MatchWalk::Over::in_place).from_everywhere();
  match_faces_in_place(state);
  MatchWalk moved(state, MatchWalk::Over::moved);
  moved.from_everywhere();
  keep_what_fits(state, moved.paired());
  walk_from_rare_faces(state);
  pair_what_lies_in_place(state);
}

/// Vertices that moved, came or went.
std::uint64_t changes(const MatchState& state, const VertexPairs& pairs) {
  std::uint64_t count = 0;
  for (std::uint32_t w = 0; w < state.to.points.size(); ++w)
    count += state.to_rings.degree(w) &&
             (pairs.from(w) == kNowhere || state.places.from[pairs.from(w)] != state.places.to[w]);
  for (std::uint32_t v = 0; v < state.from.points.size(); ++v)
    count += state.from_rings.degree(v) && pairs.to(v) == kNowhere;
  return count;
}

/// An order of faces that fits may be the old one, or fit by chance: then fewer vertices change without it.
void pair(MatchState& state, std::vector<std::uint32_t> ids, std::span<const std::uint32_t> known) {
  std::vector<OrderedPairs> order;
  if (ids.empty()) order = pairs_by_order(state);
  for (std::uint32_t w = 0; w < known.size(); ++w) {
    if (known[w] == kNowhere) continue;
    state.pairs.set(known[w], w);
    if (!order.empty() && order.front().pairs.from(w) != known[w] && state.to_rings.degree(w)) order.clear();
  }
  if (order.empty() || order.front().contradictions) pair_by_geometry(state, std::move(ids));
  if (!order.empty() && changes(state, order.front().pairs) <= changes(state, state.pairs))
    state.pairs = std::move(order.front().pairs);
}

std::vector<FaceMatch> faces_of(MatchState& state) {
  std::vector<FaceMatch> faces(state.to.face_count());
  std::vector<std::uint32_t> cycle;
  for (std::uint32_t g = 0; g < faces.size(); ++g)
    if (state.known_cycle(g, cycle)) faces[g] = state.faces.take(cycle);
  return faces;
}

SurfaceMatch match_as_numbered(const Surface& from, const Surface& to, std::vector<std::uint32_t> ids,
                               std::span<const std::uint32_t> known) {
  MatchState state(from, to);
  pair(state, std::move(ids), known);
  std::vector<FaceMatch> faces = faces_of(state);
  return {std::move(state.pairs), std::move(faces)};
}

}  // namespace

SurfaceMatch match_surfaces(const Surface& from, const Surface& to, std::vector<std::uint32_t> ids,
                            std::span<const std::uint32_t> known) {
  if (!is_scattered(to) || is_scattered(from)) return match_as_numbered(from, to, std::move(ids), known);
  const LocalOrder order = in_local_order(to);
  std::vector<std::uint32_t> ordered_ids, ordered_known;
  for (std::size_t w = 0; w < ids.size(); ++w) ordered_ids.push_back(ids[order.vertex[w]]);
  for (std::size_t w = 0; w < known.size(); ++w) ordered_known.push_back(known[order.vertex[w]]);
  const SurfaceMatch found = match_as_numbered(from, order.surface(), std::move(ordered_ids), ordered_known);
  SurfaceMatch match{VertexPairs(from.points.size(), to.points.size()), std::vector<FaceMatch>(to.face_count())};
  for (std::uint32_t w = 0; w < to.points.size(); ++w)
    if (const std::uint32_t v = found.vertices.from(w); v != kNowhere) match.vertices.set(v, order.vertex[w]);
  for (std::uint32_t g = 0; g < to.face_count(); ++g) match.faces[order.face[g]] = found.faces[g];
  return match;
}

Matching match_faces(const Surface& from, const Surface& to) {
  const SurfaceMatch match = match_surfaces(from, to);
  Matching result{std::vector<FaceMatch>(from.face_count()), from.face_count()};
  for (std::uint32_t g = 0; g < match.faces.size(); ++g) {
    const auto [f, turn] = match.faces[g];
    if (f == FaceMatch::kNone) continue;
    const std::uint32_t size = to.size(g);
    result.matches[f] = {g, (size - turn) % size};
    --result.unmatched;
  }
  return result;
}

}  // namespace ramcdb::detail
