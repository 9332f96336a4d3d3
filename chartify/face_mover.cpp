#include "chartify/face_mover.h"

#include <algorithm>

namespace ramcdb::chartify {
namespace {

// Faces looked at around a vertex, so that the hub of a million spokes does not cost their square. A larger fan is
// taken for one that forbids the move.
constexpr int kMostAround = 1000;

}  // namespace

std::array<std::uint32_t, 3> FaceMover::charts_around(std::uint32_t face) const {
  std::array<std::uint32_t, 3> around{};
  for (std::uint32_t e = 0; e < 3; ++e) {
    const std::uint32_t g = neighbour(face, e);
    around[e] = g == kNone ? kNone : chart(g);
  }
  return around;
}

std::optional<int> FaceMover::gain(std::uint32_t face, std::uint32_t to) const {
  const std::uint32_t from = chart(face);
  int in_to = 0, in_from = 0;
  for (std::uint32_t e = 0; e < 3; ++e) {
    const std::uint32_t g = neighbour(face, e);
    if (g == kNone) continue;
    in_to += chart(g) == to;
    in_from += chart(g) == from;
  }
  if (in_to == 0 || !may_move(face, to)) return {};
  return in_to - in_from;
}

FaceMover::Choice FaceMover::smallest_choice(std::uint32_t face) const {
  const auto around = charts_around(face);
  const std::uint32_t from = chart(face);
  Choice best;
  for (const std::uint32_t to : around) {
    if (to == kNone || to == from || size(to) >= size(from) || !may_move(face, to)) continue;
    if (best.to == kNone || std::pair(size(to), to) < std::pair(size(best.to), best.to)) best = {to, *gain(face, to)};
  }
  return best;
}

bool FaceMover::keeps_sizes(std::uint32_t face, std::uint32_t to) const {
  const std::uint32_t donor = size(chart(face)), taker = size(to);
  return (taker + 1 <= limits_.cap || taker + 1 < donor) && (donor - 1 >= limits_.floor || donor > taker);
}

bool FaceMover::keeps_shape(std::uint32_t face, std::uint32_t to) const {
  const std::uint32_t from = chart(face);
  if (size(from) < 2) return false;
  const auto around = charts_around(face);
  // Edge e ends at the corner where edge e + 1 begins; the corner across edge e begins edge e + 2.
  for (std::uint32_t e = 0; e < 3; ++e) {
    const std::uint32_t next = (e + 1) % 3, across = (e + 2) % 3;
    const HalfEdge common = 3 * face + next, opposite = 3 * face + across;
    const bool both_from = around[e] == from && around[next] == from;
    const bool both_to = around[e] == to && around[next] == to;
    const bool only_to = around[e] == to && around[next] != to && around[across] != to;
    if (both_from && !others_all_in(common, from)) return false;
    if (both_to && around[across] != to && !others_all_in(common, to)) return false;
    if (only_to && others_touch(opposite, to)) return false;
  }
  return true;
}

bool FaceMover::others_all_in(HalfEdge h, std::uint32_t c) const {
  int left = kMostAround;
  for (HalfEdge g = twins_[previous_in_face(h)]; g != h; g = twins_[previous_in_face(g)])
    if (g == kNoTwin || chart(face_of(g)) != c || --left == 0) return false;
  return true;
}

bool FaceMover::others_touch(HalfEdge h, std::uint32_t c) const {
  int left = kMostAround;
  HalfEdge g = twins_[previous_in_face(h)];
  for (; g != kNoTwin && g != h; g = twins_[previous_in_face(g)])
    if (chart(face_of(g)) == c || --left == 0) return true;
  if (g == h) return false;
  for (g = twins_[h]; g != kNoTwin; g = twins_[next_in_face(g)])  // an open fan: the rest lies the other way round
    if (chart(face_of(g)) == c || --left == 0) return true;
  return false;
}

}  // namespace ramcdb::chartify
