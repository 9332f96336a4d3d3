#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// How the coordinates of a returned file become those that were checked out: another program swapped axes or changed
/// units.
class FileFrame {
 public:
  /// Coordinate a is sign[a] * p[axis[a]] * numerator / denominator.
  FileFrame(std::array<int, 3> axis, std::array<int, 3> sign, double numerator, double denominator)
      : axis_(axis), sign_(sign), numerator_(numerator), denominator_(denominator) {}

  /// From the file's coordinates to those that it was checked out with, which are relative to its local origin.
  [[nodiscard]] Point apply(const Point& p) const;
  /// The other way round.
  [[nodiscard]] Point undo(const Point& p) const;
  [[nodiscard]] bool changes_nothing() const;
  /// Such as "axes x,y,z <- x,-z,y; scale 1000".
  [[nodiscard]] std::string describe() const;

 private:
  std::array<int, 3> axis_, sign_;
  double numerator_, denominator_;
};

/// Tries 24 rotations and the scales between common units, where less than half of the region's outer border is in the
/// file. One is found when it alone brings back nearly all of the border. A region without such a border may have been
/// turned on purpose: it is taken as it is.
/// \param positions as the file has them, relative to `local_origin`
/// \param tolerance model units, beside half a lattice step
[[nodiscard]] std::optional<FileFrame> find_frame(const RegionMesh& region, const Lattice& lattice,
                                                  const Point& local_origin, std::span<const Point> positions,
                                                  double tolerance = 0);

}  // namespace ramcdb::detail
