#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace ramcdb::detail {

/// Where work that does not fit memory is done, and how much of it is held at a time.
struct LargeWork {
  std::filesystem::path folder;  ///< for temporary files
  std::uint64_t memory = 0;      ///< bytes
  unsigned threads = 1;
  std::function<void(std::string_view stage, double done)> progress;  ///< may be empty; may throw to cancel

  void report(std::string_view stage, double done) const {
    if (progress) progress(stage, done);
  }
};

/// How a mesh that does not fit memory is cut up. Nothing of it depends on the number of threads: charts do not,
/// either.
struct PartSizes {
  std::uint64_t most_faces = 0;  ///< of a part
  std::size_t at_a_time = 1;     ///< how many parts are held
};

}  // namespace ramcdb::detail
