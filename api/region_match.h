#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/face_matching.h"
#include "api/region_faces.h"

namespace ramcdb::detail {

/// A mesh to find a region in: of a file, or of another version.
struct OtherMesh {
  std::span<const Point> positions;                ///< model units, as the mesh would keep them
  std::span<const LatticePoint> points;            ///< the same on the lattice
  std::span<const std::uint32_t> corners, firsts;  ///< polygons, as in Surface
  /// Per vertex VertexKey::packed() of the region's version, where they can be trusted; else empty. New vertices have
  /// anything else; tools also copy ids to new vertices.
  std::span<const std::uint64_t> ids;
  /// The file has to write a vertex several times (STL; glTF at seams): vertices on one lattice point that come from
  /// one vertex of the region, or are all new, are one.
  bool splits_vertices = false;
  /// Per vertex the region's that it is for sure, or RegionMatch::kNone, none twice; empty where nothing is.
  std::span<const std::uint32_t> known = {};

  [[nodiscard]] Surface surface() const { return {points, corners, firsts}; }
};

/// What each part of another mesh is in a region.
struct RegionMatch {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// A vertex of the edited mesh: the region's vertex that it is, or kNone when it is new; and a vertex of the other
  /// mesh that has its position. Isolated vertices of the region that the other mesh leaves out, having none at all
  /// (as STL), stay: they have kNone there.
  struct Vertex {
    std::uint32_t region, other;
    friend bool operator==(const Vertex&, const Vertex&) = default;
  };

  std::vector<std::uint32_t> vertex;  ///< per vertex of the other mesh: position in `vertices`
  std::vector<Vertex> vertices;       ///< every vertex of the edited mesh, no vertex of the region twice
  /// Per face of the other mesh: the face of `RegionFaces` that survives in it, with the same vertices in the same
  /// cyclic order, and its turn; none for a new face. No face of the region twice.
  std::vector<FaceMatch> faces;
  /// Of the region, vertices without faces that moved, and were paired in order of position: each may be another.
  std::vector<std::uint32_t> guessed;
  std::uint64_t faces_gone = 0, vertices_gone = 0;  ///< of the region, not in the other mesh

  /// Nothing came or went; vertices may have moved.
  [[nodiscard]] bool same_connectivity() const;
};

/// Finds a region in another mesh, whatever a program did to it in between.
[[nodiscard]] RegionMatch match_region(const RegionMesh& region, const RegionFaces& faces, const OtherMesh& other);

/// A region as the other mesh writes it: with its polygons, or as their triangles.
struct MatchedRegion {
  RegionFaces faces;
  RegionMatch match;
};
/// Programs that know no polygons write triangles: a mesh of triangles is compared with the region's triangles where
/// most of its faces, and more than otherwise, are found that way. `region` must outlive the result.
[[nodiscard]] MatchedRegion match_region(const RegionMesh& region, const OtherMesh& other);

/// Finds a region in what other charts of the same mesh hold, such as another version of it, triangle by triangle.
/// \param equal charts that both hold in the same state, decoded from the same blobs: these tell who their vertices are
[[nodiscard]] RegionMatch match_region(const RegionMesh& region, const RegionMesh& mesh, const Lattice& lattice,
                                       std::span<const ChartId> equal);

}  // namespace ramcdb::detail
