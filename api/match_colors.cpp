#include <algorithm>
#include <array>
#include <optional>

#include "api/match_walk.h"

namespace ramcdb::detail {
namespace {

/// Tells vertices apart by the connectivity around them, one ring more with every round (colour refinement): equal
/// surroundings have equal colours in both surfaces. Paired vertices have colours of their own from the beginning.
class VertexColors {
 public:
  /// \param pair_of number of the pair of a vertex, or kNowhere
  template <class PairOf, class DegreeOf>
  VertexColors(const Surface& surface, const Rings& rings, PairOf&& pair_of, DegreeOf&& degree_of)
      : surface_(surface), rings_(rings), colors_(surface.points.size()) {
    for (std::uint32_t v = 0; v < colors_.size(); ++v) {
      const std::uint32_t pair = pair_of(v);
      colors_[v] = pair == kNowhere ? hash_of(degree_of(v), 1) : hash_of(pair, 2);
      if (pair == kNowhere && rings.degree(v)) open_.push_back(v);
    }
  }

  void refine() {
    std::vector<std::uint64_t> refined(open_.size());
    for (std::size_t i = 0; i < open_.size(); ++i) refined[i] = around(open_[i]);
    for (std::size_t i = 0; i < open_.size(); ++i) colors_[open_[i]] = refined[i];
  }
  [[nodiscard]] std::uint64_t operator[](std::uint32_t vertex) const { return colors_[vertex]; }
  [[nodiscard]] std::uint64_t of_face(std::uint32_t f) const {
    const auto vertices = surface_.vertices(f);
    return hash_of_cycle(surface_.size(f), [&](std::uint32_t i) { return colors_[vertices[i]]; });
  }

 private:
  [[nodiscard]] std::uint64_t around(std::uint32_t v) const {
    std::uint64_t sum = 0;
    for (const std::uint32_t c : rings_.of(v)) {
      std::uint64_t face = 3;
      for (std::uint32_t d = rings_.next(c); d != c; d = rings_.next(d))
        face = face * 0x9e3779b97f4a7c15 + colors_[surface_.corners[d]];
      sum += mixed(face);
    }
    return hash_of(colors_[v], sum);
  }

  const Surface& surface_;
  const Rings& rings_;
  std::vector<std::uint64_t> colors_;
  std::vector<std::uint32_t> open_;
};

struct ColoredFace {
  std::uint64_t color;
  std::uint32_t face;
  friend auto operator<=>(const ColoredFace&, const ColoredFace&) = default;
};

/// Colours that one face alone has, and how many colours there are.
struct RareFaces {
  std::vector<ColoredFace> faces;
  std::size_t colors = 0;
};

template <class IsOpen>
RareFaces rare_faces(const Surface& s, const VertexColors& colors, IsOpen&& is_open) {
  std::vector<ColoredFace> all;
  for (std::uint32_t f = 0; f < s.face_count(); ++f)
    if (std::ranges::any_of(s.vertices(f), is_open)) all.push_back({colors.of_face(f), f});
  std::sort(all.begin(), all.end());
  RareFaces rare;
  for (std::size_t i = 0, end; i < all.size(); i = end, ++rare.colors) {
    for (end = i; end < all.size() && all[end].color == all[i].color;) ++end;
    if (end == i + 1) rare.faces.push_back(all[i]);
  }
  return rare;
}

/// Faces of both surfaces that are alike.
struct Seed {
  std::uint32_t to, from;
};

class RareFaceWalk {
 public:
  explicit RareFaceWalk(MatchState& state) : state_(state) {}

  void run() {
    std::size_t colors_before = 0;
    constexpr std::array<int, 3> kRounds{3, 3, 6};
    for (const int rounds : kRounds) {
      if (all_paired()) return;
      if (!from_) color();
      for (int i = 0; i < rounds; ++i) {
        from_->refine();
        to_->refine();
      }
      const std::size_t colors = find_seeds();
      if (walk_from_seeds())
        from_.reset();
      else if (colors == colors_before)
        return;  // further rounds would tell no more vertices apart
      colors_before = colors;
    }
  }

