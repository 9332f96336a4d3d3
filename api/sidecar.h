#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

namespace ramcdb::detail {

/// What is written beside a checked-out file, as FILE.ramcdb.json: where the file came from.
struct Sidecar {
  std::string repository_id;
  std::filesystem::path repository;  ///< as found from the sidecar's own folder first, else absolute
  std::string mesh;
  struct Part {
    VersionId version;
    std::vector<ChartId> charts;
  };
  /// The version that each chart of the region was taken from: one, until a commit went in beside other people's.
  std::vector<Part> parts;
  VersionId ids_version;   ///< the version that vertex ids in the file refer to; 0 when they are stale
  Point local_origin;      ///< to be added to the file's coordinates
  std::string file_hash;   ///< of the file as it was written or committed last
  std::string nonce;       ///< names this checkout: a repeated commit of the same edit is one commit
  std::uint32_t lock = 0;  ///< taken with this checkout, given back by its commit; 0 for none
  bool painted = false;    ///< coloured to look at; commit refuses it
};

[[nodiscard]] std::filesystem::path sidecar_path(const std::filesystem::path& file);
/// Writes beside the file, whole or not at all.
void write_sidecar(const std::filesystem::path& file, const Sidecar& sidecar);
/// Throws not_found when there is none, invalid_argument when it cannot be read.
[[nodiscard]] Sidecar read_sidecar(const std::filesystem::path& file);

/// Hash of a file's bytes, 16 hexadecimal digits.
[[nodiscard]] std::string hash_file(const std::filesystem::path& file);

}  // namespace ramcdb::detail
