#include "cli/text.h"

#include <gmock/gmock.h>

#include "cli/chart_list.h"
#include "cli/name_text.h"
#include "cli/progress_line.h"
#include "cli/table.h"

/// The pure parts of the command line.
namespace ramcdb::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Text, GroupsByThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(1234567), "1,234,567");
  EXPECT_EQ(grouped(18446744073709551615ULL), "18,446,744,073,709,551,615");
}

TEST(Text, CountsWithTheRightNoun) {
  EXPECT_EQ(counted(1, "chart"), "1 chart");
  EXPECT_EQ(counted(0, "chart"), "0 charts");
  EXPECT_EQ(counted(2, "vertex", "vertices"), "2 vertices");
}

TEST(Text, ModelUnitsBringFloatsBack) {
  const float third = 1.0F / 3.0F;
  EXPECT_EQ(std::stof(model_units(third)), third);
  EXPECT_EQ(model_units(0.001), "0.001");
}

TEST(Text, Durations) {
  EXPECT_EQ(duration(0.421), "0.42 s");
  EXPECT_EQ(duration(8.06), "8.1 s");
  EXPECT_EQ(duration(59.4), "59 s");
  EXPECT_EQ(duration(59.6), "1 min 00 s");
  EXPECT_EQ(duration(7500), "2 h 05 min");
}

TEST(Text, TimesAreIsoInUtc) {
  EXPECT_EQ(iso_time(0, false), "1970-01-01T00:00:00Z");
  EXPECT_EQ(iso_time(1'709'210'096'000'042, true), "2024-02-29T12:34:56.000042Z");
  EXPECT_EQ(iso_time(-1, true), "1969-12-31T23:59:59.999999Z");
}

TEST(Text, ForeignTextCannotMoveTheCursor) {
  EXPECT_EQ(one_line("first\nsecond"), "first");
  EXPECT_EQ(one_line("\033[2Jred\tblue\x7f"), "?[2Jred?blue?");
  EXPECT_EQ(one_line("caf\xc3\xa9"), "caf\xc3\xa9");
}

TEST(Text, ChartListsReadAsTheOptionTakesThem) {
  EXPECT_EQ(chart_list({}), "");
  EXPECT_EQ(chart_list({ChartId(7)}), "7");
  EXPECT_EQ(chart_list({ChartId(5), ChartId(9), ChartId(10), ChartId(11), ChartId(12)}), "5,9-12");
  EXPECT_EQ(chart_list({ChartId(1), ChartId(2), ChartId(4)}), "1,2,4");
}

TEST(Text, TablesAreAligned) {
  Table table({{"mesh", Table::Align::left}, {"faces"}, {"note", Table::Align::left}});
  table.add({"caf\xc3\xa9", "1", "x"});
  table.add({"dragon", "1,000", ""});
  EXPECT_EQ(table.text(), "mesh    faces  note\ncaf\xc3\xa9        1  x\ndragon  1,000\n");
}

ProgressState half_way() { return {.verb = "import", .stage = "reading", .done = 0.5, .stage_seconds = 10}; }

TEST(ProgressLine, SaysStageShareRateAndTimeLeft) {
  EXPECT_EQ(progress_line(half_way(), 79),
            "import: reading  [###############---------------]  50 %  5.0 %/s  10 s left");
  ProgressState state = half_way();
  state.total_bytes = 4e8;
  EXPECT_THAT(progress_line(state, 79), HasSubstr("20.0 MB/s"));
}

TEST(ProgressLine, NeverExceedsTheWidth) {
  for (std::size_t width = 0; width < 120; ++width) EXPECT_LE(progress_line(half_way(), width).size(), width);
  EXPECT_THAT(progress_line(half_way(), 35), AllOf(HasSubstr("50 %"), HasSubstr("left"), Not(HasSubstr("#"))));
}

TEST(ProgressLine, MakesNothingUpBeforeTheFirstReport) {
  EXPECT_EQ(progress_line({.verb = "verify", .stage = "", .done = 0, .stage_seconds = 0.5}, 25),
            "verify  [---------]   0 %");
  EXPECT_THAT(progress_line({.verb = "verify", .stage = "", .done = 0, .stage_seconds = 3}, 79),
              Not(HasSubstr("left")));
}

TEST(Text, TimesThatLocksLast) {
  const std::pair<const char*, std::int64_t> cases[] = {{"1s", 1},       {"90m", 5400},
                                                        {"2h", 7200},    {"3d", 259'200},
                                                        {"1w", 604'800}, {"3650d", 315'360'000},
                                                        {"3651d", 0},    {"99999999999999999999h", 0},
                                                        {"0h", 0},       {"-1h", 0},
                                                        {"", 0},         {"h", 0},
                                                        {"2", 0},        {"2x", 0},
                                                        {"2hh", 0},      {"2 h", 0},
                                                        {"1.5h", 0}};
  for (const auto& [text, seconds] : cases) EXPECT_EQ(seconds_of(text), seconds) << text;
}

}  // namespace
}  // namespace ramcdb::cli
