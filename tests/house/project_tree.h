#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// What the house tests know about the project's own files.
namespace ramcdb::house {

/// The folder with the top-level CMakeLists.txt.
[[nodiscard]] std::filesystem::path project_root();

/// An empty folder of this process's own below the system's temporary folder. The caller removes it.
[[nodiscard]] std::filesystem::path fresh_folder(std::string_view name);

/// A file of the project as text. Throws when it cannot be read.
[[nodiscard]] std::string read_project_file(const std::filesystem::path& file);

/// What git tracks, as paths from the root; empty where this is not a git checkout.
[[nodiscard]] std::vector<std::string> tracked_files();

}  // namespace ramcdb::house
