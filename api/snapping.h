#pragma once

#include <algorithm>
#include <cmath>

#include "api/lattice_choice.h"

namespace ramcdb::detail {

/// Snaps positions to a lattice, and measures how far the farthest moved along an axis.
class Snapping {
 public:
  /// \param type the numbers that positions were
  Snapping(const Lattice& lattice, NumberType type) : lattice_(lattice), type_(type) {}

  [[nodiscard]] LatticePoint snap(const Point& p) {
    const LatticePoint snapped = lattice_.snap(p);
    const Point q = lattice_.position(snapped);
    for (int a = 0; a < 3; ++a) {
      most_ = std::max(most_, std::abs(q[a] - p[a]));
      all_come_back_ = all_come_back_ && as_type(q[a], type_) == p[a];
    }
    return snapped;
  }
  /// Model units; 0 where all come back as the numbers that they were.
  [[nodiscard]] double error() const { return all_come_back_ ? 0 : most_; }

 private:
  const Lattice& lattice_;
  NumberType type_;
  double most_ = 0;
  bool all_come_back_ = true;
};

}  // namespace ramcdb::detail
