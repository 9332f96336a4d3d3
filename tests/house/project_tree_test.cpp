#include "tests/house/project_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace ramcdb::house {
namespace {

TEST(ProjectTree, TopLevelHoldsWhatWasAgreedAndNothingElse) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout";
  std::set<std::string> top;
  for (const std::string& file : files)
    if (file.front() != '.') top.insert(file.substr(0, file.find('/')));
  EXPECT_THAT(top, testing::IsSubsetOf(
                       {"CMakeLists.txt", "db", "codec", "chartify", "api", "cli", "tests", "tools", "README.md"}));
}

TEST(ProjectTree, PublicHeadersStandInOneFolder) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout";
  for (const std::string& file : files)
    EXPECT_TRUE(!file.starts_with("api/include/") || file.starts_with("api/include/ramcdb/")) << file;
}

}  // namespace
}  // namespace ramcdb::house
