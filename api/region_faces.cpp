#include "api/region_faces.h"

#include <algorithm>
#include <numeric>

namespace ramcdb::detail {

RegionFaces::RegionFaces(const RegionMesh& region, bool as_triangles) : region_(region), firsts_{0} {
  if (!as_triangles && !region.polygon_sizes.empty()) {
    corners_ = region.polygon_corners;
    sizes_ = region.polygon_sizes;
    for (const std::uint32_t size : region.polygon_sizes) firsts_.push_back(firsts_.back() + size);
  } else {
    corners_.resize(3 * region.faces.size());
    std::iota(corners_.begin(), corners_.end(), 0U);
    for (std::size_t f = 0; f < region.faces.size(); ++f) firsts_.push_back(firsts_.back() + 3);
  }
  vertices_.reserve(corners_.size());
  for (const std::uint32_t corner : corners_) vertices_.push_back(region.faces[corner / 3][corner % 3]);
}

Attribute RegionFaces::for_file(const Attribute& attribute) const {
  if (sizes_.empty() || attribute.info.of == AttributeOf::vertex) return attribute;
  Attribute out{attribute.info, {}};
  const std::size_t components = attribute.info.components;
  const auto add = [&](std::size_t at) {
    const auto value = attribute.values.begin() + static_cast<std::ptrdiff_t>(at * components);
    out.values.insert(out.values.end(), value, value + static_cast<std::ptrdiff_t>(components));
  };
  if (attribute.info.of == AttributeOf::corner)
    for (const std::uint32_t corner : corners_) add(corner);
  else
    for (std::size_t f = 0; f < count(); ++f) add(corners(f).front() / 3);
  return out;
}

std::vector<std::uint32_t> RegionFaces::file_faces() const {
  if (!sizes_.empty()) return region_.polygon_of_face;
  std::vector<std::uint32_t> faces(region_.faces.size());
  std::iota(faces.begin(), faces.end(), 0U);
  return faces;
}

std::vector<std::uint32_t> RegionFaces::file_corners() const {
  const std::vector<std::uint32_t> face_of = file_faces();
  std::vector<std::uint32_t> corner_of(3 * region_.faces.size());
  for (std::uint32_t c = 0; c < corner_of.size(); ++c) {
    const std::uint32_t first = firsts_[face_of[c / 3]], last = firsts_[face_of[c / 3] + 1];
    // The very corner, or else another one of the vertex: triangles of a polygon meet in its corners.
    const auto same = std::find(corners_.begin() + first, corners_.begin() + last, c);
    const auto at = same != corners_.begin() + last
                        ? same - corners_.begin()
                        : std::find(vertices_.begin() + first, vertices_.begin() + last, region_.faces[c / 3][c % 3]) -
                              vertices_.begin();
    corner_of[c] = static_cast<std::uint32_t>(at);
  }
  return corner_of;
}

}  // namespace ramcdb::detail
