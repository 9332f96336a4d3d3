#pragma once

#include <span>
#include <vector>

#include "api/edited_region.h"
#include "api/snapshot_impl.h"

namespace ramcdb::detail {

/// Puts an edited region together, vertex by vertex and face by face.
class EditedRegionBuilder {
 public:
  /// Both must outlive the builder.
  EditedRegionBuilder(const Snapshot::Impl& at, const RegionMesh& region);

  /// \param source vertex of the region, or kNew
  /// \param position model units; it becomes what the mesh keeps of it. Throws as Lattice::snap.
  std::uint32_t add_vertex(std::uint32_t source, const Point& position);
  /// \param source face of the region, whose vertices these are corner by corner, or kNew
  std::uint32_t add_face(const Triangle& vertices, std::uint32_t source);
  /// A polygon of new faces by its corners: 3 * face + 0..2 each.
  void add_polygon(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> faces);

  /// What is new came from another mesh, which has the region's attributes: its values, and its polygons of which all
  /// faces came along. The mesh must outlive the builder.
  /// \param vertices,faces per vertex and face of `from` what it became here, if that is new; else kNew
  void take_new(const RegionMesh& from, std::vector<std::uint32_t> vertices, std::vector<std::uint32_t> faces);

  /// Polygons of the region of which all faces stay are kept. Of what is new the values are
  /// NaN where take_new() does not say them.
  /// \param attributes the values of what stays, in the numbering of the region
  [[nodiscard]] EditedRegion finish(std::span<const Attribute> attributes);

 private:
  void keep_polygons();
  void take_values(std::span<const Attribute> attributes);
  void take_new_values(std::size_t attribute);

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  EditedRegion out_;
  const RegionMesh* new_from_ = nullptr;
  std::vector<std::uint32_t> new_vertices_, new_faces_;
};

}  // namespace ramcdb::detail
