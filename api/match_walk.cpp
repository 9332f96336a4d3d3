#include "api/match_walk.h"

#include <algorithm>
#include <span>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

struct Share {
  std::uint64_t kept = 0, all = 0;
  [[nodiscard]] bool at_least(std::uint64_t part, std::uint64_t of) const { return kept * of >= all * part; }
};

}  // namespace

void MatchWalk::from_everywhere() {
  for (std::uint32_t g = 0; g < state_.to.face_count(); ++g) {
    look(g);
    go();
  }
}

bool MatchWalk::from_face(std::uint32_t face, FaceMatch match) {
  if (!pair_faces(face, match)) return false;
  go();
  return true;
}

void MatchWalk::go() {
  while (done_ < paired_.size())
    for (const std::uint32_t c : state_.to_rings.of(paired_[done_++])) look(state_.to_rings.face(c));
}

void MatchWalk::look(std::uint32_t face) {
  const auto vertices = state_.to.vertices(face);
  const auto is_known = [&](std::uint32_t w) { return state_.pairs.from(w) != kNowhere; };
  const auto known = static_cast<std::size_t>(std::ranges::count_if(vertices, is_known));
  if (known < 2 || known == vertices.size()) return;
  const auto size = static_cast<std::uint32_t>(vertices.size());
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t a = vertices[i], b = vertices[(i + 1) % size];
    if (a == b || !is_known(a) || !is_known(b)) continue;
    const auto mine = state_.from_rings.passes(state_.pairs.from(a), state_.pairs.from(b));
    if (mine.count != 1 || state_.to_rings.passes(a, b).count != 1) continue;
    const std::uint32_t f = state_.from_rings.face(mine.corner);
    if (state_.from.size(f) == size && pair_faces(face, {f, (mine.corner - state_.from.firsts[f] + size - i) % size}))
      return;
  }
}

bool MatchWalk::may_pair(std::uint32_t v, std::uint32_t w) const {
  if (!state_.can_pair(v, w)) return false;
  if (over_ == Over::in_place) return state_.places.from[v] == state_.places.to[w];
  return state_.from_rings.degree(v) == state_.to_rings.degree(w) &&
         (state_.without_id.empty() || !state_.without_id[w]);
}

bool MatchWalk::pair_faces(std::uint32_t face, FaceMatch match) {
  const auto vertices = state_.to.vertices(face);
  const std::size_t before = paired_.size();
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t w = vertices[i], v = state_.from.corners[state_.from.corner(match.face, i + match.turn)];
    if (state_.pairs.from(w) == v) continue;
    if (!may_pair(v, w)) {
      for (; paired_.size() > before; paired_.pop_back()) state_.pairs.unset(paired_.back());
      return false;
    }
    state_.pairs.set(v, w);
    paired_.push_back(w);
  }
  return true;
}

std::size_t keep_what_fits(MatchState& state, const std::vector<std::uint32_t>& paired) {
  constexpr std::uint64_t kFewFaces = 2;  // do not tell alone who a vertex is
  const auto is_whole = [&](std::uint32_t w) {
    const std::uint32_t v = state.pairs.from(w);
    return v != kNowhere && state.from_rings.degree(v) == state.to_rings.degree(w);
  };
  std::vector<std::uint32_t> position(state.to.points.size(), kNowhere);
  for (std::uint32_t i = 0; i < paired.size(); ++i) position[paired[i]] = i;
  std::vector<std::uint32_t> cycle;
  DisjointSets groups(paired.size());
  std::vector<Share> shares(paired.size()), around(paired.size()), of_group(paired.size());
  for (std::uint32_t g = 0; g < state.to.face_count(); ++g) {
    const auto vertices = state.to.vertices(g);
    const auto first = std::ranges::find_if(vertices, [&](std::uint32_t w) { return position[w] != kNowhere; });
    if (first == vertices.end()) continue;
    const bool survives = state.known_cycle(g, cycle) && state.faces.has(cycle);
    const auto whole = static_cast<std::uint64_t>(std::ranges::count_if(vertices, is_whole));
    for (auto w = first; w != vertices.end(); ++w) {
      if (position[*w] == kNowhere) continue;
      around[position[*w]].all += vertices.size() - 1;
      around[position[*w]].kept += whole - 1;
      ++shares[position[*w]].all;
      shares[position[*w]].kept += survives;
      groups.join(position[*first], position[*w]);
    }
  }
  for (std::uint32_t i = 0; i < paired.size(); ++i) {
    of_group[groups.root(i)].kept += shares[i].kept;
    of_group[groups.root(i)].all += shares[i].all;
  }
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < paired.size(); ++i)
    if (of_group[groups.root(i)].at_least(3, 4) && shares[i].at_least(1, 2) &&
        (shares[i].all > kFewFaces || around[i].at_least(1, 2)))
      ++kept;
    else
      state.pairs.unset(paired[i]);
  return kept;
}

void match_faces_in_place(MatchState& state) {
  // Only faces that are not known yet, and of these only those in whose places the other surface has vertices.
  const auto may_match = [](std::span<const std::uint32_t> vertices, auto&& is_known, auto&& is_place) {
    return std::ranges::all_of(vertices, is_place) && !std::ranges::all_of(vertices, is_known);
  };
  const Places& places = state.places;
  std::vector<std::uint64_t> keys(state.to.face_count(), 0);
  for (std::uint32_t g = 0; g < keys.size(); ++g) {
    const auto vertices = state.to.vertices(g);
    if (may_match(
            vertices, [&](std::uint32_t w) { return state.pairs.from(w) != kNowhere; },
            [&](std::uint32_t w) { return places.count_from[places.to[w]] > 0; }))
      keys[g] = hash_of_cycle(state.to.size(g), [&](std::uint32_t i) { return places.to[vertices[i]]; });
  }
  if (std::ranges::all_of(keys, [](std::uint64_t key) { return key == 0; })) return;
  HashIndex index(std::move(keys));
  constexpr std::uint32_t kTries = 64;  // of alike faces, that contradict what is known
  MatchWalk walk(state, MatchWalk::Over::in_place);
  for (std::uint32_t f = 0; f < state.from.face_count(); ++f) {
    const auto vertices = state.from.vertices(f);
    const std::uint32_t size = state.from.size(f);
    if (!may_match(
            vertices, [&](std::uint32_t v) { return state.pairs.to(v) != kNowhere; },
            [&](std::uint32_t v) { return places.count_to[places.from[v]] > 0; }))
      continue;
    const std::uint64_t key = hash_of_cycle(size, [&](std::uint32_t i) { return places.from[vertices[i]]; });
    (void)index.take(key, kTries, [&](std::uint32_t g) {
      bool found = false;
      for (std::uint32_t turn = 0; state.to.size(g) == size && turn < size && !found; ++turn)
        found = walk.from_face(g, {f, turn});
      return found;
    });
  }
}

}  // namespace ramcdb::detail
