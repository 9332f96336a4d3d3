#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "api/edited_region.h"
#include "api/file_coordinates.h"
#include "api/mesh_file/mesh_file.h"
#include "api/region_mesh.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

struct WrittenRegion {
  Point local_origin;  ///< that the file's coordinates are relative to
  std::vector<mesh_file::Dropped> left_out;
};

/// A mesh on its way to a file. The spans must outlive it.
struct OutputMesh {
  std::span<const std::uint32_t> corners;     ///< vertices, face after face
  std::span<const std::uint32_t> face_sizes;  ///< empty when all faces are triangles
  mesh_file::AttributeViews attributes;
  std::span<const std::uint64_t> vertex_ids;          ///< may be empty
  std::span<const mesh_file::FaceColor> face_colors;  ///< may be empty
};

/// Throws invalid_argument when the format has no colours of faces and some are asked for.
void check_paint(mesh_file::Format format, Paint paint, const std::filesystem::path& file);

/// Writes a mesh file. \param positions per vertex, as `coordinates` has them in a file
[[nodiscard]] WrittenRegion write_output_mesh(const Snapshot& snapshot, const OutputMesh& mesh,
                                              const FileCoordinates& coordinates, std::span<const Point> positions,
                                              const std::filesystem::path& file, const FileOptions& options);
/// Writes a region that is to come back edited: with ids of vertices where the format has a place for them.
[[nodiscard]] WrittenRegion write_region(const Snapshot& snapshot, const RegionMesh& region,
                                         const std::filesystem::path& file, const FileOptions& options);

/// What an edited file makes of the region that it was written from.
struct FileEdit {
  EditedRegion edited;
  FileNotes notes;
};

/// Faces and vertices are recognized whatever a program did to them in between (region_match.h); what is not is new.
/// Attributes are found by their names, or else by what they mean; those that the file lacks stay, new vertices and
/// faces then have values from the surface that was there, and what the file has in addition is not taken. Throws
/// invalid_argument for positions that the lattice does not have.
/// \param trust_ids vertex ids in the file refer to this very region.
[[nodiscard]] FileEdit edited_in_file(const Snapshot::Impl& at, const RegionMesh& region,
                                      const mesh_file::MeshData& file, const Point& local_origin, bool trust_ids);

}  // namespace ramcdb::detail
