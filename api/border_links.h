#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/geometry.h"

namespace ramcdb::detail {

/// A surface, and which of its vertices faces outside it have, too.
struct BorderedSurface {
  std::span<const Triangle> faces;
  std::span<const std::uint32_t> shared;  ///< per vertex the number of the shared vertex that it is, or kNowhere
};

/// Of the vertices that two surfaces share with faces outside both, those where it takes these faces to tell how much
/// the numbers of non-manifold vertices and edges, inconsistent edges and duplicate faces differ between the two.
/// Around all others, what faces outside can meet is the same: edges and faces of shared vertices, and which of these
/// edges hang together around a vertex. So an edit that leaves the border's edges alone needs no chart beside it,
/// whatever it did to the faces there. Faces are triangles, not parts of polygons. \param count how many shared
/// vertices there are
[[nodiscard]] std::vector<bool> changed_links(const BorderedSurface& before, const BorderedSurface& after,
                                              std::uint32_t count);

}  // namespace ramcdb::detail
