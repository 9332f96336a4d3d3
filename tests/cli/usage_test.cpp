#include <gmock/gmock.h>

#include "tests/cli/scene.h"

/// Wrong usage ends with exit code 2 and one line, before anything is touched.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

void expect_wrong_usage(const Arguments& arguments) {
  SCOPED_TRACE(testing::PrintToString(arguments));
  expect_failure(run_ramcdb(arguments), 2);
}

TEST(Usage, NothingAtAllPrintsShortHelp) {
  const Outcome outcome = run_ramcdb({});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("ramcdb --help"));
}

TEST(Usage, UnknownVerbsAndOptions) {
  expect_wrong_usage({"frobnicate"});
  expect_wrong_usage({""});
  expect_wrong_usage({"--frobnicate"});
  expect_wrong_usage({"info", "repo", "--frobnicate"});
  expect_wrong_usage({"info", "repo", "extra"});
  expect_wrong_usage({"ls", "repo", "--color", "chart"});
}

TEST(Usage, UnknownVerbIsNamed) { EXPECT_THAT(run_ramcdb({"frobnicate"}).err, HasSubstr("'frobnicate'")); }

TEST(Usage, MissingArguments) {
  for (const char* verb : {"init", "ls", "info", "charts", "log", "export", "verify", "status", "commit", "diff"})
    expect_wrong_usage({verb});
  expect_wrong_usage({"import", "repo"});
  expect_wrong_usage({"show", "repo"});
  expect_wrong_usage({"checkout", "repo", "--all"});
  expect_wrong_usage({"checkout", "repo", "-o", "out.ply"});
  expect_wrong_usage({"charts", "repo"});
  expect_wrong_usage({"charts", "repo", "--grow", "1"});
  expect_wrong_usage({"diff", "repo", "1"});
  expect_wrong_usage({"diff", "file.ply", "--mesh", "wavy"});
}

TEST(Usage, CommitWantsAMessage) {
  expect_wrong_usage({"commit", "file.ply"});
  expect_wrong_usage({"commit", "file.ply", "-m"});
  expect_wrong_usage({"commit", "file.ply", "-m", ""});
}

TEST(Usage, MalformedRegions) {
  for (const char* box :
       {"", "1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7", "a,b,c,d,e,f", "1,2,3,4,5,nan", "0,0,0,1,1,1x", "0,0,0,1,1,"})
    expect_wrong_usage({"charts", "repo", "--box", box});
  for (const char* sphere : {"1,2,3", "1,2,3,-1", "1,2,3,r", "1,2,3,inf"})
    expect_wrong_usage({"charts", "repo", "--sphere", sphere});
  for (const char* charts : {"0", "-1", "5-", "9-5", "1,,2", "x", "1-2-3", "4294967296", "1.5"})
    expect_wrong_usage({"charts", "repo", "--charts", charts});
  for (const char* point : {"1,2", "1,2,3,4", "1,2,z"}) expect_wrong_usage({"charts", "repo", "--near", point});
  expect_wrong_usage({"charts", "repo", "--frustum", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0"});
  expect_wrong_usage({"charts", "repo", "--all", "--grow", "-1"});
}

TEST(Usage, NumbersOutOfRange) {
  for (const char* bits : {"0", "31", "-3", "many"}) expect_wrong_usage({"import", "repo", "a.ply", "--bits", bits});
  for (const char* length : {"0", "-1", "nan", "inf", "wide"})
    expect_wrong_usage({"import", "repo", "a.ply", "--precision", length});
  expect_wrong_usage({"import", "repo", "a.ply", "--chart-faces", "0"});
  expect_wrong_usage({"import", "repo", "a.ply", "--profile", "fluffy"});
  expect_wrong_usage({"import", "repo", "a.ply", "--chartify", "fluffy"});
  expect_wrong_usage({"export", "repo", "-o", "a.ply", "--color", "1"});
  for (const char* threads : {"0", "-1", "two"}) expect_wrong_usage({"verify", "repo", "-j", threads});
  expect_wrong_usage({"log", "repo", "-n", "-1"});
}

TEST(Usage, LatticeIsSaidOneWay) {
  expect_wrong_usage({"import", "repo", "a.ply", "--bits", "12", "--precision", "0.1"});
  expect_wrong_usage({"import", "repo", "a.ply", "--bits", "12", "--lattice-of", "b"});
  expect_wrong_usage({"import", "repo", "a.ply", "--precision", "0.1", "--lattice-of", "b"});
}

class UsageInRepository : public SceneTest {};

TEST_F(UsageInRepository, RegionNumbersMayBeNegative) {
  expect_done(run_ramcdb({"charts", repo_, "--box", "-1,-1,-1,2,2,2"}));
  expect_done(run_ramcdb({"charts", repo_, "--near", "-0.5,1e-3,0.25"}));
  expect_done(run_ramcdb({"charts", repo_, "--frustum", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1"}));
}

TEST_F(UsageInRepository, ARepositoryMayBeCalledLikeAVerb) {
  expect_done(run_ramcdb({"init", path("log"), "-q"}));
  expect_done(run_ramcdb({"ls", path("log")}));
}

}  // namespace
}  // namespace ramcdb::test
