#include "api/alike_additions.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "api/disjoint_sets.h"

namespace ramcdb::detail {
namespace {

/// A vertex of the base by its number, a new one by its place.
struct Who {
  std::uint32_t base = kNew;
  std::array<std::uint64_t, 3> place{};
  friend auto operator<=>(const Who&, const Who&) = default;
};

Who who(std::uint32_t base, const Point& p) {
  if (base != kNew) return {base, {}};
  return {kNew,
          {std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), std::bit_cast<std::uint64_t>(p.z)}};
}

/// The corner at which the vertices of a face begin with the least.
std::size_t first_corner(const std::array<Who, 3>& face) {
  const auto turned = [&](std::size_t i) { return std::array{face[i], face[(i + 1) % 3], face[(i + 2) % 3]}; };
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (turned(i) < turned(best)) best = i;
  return best;
}

class AlikeFinder {
 public:
  AlikeFinder(const EditedRegion& ours, const RegionMesh& theirs) : ours_(ours), theirs_(theirs) {
    out_.vertex.assign(ours.mesh.points.size(), kNew);
    out_.faces.assign(ours.mesh.faces.size(), false);
    out_.faces_of_theirs.assign(theirs.faces.size(), false);
    taken_.assign(theirs.points.size(), false);
  }

  AlikeAdditions run(std::span<const Point> our_places, std::span<const Point> their_places,
                     std::span<const std::uint32_t> base_vertex, const std::vector<bool>& is_new) {
    for (std::uint32_t v = 0; v < our_places.size(); ++v) mine_.push_back(who(ours_.vertex_source[v], our_places[v]));
    for (std::uint32_t w = 0; w < their_places.size(); ++w) other_.push_back(who(base_vertex[w], their_places[w]));
    pair_faces(is_new);
    keep_whole_additions();
    pair_isolated();
    return std::move(out_);
  }

 private:
  using Face = std::array<Who, 3>;

  /// The vertices of a face from its first corner on.
  static std::pair<Face, Triangle> turned(const Triangle& t, const std::vector<Who>& names) {
    const Face face{names[t[0]], names[t[1]], names[t[2]]};
    const std::size_t i = first_corner(face);
    return {{face[i], face[(i + 1) % 3], face[(i + 2) % 3]}, {t[i], t[(i + 1) % 3], t[(i + 2) % 3]}};
  }

  /// Each new face of ours with a new one of theirs, as long as each vertex has but one partner.
  void pair_faces(const std::vector<bool>& is_new) {
    std::multimap<Face, std::uint32_t> theirs;
    for (std::uint32_t g = 0; g < theirs_.faces.size(); ++g)
      if (is_new[g]) theirs.emplace(turned(theirs_.faces[g], other_).first, g);
    partner_.assign(out_.faces.size(), kNew);
    for (std::uint32_t f = 0; f < partner_.size(); ++f) {
      if (ours_.face_source[f] != kNew) continue;
      const auto [face, vertices] = turned(ours_.mesh.faces[f], mine_);
      const auto [first, last] = theirs.equal_range(face);
      for (auto it = first; it != last; ++it) {
        if (!pair_vertices(vertices, turned(theirs_.faces[it->second], other_).second)) continue;
        partner_[f] = it->second;
        theirs.erase(it);
        break;
      }
    }
  }

  bool pair_vertices(const Triangle& mine, const Triangle& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (mine_[mine[i]].base != kNew) continue;
      const std::uint32_t known = out_.vertex[mine[i]];
      if (known == kNew ? taken_[other[i]] : known != other[i]) return false;
    }
    for (std::size_t i = 0; i < 3; ++i)
      if (mine_[mine[i]].base == kNew) {
        out_.vertex[mine[i]] = other[i];
        taken_[other[i]] = true;
      }
    return true;
  }

  /// What hangs together by new vertices is the same as a whole or not at all.
  void keep_whole_additions() {
    DisjointSets joined(mine_.size());
    const auto new_vertex = [&](std::uint32_t f) {
      const auto it = std::ranges::find_if(ours_.mesh.faces[f], [&](auto v) { return mine_[v].base == kNew; });
      return it == ours_.mesh.faces[f].end() ? kNew : *it;
    };
    const auto each_new_face = [&](auto&& look) {
      for (std::uint32_t f = 0; f < partner_.size(); ++f)
        if (ours_.face_source[f] == kNew) look(f, new_vertex(f));
    };
    each_new_face([&](std::uint32_t f, std::uint32_t first) {
      for (const std::uint32_t v : ours_.mesh.faces[f])
        if (mine_[v].base == kNew) joined.join(first, v);
    });
    std::vector<bool> differs(mine_.size(), false);
    each_new_face([&](std::uint32_t f, std::uint32_t first) {
      if (first != kNew && partner_[f] == kNew) differs[joined.root(first)] = true;
    });
    each_new_face([&](std::uint32_t f, std::uint32_t first) {
      if (partner_[f] == kNew) return;
      if (first != kNew && differs[joined.root(first)])
        out_.disputed.push_back(f);
      else
        out_.faces[f] = out_.faces_of_theirs[partner_[f]] = true;
    });
    for (std::uint32_t v = 0; v < mine_.size(); ++v)
      if (out_.vertex[v] != kNew && differs[joined.root(v)]) out_.vertex[v] = kNew;
  }

  void pair_isolated() {
    std::vector<bool> used(mine_.size(), false), used_there(other_.size(), false);
    for (const Triangle& t : ours_.mesh.faces)
      for (const std::uint32_t v : t) used[v] = true;
    for (const Triangle& t : theirs_.faces)
      for (const std::uint32_t w : t) used_there[w] = true;
    std::multimap<Who, std::uint32_t> theirs;
    for (std::uint32_t w = 0; w < other_.size(); ++w)
      if (other_[w].base == kNew && !used_there[w]) theirs.emplace(other_[w], w);
    for (std::uint32_t v = 0; v < mine_.size(); ++v) {
      if (mine_[v].base != kNew || used[v]) continue;
      const auto it = theirs.find(mine_[v]);
      if (it == theirs.end()) continue;
      out_.vertex[v] = it->second;
      theirs.erase(it);
    }
  }

  const EditedRegion& ours_;
  const RegionMesh& theirs_;
  AlikeAdditions out_;
  std::vector<Who> mine_, other_;
  std::vector<bool> taken_;             ///< vertices of theirs
  std::vector<std::uint32_t> partner_;  ///< faces of ours -> of theirs
};

}  // namespace

AlikeAdditions find_alike_additions(const EditedRegion& ours, std::span<const Point> our_places,
                                    const RegionMesh& theirs, std::span<const Point> their_places,
                                    std::span<const std::uint32_t> base_vertex, const std::vector<bool>& is_new) {
  return AlikeFinder(ours, theirs).run(our_places, their_places, base_vertex, is_new);
}

}  // namespace ramcdb::detail
