#pragma once

#include <random>

#include "tests/chartify/edited_mesh.h"
#include "tests/support/meshes.h"

/// What a modelling program may do to a region. All leave the faces on fixed wires where they are, or replace them by
/// others that pass the same edges.
namespace ramcdb::chartify::test {

/// A face and those around it, ring after ring, up to `count`; faces on fixed wires left out.
[[nodiscard]] std::vector<std::uint8_t> disk_around(const Region& region, std::uint32_t face, std::size_t count);

/// Cuts a hole.
void delete_disk(Region& region, std::uint32_t face, std::size_t count);
/// Replaces each marked face by three around its centroid.
void subdivide(Region& region, const std::vector<std::uint8_t>& marked);
/// Replaces a disk by a fan around one vertex, if it is one.
void coarsen_disk(Region& region, std::uint32_t face, std::size_t count);
void delete_chart(Region& region, std::uint32_t chart);
void add_component(Region& region, const ramcdb::test::TestMesh& mesh, LatticePoint at);
/// A tube between two faces that share no vertex.
void glue_handle(Region& region, std::uint32_t a, std::uint32_t b);
/// A third face on an edge.
void glue_fin(Region& region, std::uint32_t face);
void double_face(Region& region, std::uint32_t face);
/// One of all these, somewhere.
void edit_at_random(Region& region, std::mt19937& random);

}  // namespace ramcdb::chartify::test
