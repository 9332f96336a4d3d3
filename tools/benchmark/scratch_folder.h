#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace ramcdb::benchmark {

/// A folder of this run's own, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / ("ramcdb-bench-" + std::to_string(::getpid()))) {
    clear();
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& clear() const {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
    return path_;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace ramcdb::benchmark
