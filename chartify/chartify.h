#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/progress.h"
#include "ramcdb/chart.h"
#include "ramcdb/geometry.h"

namespace ramcdb::chartify {

/// No face, chart, vertex or whatever else is counted from 0.
inline constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A triangle mesh on the lattice, as it is: open, non-manifold, with degenerate and duplicate faces, isolated
/// vertices. Faces index positions.
struct IndexedMesh {
  std::vector<LatticePoint> positions;
  std::vector<Triangle> faces;
  /// Per face the polygon that it is part of, 0, 1, ...: its faces end up in one chart, and are adjacent over edges
  /// where other faces meet as well. Empty: every face is alone.
  std::vector<std::uint32_t> polygon_of_face = {};
};

/// A mesh in canonical order, and where its parts came from.
struct CanonicalMesh {
  IndexedMesh mesh;
  std::vector<std::uint32_t> source_vertex;  ///< canonical -> input
  std::vector<std::uint32_t> source_face;    ///< canonical -> input
};

/// Puts faces along a Hilbert curve and turns each to its smallest corner first, vertices in the order of their first
/// face, isolated ones last. The result depends on the geometry only, not on the order or rotation of the input's faces
/// nor on its vertex order (ties between faces with equal positions are broken by their neighbours' positions, and only
/// then by input order), nor on the number of threads.
[[nodiscard]] CanonicalMesh canonical_order(const IndexedMesh& mesh, unsigned threads = 1,
                                            const Progress& progress = {});

enum class Method {
  refined,  ///< growth, Lloyd, rebalancing, face moves and wire straightening (the default)
  paper,    ///< Lloyd with cost (1)-(3) and the repairs of section 4.3 of the paper, for comparison
};

/// Larger charts would be too large for the chart codec.
inline constexpr std::uint32_t kMostTargetFaces = 200'000;

struct Options {
  std::uint32_t target_faces = 5000;  ///< 1 .. kMostTargetFaces
  Method method = Method::refined;
  unsigned threads = 1;  ///< changes the time, never the result
  Progress progress = {};
};

/// Cuts a mesh into charts. REQUIRES: canonical order. Returns for every face the chart it belongs to, and for every
/// isolated vertex likewise; every chart is one piece, or holds whole components. Chart numbers are 0 .. chart_count -
/// 1 along the Hilbert curve, none is empty.
struct Charts {
  std::uint32_t chart_count = 0;
  std::vector<std::uint32_t> chart_of_face;
  std::vector<std::uint32_t> chart_of_isolated_vertex;  ///< in the order of the mesh's isolated vertices
};
/// Errors: invalid_argument for a target out of range.
[[nodiscard]] Charts chartify(const IndexedMesh& mesh, const Options& options);
struct Adjacency;
/// Where the mesh's adjacency is known (half_edge_twins.h).
[[nodiscard]] Charts chartify(const IndexedMesh& mesh, const Adjacency& adjacency, const Options& options);

/// Likewise, from a first cut by somebody else: only the later stages of Method::refined. Components of less than half
/// the target are packed as chartify() packs them, whatever the cut says of them.
/// \param chart_of_face per face a chart, counted from 0
/// Errors: invalid_argument for a target out of range, or another number of faces.
[[nodiscard]] Charts refine_cut(const IndexedMesh& mesh, std::vector<std::uint32_t> chart_of_face,
                                const Options& options);

}  // namespace ramcdb::chartify
