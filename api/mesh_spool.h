#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_file/mesh_file.h"
#include "api/point_file.h"
#include "api/scratch_records.h"

namespace ramcdb::detail {

/// The values that a file has of an attribute of its vertices.
class SpooledAttribute {
 public:
  SpooledAttribute(AttributeInfo info, const std::filesystem::path& folder) : info_(std::move(info)), values_(folder) {}

  [[nodiscard]] const AttributeInfo& info() const { return info_; }
  void add(std::span<const double> values) { values_.add(values); }
  /// From here on values can be read, and none added.
  void finish();
  [[nodiscard]] mesh_file::AttributeView view() const { return {info_, view_->as<double>()}; }
  /// Gives every vertex the value of the one that stands for it, itself or one before.
  void join(std::span<const std::uint32_t> first_of_vertex);

 private:
  AttributeInfo info_;
  ScratchRecords<double> values_;
  std::optional<ScratchView> view_;
};

/// The mesh of a file, as the file has it, in temporary files. Vertices keep their numbers when some of them are
/// joined: those that others stand for are no vertices any more.
struct MeshSpool {
  explicit MeshSpool(const std::filesystem::path& in) : folder(in), points(in), faces(in) {}

  std::filesystem::path folder;
  PointFile points;
  ScratchRecords<Triangle> faces;
  std::vector<SpooledAttribute> attributes;
  std::vector<bool> in_a_face;  ///< per vertex; true as well for those that are no vertices any more
  std::uint64_t welded = 0;     ///< vertices that others stand for
  std::vector<std::string> references;
  std::vector<mesh_file::Dropped> dropped;

  [[nodiscard]] std::uint64_t vertices() const { return points.size() - welded; }
};

/// Reads a file of triangles, with attributes of its vertices. \param weld as ImportOptions::weld
/// Throws as mesh_file::read_in_pieces, NotInPieces also for polygons and attributes of faces and corners.
[[nodiscard]] MeshSpool spool_mesh(const std::filesystem::path& file, std::optional<bool> weld, const LargeWork& work);

}  // namespace ramcdb::detail
