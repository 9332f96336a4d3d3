#pragma once

#include <gtest/gtest.h>

#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"
#include "tests/support/meshes.h"

namespace ramcdb::test {

/// A folder that is gone when the test is over.
class TempFolder {
 public:
  TempFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("ramcdb-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline void write_test_mesh(const TestMesh& mesh, const std::filesystem::path& file) {
  mesh_file::MeshOutput out;
  out.positions = mesh.positions;
  out.faces = mesh.faces;
  out.scalar = mesh_file::Scalar::float64;
  mesh_file::write_mesh(file, mesh_file::format_of(file), out);
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

/// Triangles by position, each turned to its smallest sequence, sorted: equal for equal surfaces however numbered.
using TriangleSet = std::vector<std::array<LatticePoint, 3>>;

inline TriangleSet triangle_set(const std::vector<LatticePoint>& points, const std::vector<Triangle>& faces) {
  TriangleSet set;
  for (const Triangle& t : faces) {
    std::array<LatticePoint, 3> best{};
    for (std::uint32_t turn = 0; turn < 3; ++turn) {
      const std::array<LatticePoint, 3> p{points[t[turn]], points[t[(turn + 1) % 3]], points[t[(turn + 2) % 3]]};
      if (turn == 0 || p < best) best = p;
    }
    set.push_back(best);
  }
  std::sort(set.begin(), set.end());
  return set;
}

inline std::vector<LatticePoint> snapped(const Lattice& lattice, const std::vector<Point>& positions) {
  std::vector<LatticePoint> points;
  for (const Point& p : positions) points.push_back(lattice.snap(p));
  return points;
}

inline TriangleSet triangle_set_of_file(const Lattice& lattice, const std::filesystem::path& file) {
  mesh_file::MeshData data = mesh_file::read_mesh(file);
  mesh_file::triangulate(data);
  std::vector<Triangle> faces;
  for (std::size_t c = 0; c + 2 < data.corners.size(); c += 3)
    faces.push_back({data.corners[c], data.corners[c + 1], data.corners[c + 2]});
  return triangle_set(snapped(lattice, data.positions), faces);
}

inline RegionMesh whole(const Snapshot& snapshot) { return snapshot.read(snapshot.find({{WholeMesh{}}, 0})); }

inline TriangleSet triangle_set(const RegionMesh& region) { return triangle_set(region.points, region.faces); }

}  // namespace ramcdb::test
