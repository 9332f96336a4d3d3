#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "ramcdb/geometry.h"

/// Meshes that tests and benchmarks make for themselves: the same on every machine.
namespace ramcdb::test {

struct TestMesh {
  std::vector<Point> positions;
  std::vector<Triangle> faces;
};

/// Noise, about -1..1, smooth at each of its scales: the first octave has the largest bumps, of size 1.
[[nodiscard]] double fractal(const Point& p, int octaves);

// Closed surfaces of about as many faces as asked.
[[nodiscard]] TestMesh sphere(std::size_t faces);
[[nodiscard]] TestMesh torus(std::size_t faces);
/// A plate with three holes: genus 3.
[[nodiscard]] TestMesh genus3(std::size_t faces);

/// An open grid of nx * ny cells with a fractal height.
[[nodiscard]] TestMesh terrain(std::size_t nx, std::size_t ny);
/// A bumpy, noisy blob of about `faces` faces with some small holes, as a scanner leaves them.
[[nodiscard]] TestMesh scan(std::size_t faces);

/// `count` separate boxes of 12 triangles on a street grid.
[[nodiscard]] TestMesh boxes(std::size_t count);
/// Spheres, tori and terrains of very different sizes.
[[nodiscard]] TestMesh several_components();

/// A strip with one side.
[[nodiscard]] TestMesh moebius();
/// Two boxes that share the two vertices of one edge, on which four faces meet.
[[nodiscard]] TestMesh two_cubes_sharing_edge();
/// Two boxes that share one vertex.
[[nodiscard]] TestMesh hourglass();
/// Three sheets that meet along a line of edges.
[[nodiscard]] TestMesh three_faces_one_edge();
/// A grid with faces that name a vertex twice, that stand twice, and that lie on equal positions.
[[nodiscard]] TestMesh degenerate_and_duplicate_faces();
/// A sphere among vertices without a face.
[[nodiscard]] TestMesh isolated_vertices();

/// The same surface with vertices and faces in another order and faces turned to other first corners.
[[nodiscard]] TestMesh shuffled(const TestMesh& mesh, unsigned seed);

/// Positions on the lattice of so many bits over the largest extent.
[[nodiscard]] std::vector<LatticePoint> snap_to_bits(const TestMesh& mesh, unsigned bits);

/// The folder of real meshes: $RAMCDB_MESHES, or shared/meshes beside the source tree; none on most machines.
[[nodiscard]] std::optional<std::filesystem::path> meshes_folder();

/// Larger files of real meshes are left out, bytes: $RAMCDB_LARGEST_FILE, or what all tests together have time for.
[[nodiscard]] std::uintmax_t largest_real_file();

}  // namespace ramcdb::test
