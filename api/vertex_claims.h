#pragma once

#include <cstdint>
#include <vector>

#include "api/match_state.h"

namespace ramcdb::detail {

/// Guesses of which vertex each vertex of `to` is, several of which may name the same; the faces and edges that they
/// bring back decide between them.
class VertexClaims {
 public:
  /// \param claims per vertex of `to`, kNone without. Pairs that are known already count as claims.
  VertexClaims(MatchState& state, std::vector<std::uint32_t> claims);

  /// How many faces of `to` are faces of `from` if all claims are true.
  [[nodiscard]] std::uint64_t faces() const { return faces_; }
  /// Pairs each claimed vertex with the vertex of most faces; of equals with one in its place, then with the first.
  /// \param trusted whether claims hold that bring back no face
  void settle_by_faces(MatchState& state, bool trusted) const;
  /// The same for what is left, by edges.
  void settle_by_edges(MatchState& state) const;

 private:
  void count_faces(MatchState& state);
  void settle(MatchState& state, const std::vector<std::uint32_t>& votes, std::uint32_t least) const;

  std::vector<std::uint32_t> claims_, votes_;
  std::uint64_t faces_ = 0;
};

/// Vertices of `to` that are not paired claim the vertex that lies, with its faces, where they do; of several at one
/// point, the one with equal faces around it.
[[nodiscard]] std::vector<std::uint32_t> claims_by_place(const MatchState& state);

/// Vertices as told by faces in unchanged order.
struct OrderedPairs {
  VertexPairs pairs;
  std::uint64_t contradictions = 0;  ///< vertices that lie where other ones lay
};
/// Empty where the files' faces do not go with each other one by one, with a vertex for each vertex.
[[nodiscard]] std::vector<OrderedPairs> pairs_by_order(const MatchState& state);

}  // namespace ramcdb::detail
