#pragma once

#include <cstdint>
#include <vector>

#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// Says of a vertex or face that its region does not have it.
inline constexpr std::uint32_t kNew = ~std::uint32_t{0};

/// A region as an edit leaves it, and what of it the region was already.
struct EditedRegion {
  /// As it is now. `charts`, `keys`, `outer_border` and `chart_of_face` stay empty; `exact`, attributes and polygons
  /// are there where the region has them. Vertices in no face are isolated ones.
  RegionMesh mesh;
  std::vector<std::uint32_t> vertex_source;  ///< per vertex the region's that it is, or kNew; none twice
  /// Per face the region's that it still is, with the same vertices corner by corner, or kNew; none twice.
  std::vector<std::uint32_t> face_source;
  ChartId home{};  ///< the chart that takes what is new and touches nothing; when not said, the region's first
};

/// A region of which nothing was edited.
[[nodiscard]] EditedRegion unedited(const RegionMesh& region);

/// The same edit of another region: of other charts, or of the same ones at another version that left them as they
/// were. Charts that `to` has in addition stay as they are. REQUIRES: the charts that both have were decoded from equal
/// blobs; what the edit changes, and what it builds on, is in both. \param without per vertex of the edit, in no face
/// of it, whether it is left out
[[nodiscard]] EditedRegion transferred(const EditedRegion& edited, const RegionMesh& from, const RegionMesh& to,
                                       const std::vector<bool>& without = {});

/// An edit of `region` and then another of some of its charts, which the first one left alone: both as one. Throws
/// invalid_argument, with places, where both moved a vertex that they share, or gave it values, and not the same.
/// \param second an edit of `part`, charts of `region`
[[nodiscard]] EditedRegion joined(const EditedRegion& first, const EditedRegion& second, const RegionMesh& part,
                                  const RegionMesh& region);

/// Where a mesh has polygons, makes the faces whose polygon is kNew polygons of three corners.
void add_triangles(RegionMesh& mesh);

/// The attributes of an edit in the numbering of its region: what did not survive keeps the region's values.
[[nodiscard]] std::vector<Attribute> attributes_in_region(const EditedRegion& edited, const RegionMesh& region);

}  // namespace ramcdb::detail
