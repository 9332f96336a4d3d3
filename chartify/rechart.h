#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/chartify.h"
#include "chartify/fixed_wires.h"

namespace ramcdb::chartify {

/// The mesh of the charts that an edit changed, and what is left of these charts. Any mesh, in any order. Chart, face
/// and vertex numbers count from 0.
struct Rechart {
  const IndexedMesh& mesh;
  /// Per face the old chart that it is from, below `old_charts`; kNone: a new face.
  std::span<const std::uint32_t> chart_of_face;
  /// Likewise, in the order of the mesh's isolated vertices.
  std::span<const std::uint32_t> chart_of_isolated_vertex;
  std::uint32_t old_charts = 0;
  /// Nobody is adjacent over their edges: other charts' faces lie there as well.
  std::span<const FixedWire> fixed;
};

struct Recharted {
  Charts charts;  ///< 0 .. chart_count - 1, none empty; a chart may hold isolated vertices only
  /// Per chart the old chart whose number it keeps, or kNone for a new one; no old chart twice. An old chart goes on in
  /// the chart with most of its faces, the first of equal ones, unless another has more faces there.
  std::vector<std::uint32_t> continues;
};

/// Cuts the mesh anew (RECIPE.md, "Edits"). Old faces stay in their charts, charts grow into new faces, large ones
/// split, small ones merge: between a quarter of the target and twice the target wherever the mesh has as many faces.
/// A chart is one piece, small components of the mesh aside. Charts that go on come first, by old number, then new
/// ones along the Hilbert curve. What is not new, split or merged keeps its border.
/// Errors: invalid_argument for a target out of range, old charts beyond their count, other numbers of faces or
/// isolated vertices, fixed wires that are no edges of the mesh.
[[nodiscard]] Recharted rechart(const Rechart& in, const Options& options);

/// Per chart how many faces it has from the old chart that it continues, if it has no others, else kNone: where the old
/// chart had as many, its faces are what they were.
[[nodiscard]] std::vector<std::uint32_t> faces_kept(const Rechart& in, const Recharted& out);

}  // namespace ramcdb::chartify
