#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_folder.h"

namespace ramcdb::test {

[[nodiscard]] inline CommitOptions message(const char* text) {
  CommitOptions options;
  options.message = text;
  options.author = "test";
  return options;
}

/// Writes a mesh as a program that knows nothing of vertex ids.
inline void write_data(const mesh_file::MeshData& mesh, const std::filesystem::path& file,
                       mesh_file::Scalar scalar = mesh_file::Scalar::float64) {
  mesh_file::MeshOutput out = mesh_file::output_of(mesh, scalar);
  out.vertex_ids = {};
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

inline void write_test_mesh(const TestMesh& mesh, const std::filesystem::path& file) {
  mesh_file::MeshOutput out;
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : mesh.faces) corners.insert(corners.end(), t.begin(), t.end());
  out.positions = mesh.positions;
  out.corners = corners;
  out.scalar = mesh_file::Scalar::float64;
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

/// A fresh repository with one mesh.
class TempRepository {
 public:
  explicit TempRepository(const TestMesh& mesh, std::uint32_t chart_faces = 500, unsigned bits = 14)
      : repository_(make(folder_)) {
    write_test_mesh(mesh, folder_ / "input.ply");
    ImportOptions options;
    options.name = "mesh";
    options.bits = bits;
    options.chart_faces = chart_faces;
    options.threads = 2;
    report_ = repository_.import(folder_ / "input.ply", options);
  }

  [[nodiscard]] Repository& operator*() { return repository_; }
  [[nodiscard]] Repository* operator->() { return &repository_; }
  [[nodiscard]] const ImportReport& import_report() const { return report_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  static Repository make(const TempFolder& folder) {
    Repository::create(folder / "r.ramcdb");
    return Repository::open(folder / "r.ramcdb");
  }

  TempFolder folder_;
  Repository repository_;
  ImportReport report_;
};

/// Faces by position, each turned to its smallest sequence, sorted: equal for equal surfaces however numbered.
using FaceSet = std::vector<std::vector<LatticePoint>>;

/// \param sizes corners per face; empty when all are triangles
inline FaceSet face_set(const std::vector<LatticePoint>& points, const std::vector<std::uint32_t>& corners,
                        const std::vector<std::uint32_t>& sizes = {}) {
  FaceSet set(sizes.empty() ? corners.size() / 3 : sizes.size());
  std::size_t corner = 0;
  for (std::size_t f = 0; f < set.size(); ++f) {
    std::vector<LatticePoint>& face = set[f];
    for (std::uint32_t i = 0; i < (sizes.empty() ? 3 : sizes[f]); ++i) face.push_back(points[corners[corner++]]);
    std::vector<LatticePoint> best = face;
    for (std::size_t turn = 1; turn < face.size(); ++turn) {
      std::rotate(face.begin(), face.begin() + 1, face.end());
      best = std::min(best, face);
    }
    face = std::move(best);
  }
  std::sort(set.begin(), set.end());
  return set;
}

inline FaceSet face_set(const std::vector<LatticePoint>& points, const std::vector<Triangle>& faces) {
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : faces) corners.insert(corners.end(), t.begin(), t.end());
  return face_set(points, corners);
}

inline std::vector<LatticePoint> snapped(const Lattice& lattice, const std::vector<Point>& positions) {
  std::vector<LatticePoint> points;
  for (const Point& p : positions) points.push_back(lattice.snap(p));
  return points;
}

inline FaceSet face_set_of_file(const Lattice& lattice, const std::filesystem::path& file) {
  const mesh_file::MeshData data = mesh_file::read_mesh(file);
  return face_set(snapped(lattice, data.positions), data.corners, data.face_sizes);
}

inline RegionMesh whole(const Snapshot& snapshot) {
  return snapshot.read_with_attributes(snapshot.find({{WholeMesh{}}, 0}));
}

inline FaceSet face_set(const RegionMesh& region) {
  if (region.polygon_sizes.empty()) return face_set(region.points, region.faces);
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t corner : region.polygon_corners) corners.push_back(region.faces[corner / 3][corner % 3]);
  return face_set(region.points, corners, region.polygon_sizes);
}

}  // namespace ramcdb::test
