#pragma once

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::test {

/// Corners in range, sizes that add up, coordinates finite, a value each of every attribute: what every mesh that a
/// reader returns must be.
[[nodiscard]] bool is_sound(const mesh_file::MeshData& mesh);

}  // namespace ramcdb::test
