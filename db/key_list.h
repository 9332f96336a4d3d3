#pragma once

#include <vector>

#include "db/store.h"

/// The keys that an attempt wrote, so that it can be taken back without a search: the pending list.
///
///     list = run*
///     run  = kind varint | mesh varint | layer varint | count varint | id varint{count}
///
/// The first id of a run is itself, each further one the difference to the one before. The version is the list's own.
namespace ramcdb::db {

/// Short where ids ascend within a kind.
[[nodiscard]] Buffer encode_key_list(const std::vector<BlobKey>& keys);
/// Throws corrupt.
[[nodiscard]] std::vector<BlobKey> decode_key_list(Bytes bytes, VersionId version);

}  // namespace ramcdb::db
