#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_file/mesh_file.h"
#include "api/mesh_file/triangulate.h"
#include "api/point_file.h"
#include "api/scratch_records.h"

namespace ramcdb::detail {

/// The values that a file has of an attribute.
class SpooledAttribute {
 public:
  SpooledAttribute(AttributeInfo info, const std::filesystem::path& folder) : info_(std::move(info)), values_(folder) {}

  [[nodiscard]] const AttributeInfo& info() const { return info_; }
  void add(std::span<const double> values) { values_.add(values); }
  /// From here on values can be read, and none added.
  void finish();
  [[nodiscard]] mesh_file::AttributeView view() const { return {info_, view_->as<double>()}; }
  /// Gives every vertex the value of the one that stands for it, itself or one before. \param report is called again
  /// and again; may throw to cancel
  void join(std::span<const std::uint32_t> first_of_vertex, const std::function<void()>& report);

 private:
  AttributeInfo info_;
  ScratchRecords<double> values_;
  std::optional<ScratchView> view_;
};

/// What a triangle of a mesh is in its file.
struct TriangleSource {
  std::uint32_t face = 0;                  ///< that it was cut from
  std::array<std::uint32_t, 3> corners{};  ///< its own, counted over all faces
};

/// The faces of a file that not only has triangles, and what they were cut to.
class SpooledPolygons {
 public:
  explicit SpooledPolygons(const std::filesystem::path& folder)
      : corners(folder), triangles(folder), sizes_(folder), sources_(folder) {}

  ScratchRecords<std::uint32_t> corners;  ///< vertices, face after face
  ScratchRecords<Triangle> triangles;     ///< of all faces, in order, when they are cut
  std::uint64_t count = 0;                ///< faces with more than three corners, likewise
  std::uint64_t fans = 0;                 ///< of them, those that took too long to cut well

  void add(std::span<const std::uint32_t> face_corners, std::span<const std::uint32_t> face_sizes);
  /// Takes triangles that came before the first polygon.
  void add_triangles(const ScratchRecords<Triangle>& before);
  /// Before the corners are read.
  void finish();
  /// Cuts all faces to triangles. Throws limit_exceeded.
  void cut(const PointFile& points, const Lattice& lattice, const LargeWork& work);
  [[nodiscard]] const TriangleSource& source(std::uint32_t triangle) const {
    return view_->as<TriangleSource>()[triangle];
  }

 private:
  /// How far cutting is.
  struct Cut {
    mesh_file::CutSteps steps;
    std::uint32_t faces = 0, corners = 0;
  };
  void cut_some(std::span<const std::uint32_t> sizes, const PointFile& points, const Lattice& lattice, Cut& cut);

  ScratchRecords<std::uint32_t> sizes_;
  ScratchRecords<TriangleSource> sources_;
  std::optional<ScratchView> view_;
};

/// The mesh of a file, as the file has it, in temporary files. Vertices keep their numbers when some of them are
/// joined: those that others stand for are no vertices any more.
struct MeshSpool {
  explicit MeshSpool(const std::filesystem::path& in) : folder(in), points(in), triangles(in) {}

  std::filesystem::path folder;
  PointFile points;
  ScratchRecords<Triangle> triangles;       ///< before the first polygon
  std::optional<SpooledPolygons> polygons;  ///< all faces, where one has more than three corners
  std::vector<SpooledAttribute> attributes;
  std::vector<bool> in_a_face;  ///< per vertex; true as well for those that are no vertices any more
  std::uint64_t welded = 0;     ///< vertices that others stand for
  std::vector<std::string> references;
  std::vector<mesh_file::Dropped> dropped;

  [[nodiscard]] std::uint64_t vertices() const { return points.size() - welded; }
  /// All of them as triangles, when polygons are cut.
  [[nodiscard]] const ScratchRecords<Triangle>& faces() const { return polygons ? polygons->triangles : triangles; }
  [[nodiscard]] TriangleSource source(std::uint32_t triangle) const {
    return polygons ? polygons->source(triangle)
                    : TriangleSource{triangle, {3 * triangle, 3 * triangle + 1, 3 * triangle + 2}};
  }
  /// Per triangle which polygon of some it is part of, counted from 0; empty where the mesh has triangles only.
  [[nodiscard]] std::vector<std::uint32_t> polygons_of(std::span<const std::uint32_t> triangles) const;
};

/// Reads a file. \param weld as ImportOptions::weld
/// Throws as mesh_file::read_in_pieces.
[[nodiscard]] MeshSpool spool_mesh(const std::filesystem::path& file, std::optional<bool> weld, const LargeWork& work);
/// Cuts the polygons, if there are any, to triangles, as they lie on the lattice: so they are cut alike however often a
/// mesh goes out and in.
void cut_polygons(MeshSpool& mesh, const Lattice& lattice, const LargeWork& work);

}  // namespace ramcdb::detail
