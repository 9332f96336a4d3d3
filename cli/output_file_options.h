#pragma once

#include <string>

#include "ramcdb/repository.h"

namespace CLI {
class App;
}

namespace ramcdb::cli {

/// Where and how checkout and export write.
struct OutputFileOptions {
  std::string file;
  std::string color;  ///< empty, "chart", "bits" or "version"
  bool ascii = false;
  bool force = false;
};

void add_output_file(CLI::App& verb, OutputFileOptions& options);

[[nodiscard]] FileOptions file_options_of(const OutputFileOptions& options);

}  // namespace ramcdb::cli
