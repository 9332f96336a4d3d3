#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/dense_surface.h"
#include "codec/raw_array.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// Around a new vertex, as connectivity knows it: the face (before, pivot, new) and what lies next to it.
struct FastPlace {
  std::uint32_t pivot;
  /// before, next, behind the edge before-pivot, behind pivot-next, the vertex before `before`, behind that edge.
  /// Behind an edge of the border there is nothing; the vertex that it starts from stands for that.
  std::array<std::uint32_t, 6> around;
  std::uint32_t predictor;  ///< class of weights, below kFastPredictors; kFreePlace: there are no neighbours
};

inline constexpr std::uint32_t kFreePlace = ~std::uint32_t{0};

/// No chart splits more corners.
inline constexpr std::uint32_t kMaxFastJoins = 1u << 20;

/// What the connectivity of a chart says, before any position is known: its faces, and where each inner vertex comes
/// to lie. Vertex border + i has place i.
struct FastPlan {
  std::vector<Triangle> faces;
  RawArray<FastPlace> places;
  std::uint32_t joins = 0;
};

/// A node of the front: a corner of the surface that is still open, between the edges to prev and to next.
struct FastNode {
  std::uint32_t vertex;
  std::uint32_t behind;  ///< third vertex of the known face at the edge to next; without one, `vertex`
  FastNode* prev;
  FastNode* next;
  std::uint32_t open;      ///< faces that the corner still takes; 0: the node has left the front
  std::uint32_t has_face;  ///< whether there is one behind: 0 or 1
};

}  // namespace ramcdb::codec
