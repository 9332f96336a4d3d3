#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ramcdb::house {

/// Reads every .h and .cpp below the five source folders of `root` and returns a line `FILE:LINE includes "X": WHY NOT`
/// for each include that the tables in include_arrows.cpp do not allow, in path order. Throws when there are no
/// sources, so that a checker pointed at the wrong folder does not pass.
[[nodiscard]] std::vector<std::string> include_violations(const std::filesystem::path& root);

}  // namespace ramcdb::house
