#pragma once

#include "chartify/border_paths.h"
#include "chartify/face_mover.h"
#include "chartify/progress.h"

namespace ramcdb::chartify {

/// Replaces the border between two charts by the cheapest path between its corners through the two charts, where that
/// is shorter and leaves both of fitting size. Faces change sides; corners stay where they are.
class BorderStraightener {
 public:
  /// Both must outlive it.
  BorderStraightener(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins);

  /// \param rules which faces may change sides; nullptr: all
  /// \param threads change the time, never the result
  void run(const SizeLimits& limits, Partition& partition, const MoveRules* rules = nullptr, unsigned threads = 1,
           const Progress& progress = {}) const;

 private:
  const IndexedMesh& mesh_;
  const std::vector<HalfEdge>& twins_;
  ClosedFans fans_;
  double mean_length_ = 1;  ///< of half-edges
};

}  // namespace ramcdb::chartify
