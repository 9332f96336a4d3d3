// replay [--write-seeds FOLDER] [FILE OR FOLDER...]
//
// A fuzz target without libFuzzer: runs it over its own seeds and over files. With --write-seeds it only writes the
// seeds, as libFuzzer's first corpus.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "tests/fuzz/target.h"

namespace {

namespace fs = std::filesystem;

/// The name is printed first, so that it stands there when the target ends the program.
void run(const std::string& name, const std::string& bytes) {
  std::printf("%s, %zu bytes\n", name.c_str(), bytes.size());
  std::fflush(stdout);
  const auto exact = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  LLVMFuzzerTestOneInput(exact.get(), bytes.size());
}

void run_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  run(file.string(), {std::istreambuf_iterator<char>(in), {}});
}

std::size_t run_files(const fs::path& path) {
  if (!fs::is_directory(path)) {
    run_file(path);
    return 1;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) run_file(file);
  return files.size();
}

void write_seeds(const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& [name, bytes] : ramcdb::fuzz::seeds()) std::ofstream(folder / name, std::ios::binary) << bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--write-seeds") == 0) {
    write_seeds(argv[2]);
    return 0;
  }
  std::size_t count = 0;
  for (const auto& [name, bytes] : ramcdb::fuzz::seeds()) {
    run("seed " + name, bytes);
    ++count;
  }
  for (int i = 1; i < argc; ++i) count += run_files(argv[i]);
  std::printf("%zu inputs, all survived\n", count);
  return 0;
}
