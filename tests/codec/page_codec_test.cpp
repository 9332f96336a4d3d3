#include "codec/page_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "ramcdb/error.h"
#include "tests/codec/hostile_bytes.h"
#include "tests/codec/page_families.h"

namespace ramcdb::codec {
namespace {

using testing::pages;

TEST(PageCodec, PagesComeBack) {
  for (const auto& [name, page] : pages()) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(validate_page(page, name));
    const Buffer blob = encode_page(page);
    EXPECT_EQ(decode_page(blob), page);
    EXPECT_EQ(encode_page(decode_page(blob)), blob);
  }
}

TEST(PageCodec, AChartWithItsWiresAndCornersTakesFewBytes) {
  const LeafPage page = testing::quad_page(8, 32, 5);
  EXPECT_LT(encode_page(page).size(), 38 * page.charts.size());
}

/// What it returns keeps the rules, or it throws.
void decode_and_check(Bytes bytes) {
  const Page page = decode_page(bytes);
  EXPECT_NO_THROW(validate_page(page, "decoded"));
  EXPECT_EQ(decode_page(encode_page(page)), page);
}

TEST(PageCodec, OtherLengthsGiveAPageOrAnError) {
  for (const auto& [name, page] : pages()) testing::expect_survives_other_lengths(decode_and_check, encode_page(page));
}

TEST(PageCodec, DamagedBytesGiveAPageOrAnError) {
  int taken = 0;
  for (const auto& [name, page] : pages())
    if (const Buffer blob = encode_page(page); blob.size() < 160)
      taken += testing::count_taken_when_damaged(decode_and_check, blob);
  EXPECT_GT(taken, 0) << "otherwise nothing but refusals was tried";
}

TEST(PageCodec, MadeUpBytesGiveAPageOrAnError) {
  std::mt19937 random(3);
  for (int run = 0; run < 5000; ++run) {
    Buffer blob{static_cast<std::uint8_t>(0x11 + run % 2)};
    const std::uint32_t zeros = static_cast<std::uint32_t>(random() % 5);
    for (std::size_t n = random() % 200; n > 0; --n)
      blob.push_back(random() % 4 < zeros ? 0 : static_cast<std::uint8_t>(random()));
    (void)testing::refuses(decode_and_check, blob);
  }
  for (const int filling : {0, 255, 1, 170})
    for (const int kind : {0x11, 0x12}) {
      Buffer blob(3000, static_cast<std::uint8_t>(filling));
      blob[0] = static_cast<std::uint8_t>(kind);
      (void)testing::refuses(decode_and_check, blob);
    }
}

TEST(PageCodec, UnknownFormatsAndKindsAreRefused) {
  const auto code_with = [&](int head) {
    Buffer blob = encode_page(InnerPage{});
    blob[0] = static_cast<std::uint8_t>(head);
    try {
      (void)decode_page(blob);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::cancelled;  // stands for "took it"
  };
  EXPECT_EQ(code_with(0x12), Errc::cancelled);
  EXPECT_EQ(code_with(0x00), Errc::corrupt);
  EXPECT_EQ(code_with(0x10), Errc::corrupt);
  EXPECT_EQ(code_with(0x13), Errc::corrupt);
  EXPECT_EQ(code_with(0x21), Errc::unsupported_version);
  EXPECT_THROW((void)decode_page({}), Error);
}

// ---- the rules ----

/// A change that breaks a rule, and the rule's name in the error.
template <class SomePage>
struct Breach {
  const char* says;
  std::function<void(SomePage&)> commit;
};

template <class SomePage>
void expect_refused(const SomePage& good, const std::vector<Breach<SomePage>>& breaches) {
  ASSERT_NO_THROW(validate_page(good, "good"));
  for (const auto& [says, commit] : breaches) {
    SomePage bad = good;
    commit(bad);
    try {
      validate_page(bad, "page 7");
      ADD_FAILURE() << "took it although " << says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::corrupt);
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("(page 7)"), std::string::npos) << e.what();
    }
    try {
      (void)encode_page(bad);
      ADD_FAILURE() << "coded it although " << says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument) << says;
    }
  }
}

