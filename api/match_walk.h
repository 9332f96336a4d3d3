#pragma once

#include <cstdint>
#include <vector>

#include "api/match_state.h"

namespace ramcdb::detail {

/// Walks over both surfaces in lock-step: beside two faces with a common edge of paired vertices lie two faces that are
/// the same too, unless something speaks against it.
class MatchWalk {
 public:
  /// in_place: only faces whose vertices did not move. moved: vertices may have moved, but have as many faces as ever.
  enum class Over { in_place, moved };
  MatchWalk(MatchState& state, Over over) : state_(state), over_(over) {}

  /// Goes on from all that is paired.
  void from_everywhere();
  /// Begins at one face; false when its vertices cannot be paired.
  bool from_face(std::uint32_t face, FaceMatch match);

  /// Vertices of `to` that were paired on the way.
  [[nodiscard]] const std::vector<std::uint32_t>& paired() const { return paired_; }

 private:
  void go();
  void look(std::uint32_t face);
  bool pair_faces(std::uint32_t face, FaceMatch match);
  [[nodiscard]] bool may_pair(std::uint32_t v, std::uint32_t w) const;

  MatchState& state_;
  Over over_;
  std::vector<std::uint32_t> paired_;
  std::size_t done_ = 0;  ///< of `paired_`, vertices whose faces were looked at
};

/// Takes back what a walk over moved vertices found where it came upon another connectivity: there equal numbers of
/// faces were a coincidence. So they may be at a vertex of one or two faces, where most of the vertices beside it have
/// lost or got some. Returns how many pairs stay.
std::size_t keep_what_fits(MatchState& state, const std::vector<std::uint32_t>& paired);

/// Pairs faces whose vertices all lie in the same places, in order, where places do not tell vertices apart.
void match_faces_in_place(MatchState& state);

/// Begins walks where both surfaces have a face like no other, by the connectivity around it. For what no position and
/// no id leads to.
void walk_from_rare_faces(MatchState& state);

}  // namespace ramcdb::detail
