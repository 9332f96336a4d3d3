#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "ramcdb/repository.h"

/// Edits that the library does itself. Smoothing and maps only move vertices, in regions of any size: a few charts are
/// in memory at a time, what else there is lies in a temporary file in the repository's folder.
namespace ramcdb {

/// Laplacian smoothing with uniform weights, as OpenMesh's smoother does it: in every iteration each vertex goes
/// `lambda` of the way to the mean of its neighbours, all at once.
///
/// It counts in whole 2^-24ths of a lattice step from the mesh's positions on, and snaps to the lattice once, at the
/// end. Neighbours are summed up face by face, each face giving both its other corners: inside a surface that is every
/// neighbour twice; polygons count as the triangles that they are kept as. All sums are of whole numbers, so charts,
/// threads and memory change nothing about the result.
///
/// These stay exactly where they are: vertices of the mesh's own border and of non-manifold edges, vertices that charts
/// outside the region share, and vertices without a face.
struct SmoothOptions {
  unsigned iterations = 1;                        ///< 1..1,000,000
  double lambda = 0.5;                            ///< above 0, at most 1; rounded to 2^-20ths
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes for what is held at a time, beside the index
  CommitOptions commit;
};

/// An affine map, row-major: p becomes m * (p, 1). The last row is 0, 0, 0, 1.
using Matrix = std::array<double, 16>;

[[nodiscard]] Matrix translation(const Point& by);
/// Scales about a point. \param by per axis
[[nodiscard]] Matrix scaling(const Point& by, const Point& center);
/// Turns about the axis through a point, counter-clockwise seen from the axis' tip. Throws invalid_argument for an axis
/// without a direction.
[[nodiscard]] Matrix rotation(const Point& axis, double degrees, const Point& center);

/// Moves all vertices of a region, or each by its share.
///
/// Normals kept as attributes (three floats) turn with the surface, their lengths kept: by the inverse transpose of the
/// map's derivative, with a falloff of what the map then is at their place. Those of vertices and corners follow their
/// vertex, those of faces all three.
struct TransformOptions {
  Matrix matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  /// 0: all vertices of the region's charts move, and no others. Else a distance in model units: every vertex moves by
  /// its own share, which falls smoothly from 1 inside the region's shapes to 0 so far outside. Shapes are then boxes,
  /// spheres, points (NearestTo) and the whole mesh.
  double falloff = 0;
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes for what is held at a time, beside the index
  CommitOptions commit;
};

/// Fewer faces: edges inside charts collapse to one of their ends where that changes the surface least (quadrics). What
/// stays is where it was, with its values. Charts are decimated apart, each by its share, and all that charts share
/// stays, as do the mesh's own border and non-manifold places; so a small share may not be reached. Charts that end up
/// small are merged with others, which then can lose more in a second run. Polygons whose triangles change become
/// triangles. Holds the region in memory.
struct DecimateOptions {
  double ratio = 0.5;                  ///< the share of faces (triangles) that is to stay, 0..1
  std::optional<std::uint64_t> faces;  ///< instead: how many are to stay of the region's
  CommitOptions commit;
};

}  // namespace ramcdb
