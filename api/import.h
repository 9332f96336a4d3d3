#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// A file's mesh; vertices at equal positions are one if `weld`, or if that is not said and it is a soup.
/// \param welded gets the number of vertices less  \param dropped gets what the file holds beside
[[nodiscard]] mesh_file::MeshData read_file_whole(const std::filesystem::path& file, std::optional<bool> weld,
                                                  const Progress& progress, std::uint64_t& welded,
                                                  std::vector<ImportReport::Dropped>& dropped);

/// file -> lattice -> canonical order -> charts -> wire-net -> blobs -> one version. The hops are the functions that
/// import.cpp calls, in this order; large_import.cpp goes the same way piece by piece, where the mesh takes more than
/// `options.memory`. The report's `info` is left to the caller, who has the snapshot.
/// \param folder for temporary files  \param name gets the name that the mesh was given.
[[nodiscard]] ImportReport import_mesh(db::Store& store, const std::filesystem::path& folder,
                                       const std::filesystem::path& file, const ImportOptions& options,
                                       std::string& name);

}  // namespace ramcdb::detail
