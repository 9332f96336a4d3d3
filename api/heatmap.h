#pragma once

#include <filesystem>
#include <vector>

#include "api/commit.h"

namespace ramcdb::detail {

/// A mesh and how far it was moved.
struct Heat {
  RegionMesh mesh;
  std::vector<double> displacement;  ///< per vertex, model units; 0 for those that are new
  std::vector<bool> is_new;          ///< per face
};

[[nodiscard]] Heat heat_of_edit(const PendingEdit& edit);

/// Throws invalid_argument for a file that is neither .ply nor .glb, or that is a checked-out one.
void require_heatmap_file(const std::filesystem::path& file);

/// Writes it to look at: see DiffOptions::heatmap. Faces that are new have vertices of their own, for their colour.
/// \param most the displacement that has the last colour
/// Throws invalid_argument for a mesh without vertices.
void write_heatmap(const Snapshot::Impl& at, const Heat& heat, double most, const std::filesystem::path& file);

}  // namespace ramcdb::detail
