#pragma once

#include <filesystem>

#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Commits a file's mesh as new components of a mesh: an edit of one chart near them, which nothing joins.
[[nodiscard]] ImportIntoReport import_into(const Snapshot& base, const std::filesystem::path& file,
                                           const ImportIntoOptions& options);

}  // namespace ramcdb::detail
