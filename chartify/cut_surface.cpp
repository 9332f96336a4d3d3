#include "chartify/cut_surface.h"

#include <algorithm>
#include <span>
#include <utility>

#include "chartify/partition.h"

namespace ramcdb::chartify {

CutSurface::CutSurface(const IndexedMesh& mesh, Adjacency adjacency, const std::vector<std::uint32_t>& chart_of_face,
                       std::span<const FixedWire> fixed, std::span<const std::uint32_t> corners)
    : mesh_(mesh),
      corners_(corners),
      edges_(std::move(adjacency.edges)),
      fixed_(mesh, edges_, fixed),
      mate_(std::move(adjacency.twins)) {
  for (HalfEdge h = 0; h < mate_.size(); ++h)
    if (mate_[h] != kNoTwin &&
        (chart_of_face[face_of(h)] != chart_of_face[face_of(mate_[h])] || fixed_.contains(edge_of(h))))
      cut(h);
  for (std::size_t cuts = 1; cuts > 0;) {
    find_fans();
    cuts = open_fans_of_split_vertices();
    cuts += lengthen_short_loops();
    cuts += part_doubled_edges();
  }
}

void CutSurface::cut(HalfEdge h) {
  if (mate_[h] == kNoTwin) return;
  borders_.insert(borders_.end(), {h, mate_[h]});
  mate_[mate_[h]] = kNoTwin;
  mate_[h] = kNoTwin;
}

void CutSurface::find_fans() {
  fans_.clear();
  borders_.clear();
  fan_of_.assign(mate_.size(), kNone);
  for (HalfEdge h = 0; h < mate_.size(); ++h) {
    if (is_border(h)) borders_.push_back(h);
    if (fan_of_[h] != kNone) continue;
    HalfEdge first = h;
    while (mate_[first] != kNoTwin) {
      first = next_in_face(mate_[first]);
      if (first == h) break;
    }
    const auto fan = static_cast<std::uint32_t>(fans_.size());
    fans_.push_back({first, mate_[first] != kNoTwin});
    for (HalfEdge g = first; fan_of_[g] == kNone;) {
      fan_of_[g] = fan;
      const HalfEdge arriving = previous_in_face(g);
      if (mate_[arriving] == kNoTwin) break;
      g = mate_[arriving];
    }
  }
}

HalfEdge CutSurface::next_on_border(HalfEdge h) const {
  HalfEdge g = next_in_face(h);
  while (mate_[g] != kNoTwin) g = next_in_face(mate_[g]);
  return g;
}

std::size_t CutSurface::open_fans_of_split_vertices() {
  std::vector<std::uint8_t> fans_at(mesh_.positions.size(), 0);
  for (const std::uint32_t v : corners_) fans_at[v] = 1;
  for (const Fan& fan : fans_) {
    std::uint8_t& count = fans_at[start_of(fan.first)];
    count = count == 0 ? 1 : 2;
  }
  std::size_t cuts = 0;
  for (const Fan& fan : fans_) {
    // Another slit may have opened this one in the meantime; cutting it once more does no harm.
    if (!fan.closed || fans_at[start_of(fan.first)] < 2) continue;
    cut(fan.first);
    ++cuts;
  }
  return cuts;
}

std::size_t CutSurface::part_doubled_edges() {
  std::size_t cuts = 0;
  const auto fans = [&](HalfEdge h) { return std::pair(fan_of_[h], fan_of_[next_in_face(h)]); };
  for (std::size_t e = 0; e < edges_.edge_count(); ++e) {
    const auto at_edge = std::span(edges_.half_edges).subspan(edges_.first[e], edges_.first[e + 1] - edges_.first[e]);
    if (at_edge.size() <= 2) continue;
    for (const HalfEdge h : at_edge) {
      if (is_border(h)) continue;
      // Cutting all but one would do; which one would hang on the order of the faces.
      const auto same = [&](HalfEdge other) { return other != h && fans(other) == fans(h); };
      if (std::ranges::none_of(at_edge, same)) continue;
      cut(h);
      ++cuts;
    }
  }
  return cuts;
}

std::size_t CutSurface::lengthen_short_loops() {
  std::size_t cuts = 0;
  std::vector<HalfEdge> borders = borders_;  // what is cut here lies on loops that are long by then
  std::sort(borders.begin(), borders.end());
  for (const HalfEdge h : borders) {
    const HalfEdge second = next_on_border(h);
    if (second == h || next_on_border(second) != h) continue;
    // The third vertex of the face is not on this loop, so that a cut towards it adds to the loop and never splits it.
    cut(next_in_face(h));
    ++cuts;
  }
  return cuts;
}

}  // namespace ramcdb::chartify
