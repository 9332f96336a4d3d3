#include "api/border_links.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "api/disjoint_sets.h"
#include "api/surface.h"

namespace ramcdb::detail {
namespace {

/// What faces outside a surface can meet of it.
class Links {
 public:
  Links(const BorderedSurface& surface, std::uint32_t count) : surface_(surface), groups(count), odd(count, true) {
    for (const Triangle& t : surface.faces) add(t);
    std::ranges::sort(edges);
    std::ranges::sort(faces);
    std::ranges::sort(corners_, {}, &Corner::shared);
    for (std::size_t first = 0, end; first < corners_.size(); first = end) {
      for (end = first; end < corners_.size() && corners_[end].shared == corners_[first].shared;) ++end;
      group(std::span(corners_).subspan(first, end - first));
    }
    for (const std::uint32_t v : degenerate_) odd[v] = true;
  }

 private:
  /// A face at a shared vertex, by its other two vertices.
  struct Corner {
    std::uint32_t shared, next, previous;
  };

  [[nodiscard]] std::uint32_t shared(std::uint32_t v) const { return surface_.shared[v]; }

  void add(const Triangle& t) {
    const bool is_degenerate = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    Triangle all{shared(t[0]), shared(t[1]), shared(t[2])};
    for (std::size_t i = 0; i < 3; ++i) {
      if (all[i] == kNowhere) continue;
      if (is_degenerate) degenerate_.push_back(all[i]);
      corners_.push_back({all[i], t[(i + 1) % 3], t[(i + 2) % 3]});
      if (all[(i + 1) % 3] != kNowhere) edges.push_back({all[i], all[(i + 1) % 3]});
    }
    std::ranges::sort(all);
    if (all[2] != kNowhere) faces.push_back(all);
  }

  /// Joins the neighbours of a vertex over the faces at it.
  void group(std::span<const Corner> corners) {
    std::vector<std::uint32_t> neighbours;
    for (const Corner& c : corners) neighbours.insert(neighbours.end(), {c.next, c.previous});
    std::ranges::sort(neighbours);
    bool crowded = false;  // an edge of more than two faces
    for (std::size_t i = 2; i < neighbours.size(); ++i) crowded = crowded || neighbours[i] == neighbours[i - 2];
    odd[corners.front().shared] = crowded;
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    DisjointSets sets(neighbours.size());
    const auto position = [&](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::ranges::lower_bound(neighbours, v) - neighbours.begin());
    };
    for (const Corner& c : corners) sets.join(position(c.next), position(c.previous));
    std::vector<std::vector<std::uint32_t>> of_root(neighbours.size());
    std::vector<std::vector<std::uint32_t>>& found = groups[corners.front().shared];
    for (std::uint32_t i = 0; i < neighbours.size(); ++i)
      if (shared(neighbours[i]) != kNowhere) of_root[sets.root(i)].push_back(shared(neighbours[i]));
    for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
      if (sets.root(i) != i) continue;
      std::ranges::sort(of_root[i]);
      found.push_back(std::move(of_root[i]));
    }
    std::ranges::sort(found);
  }

  const BorderedSurface& surface_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> degenerate_;

 public:
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< of two shared vertices, as faces pass them; ascending
  std::vector<Triangle> faces;                      ///< of three shared vertices, these ascending; ascending
  /// Per shared vertex, the groups that its faces form around it, each by the shared vertices at their edges with it.
  std::vector<std::vector<std::vector<std::uint32_t>>> groups;
  /// Shared vertices without a face, of degenerate faces, or with edges of more than two faces.
  std::vector<bool> odd;
};

}  // namespace

std::vector<bool> changed_links(const BorderedSurface& before, const BorderedSurface& after, std::uint32_t count) {
  const Links was(before, count), is(after, count);
  std::vector<bool> changed(count, false);
  for (std::uint32_t v = 0; v < count; ++v) changed[v] = was.odd[v] || is.odd[v] || was.groups[v] != is.groups[v];
  const auto compare = [&](const auto& mine, const auto& theirs) {
    auto other = mine;
    other.clear();
    std::ranges::set_symmetric_difference(mine, theirs, std::back_inserter(other));
    for (const auto& vertices : other)
      for (const std::uint32_t v : vertices) changed[v] = true;
  };
  compare(was.edges, is.edges);
  compare(was.faces, is.faces);
  return changed;
}

}  // namespace ramcdb::detail
