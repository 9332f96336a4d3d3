#pragma once

#include <filesystem>
#include <memory>

#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Throws invalid_argument when the branch holds a mesh of the name that the import would give.
void refuse_taken_name(db::Store& store, const ImportOptions& options, const std::filesystem::path& file);

/// file -> lattice -> canonical order -> charts -> wire-net -> blobs -> one version. The hops are the functions that
/// import.cpp calls, in this order. The report's `info` is left to the caller, who has the snapshot.
/// \param name gets the name that the mesh was given.
[[nodiscard]] ImportReport import_mesh(db::Store& store, const std::filesystem::path& file,
                                       const ImportOptions& options, std::string& name);

}  // namespace ramcdb::detail
