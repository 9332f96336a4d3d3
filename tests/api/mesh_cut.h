#pragma once

#include <map>
#include <vector>

#include "tests/api/temp_repository.h"

namespace ramcdb::test {

using PlacedFace = std::vector<LatticePoint>;  ///< turned to its smallest sequence

[[nodiscard]] inline PlacedFace turned(PlacedFace face) {
  PlacedFace best = face;
  for (std::size_t turn = 1; turn < face.size(); ++turn) {
    std::rotate(face.begin(), face.begin() + 1, face.end());
    best = std::min(best, face);
  }
  return best;
}

/// Where the faces and the vertices without faces of a mesh are, in its order.
struct PlacedMesh {
  std::vector<PlacedFace> faces;
  std::map<std::uint32_t, LatticePoint> isolated;  ///< by vertex

  PlacedMesh(const std::vector<LatticePoint>& points, const std::vector<std::uint32_t>& corners,
             const std::vector<std::uint32_t>& sizes) {
    for (std::uint32_t v = 0; v < points.size(); ++v) isolated.emplace(v, points[v]);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < (sizes.empty() ? corners.size() / 3 : sizes.size()); ++f) {
      PlacedFace face;
      for (std::size_t end = corner + (sizes.empty() ? 3 : sizes[f]); corner < end; ++corner) {
        face.push_back(points[corners[corner]]);
        isolated.erase(corners[corner]);
      }
      faces.push_back(turned(std::move(face)));
    }
  }
  PlacedMesh(const mesh_file::MeshData& mesh, const Lattice& lattice)
      : PlacedMesh(snapped(lattice, mesh.positions), mesh.corners, mesh.face_sizes) {}
  [[nodiscard]] static PlacedMesh of(const RegionMesh& region) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t c : region.polygon_corners) corners.push_back(region.faces[c / 3][c % 3]);
    if (region.polygon_sizes.empty())
      for (const Triangle& t : region.faces) corners.insert(corners.end(), t.begin(), t.end());
    return {region.points, corners, region.polygon_sizes};
  }
};

/// How often things stand in a mesh.
template <class Thing>
class Counted {
 public:
  void add(const Thing& thing) { ++count_[thing]; }
  /// False when there is none left.
  bool take(const Thing& thing) {
    const auto it = count_.find(thing);
    if (it == count_.end()) return false;
    if (--it->second == 0) count_.erase(it);
    return true;
  }
  [[nodiscard]] bool empty() const { return count_.empty(); }
  [[nodiscard]] const std::map<Thing, std::size_t>& left() const { return count_; }

 private:
  std::map<Thing, std::size_t> count_;
};

/// Some faces of a mesh and some of its vertices without faces, as a mesh of their own with their attributes.
[[nodiscard]] inline mesh_file::MeshData cut_out(const mesh_file::MeshData& mesh, const std::vector<bool>& faces,
                                                 const std::vector<std::uint32_t>& isolated) {
  mesh_file::MeshData out;
  out.references = mesh.references;
  std::vector<std::size_t> kept_faces, kept_corners, kept_vertices(isolated.begin(), isolated.end());
  for (std::size_t f = 0, corner = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    if (faces[f]) {
      kept_faces.push_back(f);
      if (!mesh.face_sizes.empty()) out.face_sizes.push_back(size);
      for (std::uint32_t i = 0; i < size; ++i) {
        kept_corners.push_back(corner + i);
        kept_vertices.push_back(mesh.corners[corner + i]);
      }
    }
    corner += size;
  }
  std::ranges::sort(kept_vertices);
  kept_vertices.erase(std::ranges::unique(kept_vertices).begin(), kept_vertices.end());
  std::vector<std::uint32_t> to(mesh.positions.size());
  for (std::size_t i = 0; i < kept_vertices.size(); ++i) {
    to[kept_vertices[i]] = static_cast<std::uint32_t>(i);
    out.positions.push_back(mesh.positions[kept_vertices[i]]);
  }
  for (const std::size_t c : kept_corners) out.corners.push_back(to[mesh.corners[c]]);
  for (const Attribute& attribute : mesh.attributes) {
    Attribute& part = out.attributes.emplace_back(Attribute{attribute.info, {}});
    const std::uint32_t n = attribute.info.components;
    for (const std::size_t at : attribute.info.of == AttributeOf::vertex   ? kept_vertices
                                : attribute.info.of == AttributeOf::corner ? kept_corners
                                                                           : kept_faces)
      for (std::size_t i = 0; i < n; ++i) part.values.push_back(attribute.values[at * n + i]);
  }
  return out;
}

}  // namespace ramcdb::test
