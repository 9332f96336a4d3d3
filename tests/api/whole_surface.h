#pragma once

#include "tests/api/temp_repository.h"

namespace ramcdb::test {

inline const Region kAll{{WholeMesh{}}, 0};

/// The triangles of a region, by position.
inline FaceSet surface(const RegionMesh& region) { return face_set(region.points, region.faces); }
/// Of the newest version.
inline FaceSet surface(const Repository& repository) { return surface(whole(repository.snapshot())); }

}  // namespace ramcdb::test
