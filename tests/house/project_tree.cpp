#include "tests/house/project_tree.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace ramcdb::house {

namespace fs = std::filesystem;

fs::path project_root() { return RAMCDB_SOURCE_DIR; }

fs::path fresh_folder(std::string_view name) {
  const fs::path folder =
      fs::temp_directory_path() / ("ramcdb_" + std::string(name) + "_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::string read_project_file(const fs::path& file) {
  std::ifstream in(project_root() / file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> tracked_files() {
  const std::string command = "git -C '" + project_root().string() + "' ls-files 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) return {};
  std::string text;
  for (char buffer[4096]; std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe.get());) text.append(buffer, n);
  std::vector<std::string> files;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) files.push_back(line);
  return files;
}

}  // namespace ramcdb::house
