#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ramcdb/names.h"

/// What branch, tag, lock and log say alike about names and locks.
namespace ramcdb::cli {

/// A branch or a tag that was made, moved, renamed or deleted.
struct NameChange {
  std::string kind;                 ///< "branch", "tag"
  std::string name;                 ///< its name now, or that it had
  std::string before;               ///< its name before it was renamed; else empty
  VersionId version;                ///< that it names now; none when it was deleted
  std::vector<VersionId> nameless;  ///< versions that no name leads to any more
};
[[nodiscard]] std::string name_change_text(const NameChange& change);

/// " (main, tag: v1.0)"; empty without names.
[[nodiscard]] std::string ref_text(const std::vector<RefName>& refs);

/// A row per lock; empty without locks.
[[nodiscard]] std::string locks_text(const std::vector<LockInfo>& locks);

/// What a lock that was taken says, and from whom it was taken over.
[[nodiscard]] std::string lock_report_text(const LockReport& report);

/// "90s", "30m", "2h", "3d", "1w" in seconds; 0 for any other text and for more than ten years.
[[nodiscard]] std::int64_t seconds_of(const std::string& text);

}  // namespace ramcdb::cli
