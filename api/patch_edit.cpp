#include "api/patch_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "api/edited_region_builder.h"
#include "api/value_interpolation.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::string place(const Point& p) { return fmt::format("near {:.9g},{:.9g},{:.9g}", p.x, p.y, p.z); }

class PatchReader {
 public:
  explicit PatchReader(const Patch& patch)
      : patch_(patch),
        mesh_(patch.mesh()),
        region_(patch.region()),
        builder_(patch.base().impl(), region_),
        vertex_of_(mesh_.n_vertices(), kNew) {}

  EditedRegion run() {
    claim_vertices();
    for (const auto v : mesh_.all_vertices())
      if (is_there(v)) add_vertex(v);
    std::vector<bool> taken(region_.faces.size(), false);
    for (const auto f : mesh_.all_faces())
      if (!(mesh_.has_face_status() && mesh_.status(f).deleted())) add_face(f, taken);
    EditedRegion edited = builder_.finish(patch_.attributes());
    interpolate_new(region_, edited);
    return edited;
  }

 private:
  using Vertex = Patch::Mesh::VertexHandle;
  using Face = Patch::Mesh::FaceHandle;

  [[nodiscard]] bool is_there(Vertex v) const { return !(mesh_.has_vertex_status() && mesh_.status(v).deleted()); }
  [[nodiscard]] Point position(Vertex v) const {
    const auto p = mesh_.point(v);
    return {p[0], p[1], p[2]};
  }

  /// The region's vertex that a patch vertex says to be.
  [[nodiscard]] std::uint32_t said(Vertex v) const {
    return mesh_.property(patch_.key_property(), v) ? mesh_.property(patch_.region_property(), v) : kNew;
  }

  /// Operations that copy properties make several vertices say to be one of the region: the one that stayed is it, or
  /// else the first.
  void claim_vertices() {
    owner_.resize(region_.points.size());
    for (const auto v : mesh_.all_vertices()) {
      const std::uint32_t source = is_there(v) ? said(v) : kNew;
      if (source == kNew) continue;
      if (!owner_[source].is_valid() || (!stays(owner_[source]) && stays(v))) owner_[source] = v;
    }
  }

  [[nodiscard]] bool stays(Vertex v) const {
    const Point p = patch_.base().position(region_, said(v)), q = position(v);
    return p.x == q.x && p.y == q.y && p.z == q.z;
  }

  void add_vertex(Vertex v) {
    const auto index = static_cast<std::size_t>(v.idx());
    std::uint32_t source = said(v);
    if (source != kNew && owner_[source] != v) {
      if (!patch_.is_copied(source)) {
        source = kNew;
      } else {
        check_copy(v, owner_[source]);
        vertex_of_[index] = added(owner_[source]);
        return;
      }
    }
    if (vertex_of_[index] == kNew) vertex_of_[index] = builder_.add_vertex(source, position(v));
  }

  /// The vertex that owns a region's vertex may come behind its copies.
  std::uint32_t added(Vertex owner) {
    std::uint32_t& vertex = vertex_of_[static_cast<std::size_t>(owner.idx())];
    if (vertex == kNew) vertex = builder_.add_vertex(said(owner), position(owner));
    return vertex;
  }

  void check_copy(Vertex v, Vertex owner) const {
    const MeshRecord& record = patch_.base().impl().record();
    const Point p = record.rounded(position(v)), q = record.rounded(position(owner));
    if (record.exact ? p == q : record.lattice.snap(p) == record.lattice.snap(q)) return;
    throw Error(Errc::invalid_argument, "two copies of one non-manifold vertex moved apart", place(p),
                "move vertices with equal keys together");
  }

  void add_face(Face f, std::vector<bool>& taken) {
    Triangle vertices{}, sources{};
    std::size_t i = 0;
    for (auto v = mesh_.cfv_iter(f); v.is_valid() && i < 3; ++v, ++i) {
      vertices[i] = vertex_of_[static_cast<std::size_t>(v->idx())];
      sources[i] = owner_source(*v);
    }
    const std::uint32_t said = mesh_.property(patch_.region_face_property(), f);
    if (said && said <= region_.faces.size() && !taken[said - 1]) {
      for (int turn = 0; turn < 3; ++turn) {
        if (sources == region_.faces[said - 1]) {
          taken[said - 1] = true;
          builder_.add_face(vertices, said - 1);
          return;
        }
        std::rotate(vertices.begin(), vertices.begin() + 1, vertices.end());
        std::rotate(sources.begin(), sources.begin() + 1, sources.end());
      }
    }
    builder_.add_face(vertices, kNew);
  }

  /// What a vertex really is.
  [[nodiscard]] std::uint32_t owner_source(Vertex v) const {
    const std::uint32_t source = said(v);
    return source == kNew || owner_[source] == v || patch_.is_copied(source) ? source : kNew;
  }

  const Patch& patch_;
  const Patch::Mesh& mesh_;
  const RegionMesh& region_;
  EditedRegionBuilder builder_;
  std::vector<std::uint32_t> vertex_of_;  ///< patch vertices -> edited ones
  std::vector<Vertex> owner_;             ///< region vertices -> the patch vertex that each is
};

}  // namespace

EditedRegion edited_in_patch(const Patch& patch) { return PatchReader(patch).run(); }

EditedRegion edited_in_patches(std::span<const std::unique_ptr<Patch>> patches, const RegionMesh& region) {
  EditedRegion all = unedited(region);
  for (const auto& patch : patches) all = joined(all, edited_in_patch(*patch), patch->region(), region);
  return all;
}

}  // namespace ramcdb::detail
