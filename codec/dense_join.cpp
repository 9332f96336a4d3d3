#include "codec/dense_join.h"

#include <algorithm>

namespace ramcdb::codec {

void JoinSearch::rank_near(LatticePoint place, const std::array<std::uint32_t, 3>& excluded) {
  place_ = place;
  excluded_ = excluded;
  ranked_.clear();
  const auto& live = front_.live();
  if (live.size() > kRankAll) {
    collect_from_grid();
    return;
  }
  for (const std::uint32_t node : live)
    if (!is_excluded(node)) ranked_.push_back(ranked(node));
}

std::size_t JoinSearch::rank_of(std::uint32_t node) const {
  const Ranked wanted = ranked(node);
  std::size_t rank = 0;
  bool found = false;
  for (const Ranked& r : ranked_) {
    rank += r < wanted;
    found |= r == wanted;
  }
  return found ? rank : ranked_.size();
}

std::uint32_t JoinSearch::node_at(std::size_t rank) {
  const auto at = ranked_.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(ranked_.begin(), at, ranked_.end());
  return at->second;
}

bool JoinSearch::is_excluded(std::uint32_t node) const {
  return std::find(excluded_.begin(), excluded_.end(), front_[node].vertex) != excluded_.end();
}

JoinSearch::Ranked JoinSearch::ranked(std::uint32_t node) const {
  const LatticePoint p = surface_[front_[node].vertex].position;
  std::uint64_t squared = 0;  // three squares of less than 2^31 fit
  for (int a = 0; a < 3; ++a) {
    const std::int64_t d = std::int64_t{p[a]} - place_[a];
    squared += static_cast<std::uint64_t>(d * d);
  }
  return {squared, node};
}

LatticePoint JoinSearch::cell_of(LatticePoint p) const {
  return {p.x >> cell_shift_, p.y >> cell_shift_, p.z >> cell_shift_};
}

std::size_t JoinSearch::slot_of(LatticePoint cell) const {
  const auto mix = [](std::uint64_t h, std::int32_t x) {
    return (h ^ static_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15u;
  };
  return static_cast<std::size_t>(mix(mix(mix(0, cell.x), cell.y), cell.z) >> 32) & (heads_.size() - 1);
}

/// Ring by ring around the place, until a ring ends with enough nodes.
void JoinSearch::collect_from_grid() {
  if (heads_.empty()) build_grid();
  examined_ = 0;
  const LatticePoint centre = cell_of(place_);
  for (int ring = 0; ring <= kRings && ranked_.size() < kEnough; ++ring)
    for (int x = -ring; x <= ring; ++x)
      for (int y = -ring; y <= ring; ++y) {
        const bool whole_column = std::abs(x) == ring || std::abs(y) == ring;
        for (int z = -ring; z <= ring; z += whole_column ? 1 : 2 * ring)
          if (!collect_cell({centre.x + x, centre.y + y, centre.z + z})) return;
      }
}

/// False when enough nodes were looked at.
bool JoinSearch::collect_cell(LatticePoint cell) {
  for (std::uint32_t node = heads_[slot_of(cell)]; node != kNone; node = after_[node]) {
    if (++examined_ > kMaxExamined) return false;
    if (cell_of(surface_[front_[node].vertex].position) == cell && !is_excluded(node)) ranked_.push_back(ranked(node));
  }
  return true;
}

void JoinSearch::build_grid() {
  heads_.assign(std::bit_ceil(2 * front_.live().size()), kNone);
  for (const std::uint32_t node : front_.live()) insert(node);
}

void JoinSearch::insert(std::uint32_t node) {
  if (after_.size() <= node) {
    after_.resize(front_.node_count() + std::size_t{256}, kNone);
    before_.resize(after_.size(), kNone);
  }
  std::uint32_t& head = heads_[slot_of(cell_of(surface_[front_[node].vertex].position))];
  before_[node] = kNone;
  after_[node] = head;
  if (head != kNone) before_[head] = node;
  head = node;
}

void JoinSearch::erase(std::uint32_t node) {
  if (before_[node] != kNone) {
    after_[before_[node]] = after_[node];
  } else {
    heads_[slot_of(cell_of(surface_[front_[node].vertex].position))] = after_[node];
  }
  if (after_[node] != kNone) before_[after_[node]] = before_[node];
}

}  // namespace ramcdb::codec
