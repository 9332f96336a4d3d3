#pragma once

#include <filesystem>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Whether a mesh can be written chart by chart: triangles without attributes and colours, in a format that takes its
/// numbers from anywhere (all but glTF).
[[nodiscard]] bool exports_in_pieces(const Snapshot& snapshot, const std::filesystem::path& file,
                                     const FileOptions& options);

struct StreamedExport {
  std::uint64_t charts = 0, faces = 0, vertices = 0;
  ReadCost cost;
  std::vector<mesh_file::Dropped> left_out;
};
/// Writes such a mesh: the very file that write_region writes of all its charts. Some charts are in memory at a time,
/// and a number for every chart, wire and corner; positions and faces go through temporary files beside the file.
[[nodiscard]] StreamedExport export_in_pieces(const Snapshot& snapshot, const std::filesystem::path& file,
                                              const FileOptions& options);

}  // namespace ramcdb::detail