 private:
  /// Whether one surface has no vertex left, with faces, that has no pair.
  [[nodiscard]] bool all_paired() const {
    const auto none_left = [](const Rings& rings, std::size_t count, auto&& pair_of) {
      std::uint32_t v = 0;
      while (v < count && (pair_of(v) != kNowhere || !rings.degree(v))) ++v;
      return v == count;
    };
    return none_left(state_.from_rings, state_.from.points.size(), [&](auto v) { return state_.pairs.to(v); }) ||
           none_left(state_.to_rings, state_.to.points.size(), [&](auto w) { return state_.pairs.from(w); });
  }

  void color() {
    from_.emplace(
        state_.from, state_.from_rings, [&](std::uint32_t v) { return state_.pairs.to(v) == kNowhere ? kNowhere : v; },
        [&](std::uint32_t v) { return state_.from_rings.degree(v); });
    to_.emplace(
        state_.to, state_.to_rings, [&](std::uint32_t w) { return state_.pairs.from(w); },
        [&](std::uint32_t w) { return state_.to_rings.degree(w); });
  }

  /// In order of the faces of `to`. Returns how many colours the faces of `from` have.
  std::size_t find_seeds() {
    const RareFaces mine =
        rare_faces(state_.from, *from_, [&](std::uint32_t v) { return state_.pairs.to(v) == kNowhere; });
    const RareFaces theirs =
        rare_faces(state_.to, *to_, [&](std::uint32_t w) { return state_.pairs.from(w) == kNowhere; });
    std::vector<std::uint32_t> alike(state_.to.face_count(), kNowhere);
    auto f = mine.faces.begin();
    for (const ColoredFace& g : theirs.faces) {
      while (f != mine.faces.end() && f->color < g.color) ++f;
      if (f == mine.faces.end()) break;
      if (f->color == g.color && state_.from.size(f->face) == state_.to.size(g.face)) alike[g.face] = f->face;
    }
    seeds_.clear();
    for (std::uint32_t g = 0; g < alike.size(); ++g)
      if (alike[g] != kNowhere) seeds_.push_back({g, alike[g]});
    return mine.colors;
  }

  /// The one turn at which the colours of two faces agree.
  [[nodiscard]] std::optional<FaceMatch> match_of(Seed seed) const {
    const auto [g, f] = seed;
    std::optional<FaceMatch> found;
    const std::uint32_t size = state_.to.size(g);
    for (std::uint32_t turn = 0; turn < size; ++turn) {
      bool same = true;
      for (std::uint32_t i = 0; i < size && same; ++i)
        same = (*from_)[state_.from.corners[state_.from.corner(f, i + turn)]] ==
               (*to_)[state_.to.corners[state_.to.corner(g, i)]];
      if (same && found) return std::nullopt;
      if (same) found = FaceMatch{f, turn};
    }
    return found;
  }

  /// From all seeds at once; where that contradicts itself, from each of the first few alone.
  bool walk_from_seeds() {
    MatchWalk walk(state_, MatchWalk::Over::moved);
    for (const Seed& seed : seeds_) {
      if (is_known(seed.to)) continue;
      if (const auto match = match_of(seed)) walk.from_face(seed.to, *match);
    }
    if (keep_what_fits(state_, walk.paired())) return true;
    int tries = 8;
    for (auto seed = seeds_.begin(); seed != seeds_.end() && tries > 0; ++seed) {
      const auto match = match_of(*seed);
      if (!match) continue;
      --tries;
      MatchWalk alone(state_, MatchWalk::Over::moved);
      alone.from_face(seed->to, *match);
      if (keep_what_fits(state_, alone.paired())) return true;
    }
    return false;
  }

  [[nodiscard]] bool is_known(std::uint32_t g) const {
    return std::ranges::all_of(state_.to.vertices(g),
                               [&](std::uint32_t w) { return state_.pairs.from(w) != kNowhere; });
  }

  MatchState& state_;
  std::optional<VertexColors> from_, to_;
  std::vector<Seed> seeds_;
};

}  // namespace

void walk_from_rare_faces(MatchState& state) { RareFaceWalk(state).run(); }

}  // namespace ramcdb::detail
