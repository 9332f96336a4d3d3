#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ramcdb::benchmark {

/// The main() of a benchmark: an error becomes its text on standard error and exit code 1.
int run_guarded(int (*run)(int, char**), int argc, char** argv);

/// What another program used, from its start to its end.
struct ProgramUse {
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_anonymous = 0;  ///< bytes of memory that no file backs, as looked at every 5 ms (RssAnon of /proc)
  std::string output;                ///< what it wrote to standard output
};

/// Runs a program, the first word, with its arguments. Throws unless it succeeds.
[[nodiscard]] ProgramUse run_program(std::vector<std::string> command);

}  // namespace ramcdb::benchmark
