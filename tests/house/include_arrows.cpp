#include "tests/house/include_arrows.h"

#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string_view>

namespace ramcdb::house {
namespace {

namespace fs = std::filesystem;
using Patterns = std::vector<std::string_view>;  // shell patterns; * also matches slashes

const Patterns kVocabulary = {"ramcdb/bytes.h", "ramcdb/chart.h",    "ramcdb/error.h",     "ramcdb/geometry.h",
                              "ramcdb/ids.h",   "ramcdb/wire_net.h", "ramcdb/attributes.h"};

/// The arrows of the house: who may include what of ours. Files and headers by their path, public headers without
/// api/include. The first row whose files match counts.
struct Arrow {
  Patterns files;
  Patterns may_include;
  bool vocabulary = false;  ///< and the headers of kVocabulary
};
const std::vector<Arrow> kArrows = {
    {kVocabulary, {}, true},
    {{"ramcdb/*"}, {"ramcdb/*"}},
    {{"codec/*"}, {"codec/*"}, true},
    {{"chartify/*"}, {"chartify/*"}, true},
    {{"db/*"}, {"db/*"}, true},
    {{"api/*"}, {"ramcdb/*", "api/*", "codec/*", "chartify/*", "db/*"}},
    {{"cli/*"}, {"ramcdb/*", "cli/*"}},
};

/// Where the headers of others may be read. Public headers show none but OpenMesh, in one of them. Tests and tools
/// are free.
struct ThirdParty {
  std::string_view header;
  Patterns allowed;
};
const std::vector<ThirdParty> kThirdParty = {
    {"lmdb.h", {"db/*.cpp", "db/lmdb_*.h"}},
    {"sqlite3.h", {"db/*.cpp", "db/sqlite_*.h"}},
    {"OpenMesh/*", {"ramcdb/patch.h", "api/*.cpp"}},
    {"Eigen/*", {"chartify/*.cpp"}},
    {"CLI/*", {"cli/*"}},
    {"xxhash.h", {"api/*.cpp", "codec/*.cpp", "db/*.cpp"}},
    {"fmt/*", {"api/*.cpp", "cli/*.cpp", "db/*.cpp"}},
    {"nlohmann/*", {"api/*.cpp", "cli/*", "db/*.cpp"}},
    {"fast_float/*", {"api/*.cpp", "cli/*.cpp"}},
};

bool matches(std::string_view text, std::string_view pattern) {
  return fnmatch(std::string(pattern).c_str(), std::string(text).c_str(), 0) == 0;
}

bool matches_any(std::string_view text, const Patterns& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](std::string_view p) { return matches(text, p); });
}

/// Why `file` may not include `header` of ours; nothing when it may.
std::optional<std::string> refuse_ours(const fs::path& root, const std::string& file, const std::string& header) {
  if (!fs::exists(root / header) && !fs::exists(root / "api/include" / header))
    return "includes are written from the root of the project, and there is no such file";
  for (const Arrow& arrow : kArrows) {
    if (!matches_any(file, arrow.files)) continue;
    if (matches_any(header, arrow.may_include) || (arrow.vocabulary && matches_any(header, kVocabulary))) return {};
    return "that arrow does not point down";
  }
  return "no arrow starts there";
}

std::optional<std::string> refuse_third_party(const std::string& file, const std::string& header) {
  for (const ThirdParty& library : kThirdParty)
    if (matches(header, library.header) && !matches_any(file, library.allowed))
      return "that library is wrapped elsewhere";
  return {};
}

void check_file(const fs::path& root, const std::string& file, std::vector<std::string>& violations) {
  static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  constexpr std::string_view kPublic = "api/include/";
  const std::string name = file.starts_with(kPublic) ? file.substr(kPublic.size()) : file;
  std::ifstream in(root / file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const std::string header = match[2];
    const auto refusal = match[1] == "\"" ? refuse_ours(root, name, header) : refuse_third_party(name, header);
    if (refusal) violations.push_back(file + ":" + std::to_string(number) + " includes " + header + ": " + *refusal);
  }
}

}  // namespace

std::vector<std::string> include_violations(const fs::path& root) {
  std::vector<std::string> files;
  for (const char* folder : {"api", "chartify", "cli", "codec", "db"}) {
    if (!fs::is_directory(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(entry.path().lexically_relative(root).generic_string());
  }
  if (files.empty()) throw std::runtime_error("no sources below " + root.string());
  std::sort(files.begin(), files.end());
  std::vector<std::string> violations;
  for (const std::string& file : files) check_file(root, file, violations);
  return violations;
}

}  // namespace ramcdb::house
