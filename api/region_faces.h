#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// The faces of a region as a file has them: its polygons, or its triangles where it has no polygons. `region` must
/// outlive the object.
class RegionFaces {
 public:
  /// \param as_triangles whether polygons are left as the triangles that they are kept as
  explicit RegionFaces(const RegionMesh& region, bool as_triangles = false);

  [[nodiscard]] std::size_t count() const { return firsts_.size() - 1; }
  /// Corners of a face, each 3 * triangle + 0..2.
  [[nodiscard]] std::span<const std::uint32_t> corners(std::size_t face) const {
    return std::span(corners_).subspan(firsts_[face], firsts_[face + 1] - firsts_[face]);
  }
  /// The vertices of all faces, face after face.
  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// Where each face begins in `vertices`, and the end of the last.
  [[nodiscard]] const std::vector<std::uint32_t>& firsts() const { return firsts_; }
  /// Corners per face; empty when all are triangles.
  [[nodiscard]] std::span<const std::uint32_t> sizes() const { return sizes_; }

  /// An attribute with a value per corner and face of the file.
  [[nodiscard]] Attribute for_file(const Attribute& attribute) const;
  /// Which corner of the file each corner of a triangle is: position in `vertices`.
  [[nodiscard]] std::vector<std::uint32_t> file_corners() const;
  /// Which face of the file each triangle is of.
  [[nodiscard]] std::vector<std::uint32_t> file_faces() const;

 private:
  const RegionMesh& region_;
  std::vector<std::uint32_t> corners_, vertices_, firsts_;
  std::span<const std::uint32_t> sizes_;
};

}  // namespace ramcdb::detail
