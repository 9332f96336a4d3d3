#pragma once

#include <string_view>

namespace ramcdb::cli {

/// Writes to standard output.
void say(std::string_view text);

/// Flushes standard output. Throws storage when anything could not be written: a full disk behind a redirection must
/// not pass for success.
void finish_output();

}  // namespace ramcdb::cli
