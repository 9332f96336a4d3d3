#pragma once

#include <string_view>

namespace ramcdb::db {

inline constexpr std::size_t kMostRefNameBytes = 200;

/// Throws invalid_argument, saying what is wrong, unless branches and tags may be called `name`: 1 to 200 bytes; no
/// spaces, control characters, `~^:?*[\`, `..`, `@{`; no leading `-` or `.`, no trailing `.` or `/` or `.lock`, no part
/// between slashes that is empty or begins with a dot; not HEAD, and nothing that reads as a version (17, v17).
void require_ref_name(std::string_view name);

}  // namespace ramcdb::db
