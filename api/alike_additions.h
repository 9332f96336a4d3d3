#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/edited_region.h"
#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// What two edits of one region added alike, as when one of them holds what was taken over from the other before: new
/// faces over the same vertices, where new vertices are the same when they lie at one place.
struct AlikeAdditions {
  std::vector<std::uint32_t> vertex;         ///< per vertex of ours, the new one of theirs that it is, or kNew
  std::vector<bool> faces, faces_of_theirs;  ///< per face: both sides have it
  /// Faces of ours that theirs has too, in something new that theirs has otherwise.
  std::vector<std::uint32_t> disputed;
};

/// \param our_places,their_places per vertex, model units
/// \param base_vertex per vertex of theirs the base's that it is, or kNew
/// \param is_new per face of theirs
[[nodiscard]] AlikeAdditions find_alike_additions(const EditedRegion& ours, std::span<const Point> our_places,
                                                  const RegionMesh& theirs, std::span<const Point> their_places,
                                                  std::span<const std::uint32_t> base_vertex,
                                                  const std::vector<bool>& is_new);

}  // namespace ramcdb::detail
