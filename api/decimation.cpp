#include "api/decimation.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>

namespace ramcdb::detail {
namespace {

struct DecimationTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DecimationTraits>;
using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;

/// Forbids collapses that would join two locked vertices by a new edge.
template <class MeshT>
class NoNewLockedEdgesT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(NoNewLockedEdgesT, MeshT, NoNewLockedEdges);

  explicit NoNewLockedEdgesT(MeshT& mesh) : Base(mesh, true) {}

  float collapse_priority(const CollapseInfo& collapse) override {
    const MeshT& mesh = collapse.mesh;
    if (!mesh.status(collapse.v1).locked()) return Base::LEGAL_COLLAPSE;
    for (const auto v : mesh.vv_range(collapse.v0))
      if (v != collapse.v1 && v != collapse.vl && v != collapse.vr && mesh.status(v).locked())
        return Base::ILLEGAL_COLLAPSE;
    return Base::LEGAL_COLLAPSE;
  }
};

std::vector<Mesh::VertexHandle> add_vertices(Mesh& mesh, std::span<const Point> positions,
                                             const std::vector<bool>& locked) {
  std::vector<Mesh::VertexHandle> handles;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    // Quadrics hold squares of coordinates: far from the origin these would leave nothing of the error.
    const Point &p = positions[v], &origin = positions[0];
    handles.push_back(mesh.add_vertex({p.x - origin.x, p.y - origin.y, p.z - origin.z}));
    mesh.status(handles.back()).set_locked(locked[v]);
  }
  return handles;
}

/// Per face of the mesh that was built the face that it was; the others' vertices are locked.
std::vector<std::uint32_t> add_faces(Mesh& mesh, std::span<const Triangle> faces,
                                     const std::vector<Mesh::VertexHandle>& handles) {
  std::vector<std::uint32_t> source;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    const bool taken = a != b && b != c && c != a && mesh.add_face(handles[a], handles[b], handles[c]).is_valid();
    if (taken)
      source.push_back(f);
    else
      for (const std::uint32_t v : faces[f]) mesh.status(handles[v]).set_locked(true);
  }
  for (const auto v : mesh.vertices())
    if (mesh.is_boundary(v)) mesh.status(v).set_locked(true);
  return source;
}

void decimate(Mesh& mesh, std::size_t target_faces) {
  mesh.update_face_normals();
  Decimater decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
  NoNewLockedEdgesT<Mesh>::Handle chords;
  decimater.add(quadric);
  decimater.add(flipping);
  decimater.add(chords);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  decimater.decimate_to_faces(0, target_faces);
}

/// The corners of a face in the order of what it was: turned so that most stay.
Triangle aligned(const Triangle& now, const Triangle& was) {
  Triangle best = now, turned = now;
  const auto same = [&](const Triangle& t) {
    return (t[0] == was[0] ? 1 : 0) + (t[1] == was[1] ? 1 : 0) + (t[2] == was[2] ? 1 : 0);
  };
  for (int turn = 0; turn < 2; ++turn) {
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    if (same(turned) > same(best)) best = turned;
  }
  return best;
}

}  // namespace

QuietOpenMesh::QuietOpenMesh() : was_enabled_(omerr().is_enabled()) { omerr().disable(); }
QuietOpenMesh::~QuietOpenMesh() {
  if (was_enabled_) omerr().enable();
}

DecimatedFaces decimate_faces(std::span<const Point> positions, std::span<const Triangle> faces,
                              const std::vector<bool>& locked, std::size_t target_faces) {
  Mesh mesh;
  const std::vector<Mesh::VertexHandle> handles = add_vertices(mesh, positions, locked);
  const std::vector<std::uint32_t> source = add_faces(mesh, faces, handles);
  const std::size_t left_alone = faces.size() - source.size();
  if (target_faces < faces.size() && left_alone < faces.size())
    decimate(mesh, target_faces > left_alone ? target_faces - left_alone : 1);

  DecimatedFaces out;
  std::size_t next = 0;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (next == source.size() || source[next] != f) {
      out.faces.push_back(faces[f]);
      out.source_face.push_back(f);
      continue;
    }
    const Mesh::FaceHandle face(static_cast<int>(next++));
    if (mesh.status(face).deleted()) continue;
    Triangle now{};
    std::size_t i = 0;
    for (const auto v : mesh.fv_range(face)) now[i++] = static_cast<std::uint32_t>(v.idx());
    out.faces.push_back(aligned(now, faces[f]));
    out.source_face.push_back(f);
  }
  for (const Mesh::VertexHandle v : handles)
    if (!mesh.status(v).deleted()) out.kept.push_back(static_cast<std::uint32_t>(v.idx()));
  return out;
}

}  // namespace ramcdb::detail
