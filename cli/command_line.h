#pragma once

namespace ramcdb::cli {

/// The whole program: parses, runs one verb, prints. Returns the exit code; throws nothing.
int run_command_line(int argc, char** argv) noexcept;

}  // namespace ramcdb::cli
