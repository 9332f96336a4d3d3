#pragma once

#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Checks the store, then every mesh of every version: pages, references, and (unless quick) that every chart decodes.
/// Blobs that versions share are looked at once.
[[nodiscard]] VerifyReport verify_repository(const std::shared_ptr<db::Store>& store,
                                             const Repository::VerifyOptions& options);

}  // namespace ramcdb::detail
