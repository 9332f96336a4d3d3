#pragma once

#include <vector>

#include "db/store.h"

/// All that is known about a version, in CBOR: a blob of its own in LMDB, from which the catalogue can be rebuilt, and
/// the columns of the catalogue's row.
///
///     roots   = [[mesh, name, root page, root version, record version], ...]
///     changed = [[mesh, [first, count, first, count, ...]], ...]        chart ids as runs
///     record  = {id, parents, branch, author, message, time, attempt, figures, roots, changed}
namespace ramcdb::db {

struct CommitRecord {
  VersionInfo info;
  std::vector<MeshRoot> roots;
  std::vector<ChangedCharts> changed;
};

[[nodiscard]] Buffer encode_roots(const std::vector<MeshRoot>& roots);
[[nodiscard]] Buffer encode_changed(const std::vector<ChangedCharts>& changed);
[[nodiscard]] Buffer encode_record(const CommitRecord& record);

/// These throw corrupt.
[[nodiscard]] std::vector<MeshRoot> decode_roots(Bytes bytes);
[[nodiscard]] std::vector<ChangedCharts> decode_changed(Bytes bytes);
[[nodiscard]] CommitRecord decode_record(Bytes bytes);

}  // namespace ramcdb::db