TEST(PageRules, LeafPages) {
  expect_refused<LeafPage>(
      testing::quad_page(6, 12, 4),
      {
          {"charts are out of order", [](LeafPage& p) { std::swap(p.charts[0], p.charts[1]); }},
          {"charts are out of order", [](LeafPage& p) { p.charts[1] = p.charts[0]; }},
          {"charts are out of order", [](LeafPage& p) { p.charts[0].id = ChartId(); }},
          {"wires are out of order", [](LeafPage& p) { std::swap(p.wires[2], p.wires[3]); }},
          {"corners are out of order", [](LeafPage& p) { std::swap(p.corners[2], p.corners[3]); }},
          {"a corner leaves the lattice", [](LeafPage& p) { p.corners[1].position.y = kMaxLatticeCoordinate + 1; }},
          {"a wire ends in a corner that is not there", [](LeafPage& p) { p.wires[4].end = CornerId(99999); }},
          {"a wire ends in a corner that is not there", [](LeafPage& p) { p.wires[4].begin = CornerId(); }},
          {"a corner ends no wire",
           [](LeafPage& p) {
             p.corners.push_back({CornerId(99999), {}});
           }},
          {"a wire borders no chart of the page",
           [](LeafPage& p) {
             p.wires.push_back(p.wires.back());
             p.wires.back().id = WireId(99999);
           }},
          {"the charts of a wire are out of order",
           [](LeafPage& p) {
             p.wires[0].charts = {ChartId(9), ChartId(2)};
           }},
          {"a wire and the loops do not agree on its charts", [](LeafPage& p) { p.wires[0].charts.clear(); }},
          {"a wire and the loops do not agree on its charts",
           [](LeafPage& p) {
             p.wires[0].charts.push_back(p.charts.back().id);
             std::sort(p.wires[0].charts.begin(), p.wires[0].charts.end());
           }},
          {"a wire names no chart",
           [](LeafPage& p) { p.wires[0].charts.insert(p.wires[0].charts.begin(), ChartId()); }},
          {"a loop passes no wire", [](LeafPage& p) { p.charts[3].loops.emplace_back(); }},
          {"a loop names a wire that is not there", [](LeafPage& p) { p.charts[3].loops[0][1].wire = WireId(99999); }},
          {"a loop has a gap", [](LeafPage& p) { p.charts[3].loops[0][1].reversed ^= true; }},
          {"a loop does not close", [](LeafPage& p) { p.charts[3].loops[0].pop_back(); }},
          {"a loop is of no piece", [](LeafPage& p) { p.charts[3].pieces.of_loop.clear(); }},
          {"pieces are not numbered by their loops", [](LeafPage& p) { p.charts[3].pieces.of_loop[0] = 1; }},
          {"a chart has other faces than its pieces", [](LeafPage& p) { p.charts[3].faces = 0; }},
          {"a chart has other faces than its pieces",
           [](LeafPage& p) { p.charts[3].pieces.closed = p.charts[3].faces; }},
          {"layers are out of order",
           [](LeafPage& p) {
             p.charts[3].layers = {{2, {}}, {2, {}}};
           }},
          {"a box does not hold a corner", [](LeafPage& p) { p.charts[3].box.hi.y = p.charts[3].box.lo.y; }},
          {"a box does not hold a corner", [](LeafPage& p) { p.charts[3].box = {}; }},
          {"a box is inside out", [](LeafPage& p) { p.charts[3].box.hi.z = p.charts[3].box.lo.z - 1; }},
          {"a box is inside out",
           [](LeafPage& p) {
             p.charts[3].box = {{5, 0, 0}, {4, 0, 0}};
           }},
          {"a box leaves the lattice", [](LeafPage& p) { p.charts[3].box.lo.x = -kMaxLatticeCoordinate - 1; }},
      });
}

TEST(PageRules, InnerPages) {
  InnerPage good;
  good.pages.push_back({PageId(3), VersionId(1), {{0, 0, 0}, {1, 1, 1}}, 12, {{ChartId(1), 4}, {ChartId(6), 2}}});
  expect_refused<InnerPage>(
      good,
      {
          {"an entry names no page", [](InnerPage& p) { p.pages[0].id = PageId(); }},
          {"runs of charts", [](InnerPage& p) { p.pages[0].charts[0].count = 0; }},
          {"runs of charts", [](InnerPage& p) { p.pages[0].charts[0].count = 5; }},
          {"runs of charts", [](InnerPage& p) { p.pages[0].charts[0].first = ChartId(); }},
          {"runs of charts", [](InnerPage& p) { std::swap(p.pages[0].charts[0], p.pages[0].charts[1]); }},
          {"a run of charts leaves the range of ids", [](InnerPage& p) { p.pages[0].charts[1].count = 0xffffffff; }},
          {"a box is inside out", [](InnerPage& p) { p.pages[0].box.hi.y = -1; }},
          {"a box leaves the lattice", [](InnerPage& p) { p.pages[0].box.hi.y = kMaxLatticeCoordinate + 1; }},
      });
}

TEST(PageCodec, TooManyChartsAreRefused) {
  LeafPage page;
  for (std::uint32_t id = 1; id <= (1 << 13) + 1; ++id) {
    page.charts.emplace_back();
    page.charts.back().id = ChartId(id);
  }
  EXPECT_THROW((void)encode_page(page), Error);
  page.charts.pop_back();
  EXPECT_EQ(decode_page(encode_page(page)), Page(page));
}

TEST(PageCodec, GoldenBytes) {
  // Bytes of format 1: never to change.
  EXPECT_EQ(testing::hex(encode_page(LeafPage{})), "110000000080");
  EXPECT_EQ(testing::hex(encode_page(testing::quad_page(3, 2, 9))),
            "11000000035a07aabe41c005d918ed961707b61c50a3f65249e72d34a98ee47177706bc0a8bb5684dc306594e4f29b5eec28"
            "c3bfc4ae924dc1d8e2731820be5ef5005a41ee3478c68e060203aec9b4d3d74c40fc497c6f7e2429fb");
  const auto hex_of = [](std::string_view wanted) {
    for (const auto& [name, page] : pages())
      if (name == wanted) return testing::hex(encode_page(page));
    return std::string();
  };
  EXPECT_EQ(hex_of("odd leaf"),
            "110000038426a7fe80905828425c6933da6c788d118576638985d30eaf2860795374a249214272ef3a739382298d878f5b9e"
            "98201017a5b5a08532a2b7e82d5d196e2f102a5cc977d647c7a2f4713b0a6a");
  EXPECT_EQ(hex_of("extreme inner page"),
            "12ffffffff3e32c079c1cf4eef7fe9070ad8bcb72bff57a4e222d271bffc505c50f7125b7fef32afb3c5cf75ffe01ac7aed3"
            "15c5ffb90e40001a9aa800079dbe4502c421720a000652802993435dbb4247ecf8e299963a4519964e38316f64a2282b7fe9"
            "b02f751a40312c");
}

}  // namespace
}  // namespace ramcdb::codec
