#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/snapshot.h"

namespace ramcdb {

struct PatchTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};

/// A region checked out for editing, as an OpenMesh mesh in model units. Every vertex and face knows where it came
/// from. Where the region is not manifold, OpenMesh cannot hold it as one surface: a mesh vertex is then several patch
/// vertices with the same key, which have to move together (commit refuses copies that went apart).
class Patch {
 public:
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<PatchTraits>;

  explicit Patch(const Snapshot& snapshot, RegionMesh region);

  [[nodiscard]] Mesh& mesh() { return mesh_; }
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Snapshot& base() const { return base_; }
  [[nodiscard]] const RegionMesh& region() const { return region_; }

  /// The attributes of the region, to be read and changed: values per vertex of `region()` (region_property() says
  /// which one a patch vertex is), per corner (3 * face + 0..2) or per face of it. Only numbers may change.
  [[nodiscard]] std::vector<Attribute>& attributes() { return attributes_; }
  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
  /// The one of this name; null when there is none.
  [[nodiscard]] Attribute* attribute(std::string_view name);

  /// Vertex property: the vertex's VertexKey::packed().
  [[nodiscard]] OpenMesh::VPropHandleT<std::uint64_t> key_property() const { return key_; }
  /// Face property: the value of the face's ChartId.
  [[nodiscard]] OpenMesh::FPropHandleT<std::uint32_t> chart_property() const { return chart_; }
  /// Vertex property: the position in `region()` of the vertex.
  [[nodiscard]] OpenMesh::VPropHandleT<std::uint32_t> region_property() const { return region_vertex_; }

  /// True for vertices that charts outside the patch share: they may move, and their charts follow.
  [[nodiscard]] bool on_outer_border(Mesh::VertexHandle v) const;
  /// How many patch vertices are copies of another (0 on a manifold region).
  [[nodiscard]] std::uint64_t copies() const { return copies_; }

 private:
  Snapshot base_;
  RegionMesh region_;
  std::vector<Attribute> attributes_;
  Mesh mesh_;
  OpenMesh::VPropHandleT<std::uint64_t> key_;
  OpenMesh::FPropHandleT<std::uint32_t> chart_;
  OpenMesh::VPropHandleT<std::uint32_t> region_vertex_;
  std::uint64_t copies_ = 0;
};

}  // namespace ramcdb
