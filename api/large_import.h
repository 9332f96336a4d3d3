#pragma once

#include <filesystem>
#include <string>

#include "api/large_work.h"
#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Imports a mesh that memory does not hold: file -> temporary files -> faces along a Hilbert curve -> blocks -> charts
/// -> batches of charts, joined by their seams -> blobs -> one version. What is always in memory is the index: some
/// hundred bytes per chart, one bit per vertex, and what blocks and batches share along their borders.
/// Throws mesh_file::NotInPieces for files that cannot be read that way.
[[nodiscard]] ImportReport import_large(db::Store& store, const std::filesystem::path& file,
                                        const ImportOptions& options, const std::string& name, const LargeWork& work);

}  // namespace ramcdb::detail
