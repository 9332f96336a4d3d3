#pragma once

#include <span>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {

/// `triangulate` of any faces; `face_sizes` is empty when all are triangles.
[[nodiscard]] Triangulation triangulate(std::span<const Point> positions, std::span<const std::uint32_t> corners,
                                        std::span<const std::uint32_t> face_sizes);

}  // namespace ramcdb::mesh_file
