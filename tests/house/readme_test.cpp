#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "tests/house/project_tree.h"

/// The README speaks of files, commands and functions: all of them exist.
namespace ramcdb::house {
namespace {

namespace fs = std::filesystem;

/// First groups of all matches of a pattern, each once.
std::set<std::string> all_matches(const std::string& text, const char* pattern, std::size_t group = 1) {
  std::set<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.insert(match->str(group));
  return found;
}

TEST(Readme, LinksLeadToFiles) {
  const auto links = all_matches(read_project_file("README.md"), R"(\]\(([^)#:]+)\))");
  EXPECT_FALSE(links.empty());
  for (const std::string& link : links) EXPECT_TRUE(fs::exists(project_root() / link)) << link;
}

TEST(Readme, ToolsThatItNamesExist) {
  const auto tools = all_matches(read_project_file("README.md"), R"(\b(tools/[a-z_-]+(\.cpp|/[a-z_]+(\.svg)?)?))");
  EXPECT_THAT(tools, testing::IsSupersetOf({"tools/demo", "tools/test", "tools/setup"}));
  for (const std::string& tool : tools) EXPECT_TRUE(fs::exists(project_root() / tool)) << tool;
}

TEST(Readme, VerbsThatItShowsExist) {
  const std::string verbs = read_project_file("cli/verbs.h");
  const auto shown = all_matches(read_project_file("README.md"), R"((^|\n|`)\s*ramcdb ([a-z]+))", 2);
  EXPECT_THAT(shown, testing::IsSupersetOf({"init", "import", "checkout", "commit", "export"}));
  for (const std::string& verb : shown) EXPECT_THAT(verbs, testing::HasSubstr("void setup_" + verb + "(")) << verb;
}

TEST(Readme, EveryHopOfAChartIsWhereTheTableSays) {
  // A hop is written as `folder/file.cpp: function`.
  const std::string readme = read_project_file("README.md");
  const std::regex hop(R"(`([a-z]+/[a-z_/]+\.(?:cpp|h)): ([A-Za-z_:]+)`)");
  int hops = 0;
  for (std::sregex_iterator match(readme.begin(), readme.end(), hop), end; match != end; ++match, ++hops) {
    ASSERT_TRUE(fs::exists(project_root() / match->str(1))) << match->str(1);
    EXPECT_THAT(read_project_file(match->str(1)), testing::HasSubstr(match->str(2) + "(")) << match->str(1);
  }
  EXPECT_GE(hops, 6);
}

}  // namespace
}  // namespace ramcdb::house
