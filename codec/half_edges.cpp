#include "codec/half_edges.h"

#include <bit>

namespace ramcdb::codec {

namespace {

/// From directed edges to half-edge numbers: open addressing, never iterated.
class EdgeTable {
 public:
  explicit EdgeTable(std::size_t edges) : slots_(std::bit_ceil(2 * edges + 1)) {}

  /// False when there is such an edge already.
  bool insert(std::uint32_t from, std::uint32_t to, std::uint32_t half_edge) {
    Slot& slot = find_slot(from, to);
    if (slot.half_edge != kNone) return false;
    slot = {from, to, half_edge};
    return true;
  }
  [[nodiscard]] std::uint32_t find(std::uint32_t from, std::uint32_t to) { return find_slot(from, to).half_edge; }

 private:
  struct Slot {
    std::uint32_t from = 0, to = 0, half_edge = kNone;
  };

  Slot& find_slot(std::uint32_t from, std::uint32_t to) {
    const std::uint64_t hash = (std::uint64_t{from} << 32 | to) * 0x9e3779b97f4a7c15u;
    for (std::size_t i = hash >> 32;; ++i) {
      Slot& slot = slots_[i & (slots_.size() - 1)];
      if (slot.half_edge == kNone || (slot.from == from && slot.to == to)) return slot;
    }
  }

  std::vector<Slot> slots_;
};

}  // namespace

std::optional<HalfEdges> HalfEdges::of(const Chart& chart) {
  HalfEdges edges(chart);
  if (!edges.match_twins() || !edges.match_border() || !edges.fans_are_single()) return std::nullopt;
  return edges;
}

bool HalfEdges::match_twins() {
  const auto count = static_cast<std::uint32_t>(3 * chart_->faces.size());
  twins_.assign(count, kNone);
  EdgeTable table(count);
  for (std::uint32_t h = 0; h < count; ++h) {
    const std::uint32_t from = origin(h), to = origin(next(h));
    if (from == to || !table.insert(from, to, h)) return false;
    const std::uint32_t twin = table.find(to, from);
    if (twin == kNone) continue;
    twins_[h] = twin;
    twins_[twin] = h;
  }
  return true;
}

/// Every loop edge is a half-edge without twin, and there are no others.
bool HalfEdges::match_border() {
  border_.assign(chart_->border_count(), kNone);
  std::vector<std::uint32_t> follower(border_.size());
  std::uint32_t first = 0;
  for (const std::uint32_t size : chart_->loop_sizes) {
    for (std::uint32_t i = 0; i < size; ++i) follower[first + i] = first + (i + 1) % size;
    first += size;
  }
  for (std::uint32_t h = 0; h < count(); ++h) {
    if (twins_[h] != kNone) continue;
    const std::uint32_t from = origin(h);
    if (from >= border_.size() || follower[from] != origin(next(h))) return false;
    border_[from] = h;
  }
  for (const std::uint32_t h : border_)
    if (h == kNone) return false;
  return true;
}

/// Walking around any corner of a vertex meets all of its corners.
bool HalfEdges::fans_are_single() const {
  std::vector<std::uint32_t> corners(chart_->positions.size(), 0);
  std::vector<std::uint32_t> some(chart_->positions.size(), kNone);
  for (std::uint32_t h = 0; h < count(); ++h) {
    ++corners[origin(h)];
    some[origin(h)] = h;
  }
  for (std::uint32_t v = 0; v < corners.size(); ++v) {
    if (corners[v] == 0) continue;
    // A border fan is walked from its last corner, the one before the loop's edge into v, back to the edge out of v.
    std::uint32_t h = v < border_.size() ? border_[v] : some[v];
    const std::uint32_t start = h;
    std::uint32_t met = 0;
    do {
      ++met;
      h = twin(prev(h));
    } while (h != kNone && h != start);
    if (met != corners[v]) return false;
  }
  return true;
}

}  // namespace ramcdb::codec
