#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace ramcdb::test {

/// What a run of the program left behind.
struct Outcome {
  int code = 0;  ///< exit code; 128 + n when signal n ended it
  std::string out, err;
};

using Arguments = std::vector<std::string>;

/// Runs the built program with these arguments, without a shell; standard input is empty, both outputs are pipes.
[[nodiscard]] Outcome run_ramcdb(const Arguments& arguments);

/// A run that goes on beside the test. REQUIRES: wait() is called once.
class RunningProgram {
 public:
  explicit RunningProgram(const Arguments& arguments);
  void send(int signal) const;
  [[nodiscard]] Outcome wait();

 private:
  pid_t pid_ = 0;
  int out_ = -1, err_ = -1;
};

[[nodiscard]] std::string read_text(const std::string& file);
void write_text(const std::string& file, const std::string& text);

}  // namespace ramcdb::test
