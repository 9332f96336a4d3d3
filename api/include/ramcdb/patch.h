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

/// A region checked out for editing, as an OpenMesh mesh in model units. Anything may be done to it: vertices may move,
/// faces and vertices come and go (with status attributes or garbage collection, as OpenMesh likes). Every vertex and
/// face knows where it came from, by properties that OpenMesh's own operations keep with it; what has none is new.
/// Where the region is not manifold, OpenMesh cannot hold it as one surface: a mesh vertex is then several patch
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
  /// which one a patch vertex is), per corner (3 * face + 0..2) or per face of it. Only numbers may change. New
  /// vertices and faces get values from the surface that was there.
  [[nodiscard]] std::vector<Attribute>& attributes() { return attributes_; }
  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
  /// The one of this name; null when there is none.
  [[nodiscard]] Attribute* attribute(std::string_view name);

  /// Vertex property: the vertex's VertexKey::packed(); 0 for a new one.
  [[nodiscard]] OpenMesh::VPropHandleT<std::uint64_t> key_property() const { return key_; }
  /// Face property: the value of the face's ChartId.
  [[nodiscard]] OpenMesh::FPropHandleT<std::uint32_t> chart_property() const { return chart_; }
  /// Vertex property: the position in `region()` of the vertex; nothing for a new one, whose key is 0.
  [[nodiscard]] OpenMesh::VPropHandleT<std::uint32_t> region_property() const { return region_vertex_; }
  /// Face property: the position in `region()` of the face, plus 1; 0 for a new one.
  [[nodiscard]] OpenMesh::FPropHandleT<std::uint32_t> region_face_property() const { return region_face_; }

  /// True for vertices on edges that charts outside the patch share: they may move, and their charts follow; but these
  /// edges have to keep their faces, however these look.
  [[nodiscard]] bool on_outer_border(Mesh::VertexHandle v) const;
  /// How many patch vertices are copies of another (0 on a manifold region).
  [[nodiscard]] std::uint64_t copies() const { return copies_; }
  /// Whether a vertex of `region()` is several patch vertices.
  [[nodiscard]] bool is_copied(std::uint32_t region_vertex) const { return copied_[region_vertex]; }

 private:
  Snapshot base_;
  RegionMesh region_;
  std::vector<Attribute> attributes_;
  Mesh mesh_;
  OpenMesh::VPropHandleT<std::uint64_t> key_;
  OpenMesh::FPropHandleT<std::uint32_t> chart_;
  OpenMesh::VPropHandleT<std::uint32_t> region_vertex_;
  OpenMesh::FPropHandleT<std::uint32_t> region_face_;
  std::vector<bool> copied_;
  std::uint64_t copies_ = 0;
};

}  // namespace ramcdb
