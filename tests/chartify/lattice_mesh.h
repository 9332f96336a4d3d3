#pragma once

#include "chartify/chartify.h"
#include "tests/support/meshes.h"

namespace ramcdb::chartify::test {

/// A test mesh on a lattice of 16 bits, in its own order. A mesh without vertices has no extent to snap to.
inline IndexedMesh on_lattice(const ramcdb::test::TestMesh& mesh) {
  if (mesh.positions.empty()) return {};
  return {ramcdb::test::snap_to_bits(mesh, 16), mesh.faces};
}

}  // namespace ramcdb::chartify::test
