#pragma once

#include <vector>

#include "db/catalogue.h"
#include "db/environment.h"

namespace ramcdb::db {

/// Removes the blobs that an attempt wrote, its pending lists and its record, in the given write transaction.
void take_back(const Transaction& transaction, VersionId version);

/// Finishes what a crash left (db/FORMAT.md, "Recovery"). REQUIRES: the writer lock. Throws corrupt when the two halves
/// do not fit together. Returns the published versions whose pending lists may go with the next transaction.
[[nodiscard]] std::vector<VersionId> recover(Environment& environment, Catalogue& catalogue);

/// Removes the pending lists of versions that are published.
void drop_pending_lists(const Transaction& transaction, const std::vector<VersionId>& versions);

/// The key of a pending list: one for every transaction of an attempt.
[[nodiscard]] inline BlobKey pending_key(VersionId version, std::uint16_t chunk) {
  return {Kind::pending, MeshId(), version.value, version, chunk};
}

[[nodiscard]] inline BlobKey record_key(VersionId version) {
  return {Kind::commit_record, MeshId(), version.value, version, 0};
}

}  // namespace ramcdb::db
