#include <gmock/gmock.h>

#include <sstream>

#include "tests/cli/program.h"

namespace ramcdb::test {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

const std::vector<std::string> kVerbs = {"init",   "import", "ls",     "info",      "charts",   "checkout",
                                         "status", "diff",   "commit", "log",       "show",     "export",
                                         "repack", "branch", "tag",    "lock",      "unlock",   "locks",
                                         "merge",  "revert", "smooth", "transform", "decimate", "verify"};

/// The lines behind "Example:".
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream in(help.substr(std::min(help.find("Example:"), help.size())));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line))
    if (!line.empty()) examples.push_back(line);
  return examples;
}

TEST(Help, ListsEveryVerbAndNoOther) {
  const Outcome outcome = run_ramcdb({"--help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const std::string& verb : kVerbs) EXPECT_THAT(outcome.out, HasSubstr("  " + verb + " "));
  for (const char* later : {"prune", "backup"})
    EXPECT_THAT(outcome.out, Not(HasSubstr(std::string("  ") + later + " ")));
}

TEST(Help, EveryVerbHasAnExampleOfItself) {
  for (const std::string& verb : kVerbs) {
    const Outcome outcome = run_ramcdb({verb, "--help"});
    EXPECT_EQ(outcome.code, 0) << verb;
    EXPECT_EQ(outcome.err, "") << verb;
    const auto examples = examples_in(outcome.out);
    ASSERT_FALSE(examples.empty()) << verb;
    for (const std::string& example : examples) EXPECT_EQ(example.rfind("  ramcdb " + verb + " ", 0), 0U) << example;
  }
}

/// Splits as a shell does, as far as examples need it: spaces and double quotes.
Arguments split(const std::string& command) {
  Arguments words;
  bool quoted = false, open = false;
  for (const char c : command) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

TEST(Help, EveryExampleIsRightUsage) {
  for (const std::string& verb : kVerbs) {
    if (verb == "init") continue;  // it would work, and leave a folder here
    for (const std::string& example : examples_in(run_ramcdb({verb, "--help"}).out)) {
      Arguments arguments = split(example);
      arguments.erase(arguments.begin());
      EXPECT_EQ(run_ramcdb(arguments).code, 1) << example << ": only its files should be missing";
    }
  }
}

TEST(Help, Version) {
  const Outcome outcome = run_ramcdb({"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, MatchesRegex("ramcdb [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace ramcdb::test
