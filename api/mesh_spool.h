#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_file/mesh_file.h"
#include "api/point_file.h"
#include "api/scratch_records.h"

namespace ramcdb::detail {

/// The mesh of a file, as the file has it, in temporary files. Vertices keep their numbers when some of them are
/// joined: those that others stand for are no vertices any more.
struct MeshSpool {
  explicit MeshSpool(const std::filesystem::path& folder) : points(folder), faces(folder) {}

  PointFile points;
  ScratchRecords<Triangle> faces;
  std::vector<bool> in_a_face;  ///< per vertex; true as well for those that are no vertices any more
  std::uint64_t welded = 0;     ///< vertices that others stand for
  std::vector<std::string> references;
  std::vector<mesh_file::Dropped> dropped;

  [[nodiscard]] std::uint64_t vertices() const { return points.size() - welded; }
};

/// Reads a file of triangles without attributes. \param weld as ImportOptions::weld
/// Throws as mesh_file::read_in_pieces, NotInPieces also for polygons and attributes.
[[nodiscard]] MeshSpool spool_mesh(const std::filesystem::path& file, std::optional<bool> weld, const LargeWork& work);

}  // namespace ramcdb::detail
