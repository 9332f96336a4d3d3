#include "api/vertex_claims.h"

#include <algorithm>

namespace ramcdb::detail {
namespace {

/// Hash of the places of the faces around a vertex, in any order of the faces.
std::uint64_t ring_hash(const Surface& s, const Rings& rings, const std::vector<std::uint32_t>& places,
                        std::uint32_t v) {
  std::uint64_t sum = hash_of(places[v], rings.degree(v));
  for (const std::uint32_t c : rings.of(v)) {
    std::uint64_t face = s.size(rings.face(c));
    for (std::uint32_t d = rings.next(c); d != c; d = rings.next(d)) face = hash_of(face, places[s.corners[d]]);
    sum += face;
  }
  return sum ? sum : 1;
}

/// Vertices of `from` that share their point with another one, by place and ring.
HashIndex crowded_vertices(const MatchState& state) {
  std::vector<std::uint64_t> keys(state.from.points.size(), 0);
  for (std::uint32_t v = 0; v < keys.size(); ++v)
    if (state.from_rings.degree(v) && state.places.count_from[state.places.from[v]] > 1)
      keys[v] = ring_hash(state.from, state.from_rings, state.places.from, v);
  return HashIndex(std::move(keys));
}

}  // namespace

VertexClaims::VertexClaims(MatchState& state, std::vector<std::uint32_t> claims)
    : claims_(std::move(claims)), votes_(claims_.size(), 0) {
  for (std::uint32_t w = 0; w < claims_.size(); ++w)
    if (state.pairs.from(w) != kNowhere) claims_[w] = state.pairs.from(w);
  count_faces(state);
}

void VertexClaims::count_faces(MatchState& state) {
  std::vector<std::uint32_t> cycle;
  for (std::uint32_t g = 0; g < state.to.face_count(); ++g) {
    const auto vertices = state.to.vertices(g);
    cycle.clear();
    for (const std::uint32_t w : vertices) cycle.push_back(claims_[w]);
    if (std::ranges::find(cycle, kNowhere) != cycle.end() || !state.faces.has(cycle)) continue;
    ++faces_;
    for (const std::uint32_t w : vertices) ++votes_[w];
  }
}

void VertexClaims::settle(MatchState& state, const std::vector<std::uint32_t>& votes, std::uint32_t least) const {
  std::vector<std::uint32_t> best(state.from.points.size(), kNowhere);
  const auto in_place = [&](std::uint32_t w) { return state.places.to[w] == state.places.from[claims_[w]]; };
  const auto better = [&](std::uint32_t w, std::uint32_t than) {
    return votes[w] != votes[than] ? votes[w] > votes[than] : in_place(w) && !in_place(than);
  };
  const auto may = [&](std::uint32_t w) {
    return claims_[w] != kNowhere && votes[w] >= least && state.can_pair(claims_[w], w);
  };
  for (std::uint32_t w = 0; w < claims_.size(); ++w)
    if (may(w) && (best[claims_[w]] == kNowhere || better(w, best[claims_[w]]))) best[claims_[w]] = w;
  for (std::uint32_t v = 0; v < best.size(); ++v)
    if (best[v] != kNowhere) state.pairs.set(v, best[v]);
}

void VertexClaims::settle_by_faces(MatchState& state, bool trusted) const { settle(state, votes_, trusted ? 0 : 1); }

void VertexClaims::settle_by_edges(MatchState& state) const {
  std::vector<std::uint32_t> votes(claims_.size(), 0);
  for (std::uint32_t w = 0; w < claims_.size(); ++w) {
    if (claims_[w] == kNowhere || votes_[w]) continue;
    for (const std::uint32_t c : state.to_rings.of(w)) {
      const std::uint32_t next = claims_[state.to.corners[state.to_rings.next(c)]];
      const std::uint32_t previous = claims_[state.to.corners[state.to_rings.previous(c)]];
      votes[w] += next != kNowhere && state.from_rings.passes(claims_[w], next).count > 0;
      votes[w] += previous != kNowhere && state.from_rings.passes(previous, claims_[w]).count > 0;
    }
  }
  settle(state, votes, 1);
}

std::vector<std::uint32_t> claims_by_place(const MatchState& state) {
  std::vector<std::uint32_t> claims(state.to.points.size(), kNowhere);
  const HashIndex crowded = crowded_vertices(state);
  for (std::uint32_t w = 0; w < claims.size(); ++w) {
    const std::uint32_t place = state.places.to[w];
    if (state.pairs.from(w) != kNowhere || !state.to_rings.degree(w) || !state.places.count_from[place]) continue;
    std::uint32_t v = state.places.first_from[place];
    if (state.places.count_from[place] > 1) {
      v = crowded.first(ring_hash(state.to, state.to_rings, state.places.to, w));
      if (v == kNowhere || state.places.from[v] != place || crowded.after(v) != kNowhere) continue;
    }
    if (state.can_pair(v, w)) claims[w] = v;
  }
  return claims;
}

std::vector<OrderedPairs> pairs_by_order(const MatchState& state) {
  if (!std::ranges::equal(state.from.firsts, state.to.firsts)) return {};
  OrderedPairs ordered{VertexPairs(state.from.points.size(), state.to.points.size()), 0};
  const Places& places = state.places;
  for (std::size_t c = 0; c < state.to.corners.size(); ++c) {
    const std::uint32_t v = state.from.corners[c], w = state.to.corners[c];
    const std::uint32_t from = ordered.pairs.from(w), to = ordered.pairs.to(v);
    if (from == kNowhere && to == kNowhere)
      ordered.pairs.set(v, w);
    else if (from != v)
      return {};
  }
  for (std::uint32_t w = 0; w < state.to.points.size(); ++w) {
    const std::uint32_t v = ordered.pairs.from(w), place = places.to[w];
    ordered.contradictions += v != kNowhere && places.from[v] != place && places.count_from[place] > 0;
  }
  return {std::move(ordered)};
}

}  // namespace ramcdb::detail
