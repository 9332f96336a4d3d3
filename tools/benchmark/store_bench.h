#pragma once

#include <cstdint>
#include <filesystem>

#include "ramcdb/figures.h"

namespace ramcdb::benchmark {

/// What a repository costs in bytes and time. Checkout and commit are of one chart, medians over charts all over the
/// mesh; a commit moves every vertex inside its chart.
struct StoreFigures {
  MeshInfo info;  ///< after the import
  double import_seconds = 0;
  double checkout_seconds = 0, checkout_bytes = 0, checkout_blobs = 0;
  double commit_seconds = 0, commit_bytes = 0;
  /// A bare LMDB environment that takes as many bytes in as many values, in one transaction, synced.
  double plain_lmdb_seconds = 0;
};

/// `scratch` is an empty folder that exists, on the disk that is measured.
[[nodiscard]] StoreFigures measure_store(const std::filesystem::path& file, const std::filesystem::path& scratch,
                                         unsigned bits, unsigned rounds);

}  // namespace ramcdb::benchmark
