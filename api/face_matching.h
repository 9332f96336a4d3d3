#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/match_state.h"
#include "api/surface.h"

namespace ramcdb::detail {

/// Which vertices and faces of `from` those of `to` are.
struct SurfaceMatch {
  VertexPairs vertices;
  std::vector<FaceMatch> faces;  ///< per face of `to`; no face of `from` twice
};

/// Finds what two surfaces have in common when one was renumbered, its vertices moved and some of its faces replaced.
/// Vertices are recognized by ids, by their positions and the faces around them, by an unchanged order of all faces, by
/// lock-step walks from what is known, and by connectivity alone; a face is the same when all its vertices are.
/// Vertices without faces are left to the caller. The result depends on the arguments only.
/// \param ids per vertex of `to` the vertex that its id names, kNone without; empty without ids
/// \param known per vertex of `to` the vertex that it is for sure, kNone without, none twice; empty without
[[nodiscard]] SurfaceMatch match_surfaces(const Surface& from, const Surface& to, std::vector<std::uint32_t> ids = {},
                                          std::span<const std::uint32_t> known = {});

struct Matching {
  std::vector<FaceMatch> matches;  ///< per face of `from`, its face of `to`
  std::uint64_t unmatched = 0;
};

/// The same the other way round, for surfaces whose vertices have no ids.
[[nodiscard]] Matching match_faces(const Surface& from, const Surface& to);

}  // namespace ramcdb::detail
