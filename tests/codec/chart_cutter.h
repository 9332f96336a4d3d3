#pragma once

#include <cstdint>
#include <vector>

#include "ramcdb/chart.h"

/// Charts to code, cut from small generated meshes.
namespace ramcdb::codec::testing {

/// A plain indexed mesh on the lattice.
struct TestMesh {
  std::vector<LatticePoint> points;
  std::vector<Triangle> faces;
};

/// A bumpy closed torus of 2 * around * across faces.
TestMesh torus(int around, int across, std::int32_t radius);
/// A rough height field of 2 * side * side faces.
TestMesh terrain(int side, std::int32_t spacing, std::uint32_t seed);
/// A closed octahedron, split `levels` times, pushed out to a sphere.
TestMesh sphere(int levels, std::int32_t radius);

/// The faces of one region of a mesh as a chart: as many loops, components and handles as the region has, one local
/// vertex per fan. REQUIRES: the mesh is edge-manifold and oriented.
Chart cut(const TestMesh& mesh, const std::vector<std::uint32_t>& faces);
/// All of the mesh as one chart.
Chart cut(const TestMesh& mesh);

/// A region of about `size` faces: some patches that random growth reaches from random faces, so that it may have
/// holes, several components, and places where it touches itself in a vertex only.
std::vector<std::uint32_t> random_region(const TestMesh& mesh, std::size_t size, int patches, std::uint32_t seed);

/// The same chart with its inner vertices and faces in another order, faces begun at another corner.
Chart shuffled(const Chart& chart, std::uint32_t seed);

/// Each face begun at its smallest corner, all sorted, inner vertices renumbered by position: equal for charts that
/// differ in numbering only, when no two inner vertices share a position.
Chart normalized(const Chart& chart);

/// The box of all vertices.
LatticeBox box_of(const Chart& chart);

}  // namespace ramcdb::codec::testing
