#include <gtest/gtest.h>

#include <random>

#include "codec/chart_codec.h"
#include "codec/chart_header.h"
#include "codec/dense_coder.h"
#include "codec/fast_coder.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"
#include "tests/codec/hostile_bytes.h"

/// Damaged and made-up chart blobs. The check in the header finds nearly all of them in the end; what lies behind it is
/// tried without it, too.
namespace ramcdb::codec {
namespace {

using testing::NamedChart;
using testing::refuses;

const CoderTables kBuiltIn;

void expect_valid(const std::vector<LatticePoint>& positions, const std::vector<Triangle>& faces) {
  for (const Triangle& face : faces)
    for (const std::uint32_t v : face) ASSERT_LT(v, positions.size());
  for (const LatticePoint p : positions)
    for (int a = 0; a < 3; ++a) ASSERT_LE(std::abs(p[a]), kMaxLatticeCoordinate);
}

struct Blob {
  EncodedChart encoded;
  LatticeBox range;

  [[nodiscard]] std::span<const LatticePoint> border() const {
    return std::span(encoded.decoded.positions).first(encoded.decoded.border_count());
  }
  void decode(Bytes bytes) const {
    const DecodedChart decoded = decode_chart(bytes, border(), encoded.decoded.loop_sizes, kBuiltIn, range);
    expect_valid(decoded.chart.positions, decoded.chart.faces);
  }
};

Blob blob_of(const Chart& chart, const LatticeBox& range, Profile profile = Profile::dense) {
  return {encode_chart(chart, profile, kBuiltIn, range), range};
}

std::vector<Chart> small_charts() {
  std::vector<Chart> charts{{}, testing::one_triangle(), testing::wheel(12, false)};
  for (const testing::TestMesh& mesh :
       {testing::torus(9, 6, 900), testing::sphere(2, 1000000), testing::terrain(7, 30, 1)}) {
    charts.push_back(testing::cut(mesh));
    charts.push_back(testing::cut(mesh, testing::random_region(mesh, 50, 3, 7)));
    charts.back().positions.push_back({4, 5, 6});
  }
  charts.push_back(testing::boxes(5));
  charts.push_back(testing::triangle_soup(12));
  charts.push_back(testing::triangle_soup(40));
  return charts;
}

std::vector<Blob> small_blobs() {
  std::vector<Blob> blobs;
  for (const Chart& chart : small_charts())
    for (const Profile profile : {Profile::dense, Profile::fast}) {
      blobs.push_back(blob_of(chart, testing::box_of(chart), profile));
      if (chart.positions.size() > chart.border_count())
        blobs.push_back(blob_of(chart, {{0, 0, 0}, {1, 1, 1}}, profile));
    }
  return blobs;
}

TEST(HostileChart, OtherLengthsAreRefused) {
  for (const Blob& blob : small_blobs())
    testing::expect_refuses_other_lengths([&](Bytes bytes) { blob.decode(bytes); }, blob.encoded.blob);
}

TEST(HostileChart, DamagedBytesAreRefused) {
  for (const Blob& blob : small_blobs())
    EXPECT_EQ(testing::count_taken_when_damaged([&](Bytes bytes) { blob.decode(bytes); }, blob.encoded.blob), 0)
        << testing::hex(blob.encoded.blob);
}

/// The context that `chart`'s stream is coded with.
DenseContext context_of(const Chart& chart) {
  DenseContext context;
  context.border = std::span(chart.positions).first(chart.border_count());
  context.loop_sizes = chart.loop_sizes;
  context.counts.faces = static_cast<std::uint32_t>(chart.faces.size());
  context.counts.inner_vertices = static_cast<std::uint32_t>(chart.positions.size()) - chart.border_count();
  context.expected = context.counts;
  context.edge_exponent = mean_edge_exponent(chart);
  context.box = testing::box_of(chart);
  context.tables = &kBuiltIn;
  return context;
}

TEST(HostileChart, DenseStreamsOfAnyKindEndInAChartOrAnError) {
  int taken = 0;
  for (const Chart& chart : small_charts()) {
    DenseContext context = context_of(chart);
    context.aligned = chart.faces.size() % 3 == 0;
    const auto stream = encode_dense(chart, context);
    if (!stream) continue;
    const auto decode = [&](Bytes bytes) {
      const DenseChart decoded = decode_dense(bytes, context);
      expect_valid(decoded.positions, decoded.faces);
      EXPECT_EQ(decoded.faces.size(), chart.faces.size());
      EXPECT_EQ(decoded.positions.size(), chart.positions.size());
    };
    taken += testing::count_taken_when_damaged(decode, stream->bytes);
    for (std::size_t n = 0; n < stream->bytes.size(); ++n) (void)refuses(decode, Bytes(stream->bytes).first(n));
  }
  EXPECT_GT(taken, 0) << "otherwise the test above tried nothing but refusals";
}

TEST(HostileChart, RandomDenseStreamsWithRandomCountsEnd) {
  std::mt19937 random(11);
  const Chart chart = testing::cut(testing::terrain(7, 30, 1));
  for (int run = 0; run < 3000; ++run) {
    DenseContext context = context_of(chart);
    context.counts = {static_cast<std::uint32_t>(random() % 2000), static_cast<std::uint32_t>(random() % 4000)};
    context.expected = {};
    context.edge_exponent = static_cast<int>(random() % 32);
    context.box = {{-kMaxLatticeCoordinate, -kMaxLatticeCoordinate, -kMaxLatticeCoordinate},
                   {kMaxLatticeCoordinate, kMaxLatticeCoordinate, kMaxLatticeCoordinate}};
    Buffer bytes(random() % 600);
    const std::uint32_t zeros = static_cast<std::uint32_t>(random() % 5);
    for (auto& b : bytes) b = random() % 4 < zeros ? 0 : static_cast<std::uint8_t>(random());
    (void)refuses(
        [&](Bytes stream) {
          const DenseChart decoded = decode_dense(stream, context);
          expect_valid(decoded.positions, decoded.faces);
        },
        bytes);
  }
}

TEST(HostileChart, DeclaredCountsCostNothingBeforeTheyAreThere) {
  const Chart border = testing::wheel(50, false);
  for (const ChartCoding coding : {ChartCoding::raw, ChartCoding::dense, ChartCoding::fast})
    for (const int filling : {0, 1, 85, 128, 255})
      for (const std::size_t length : {0, 20, 300, 3000}) {
        ChartHeader header;
        header.coding = coding;
        header.counts = {kMaxChartVertices, kMaxChartFaces};
        Buffer blob;
        put_chart_header(blob, header);
        blob.resize(blob.size() + length, static_cast<std::uint8_t>(filling));
        EXPECT_TRUE(refuses(
            [&](Bytes bytes) {
              (void)decode_chart(bytes, std::span(border.positions).first(50), border.loop_sizes, kBuiltIn,
                                 testing::box_of(border));
            },
            blob))
            << filling << " x " << length;
      }
}

TEST(HostileChart, LongSentencesOfTheSameByteEndInTime) {
  // The stream that says "yes" longest: everything it drives ends at the declared counts.
  DenseContext context;
  context.counts = {1 << 16, 1 << 17};
  context.box = {{0, 0, 0}, {kMaxLatticeCoordinate, kMaxLatticeCoordinate, kMaxLatticeCoordinate}};
  context.tables = &kBuiltIn;
  for (const int filling : {0, 255, 1, 170}) {
    const Buffer bytes(100000, static_cast<std::uint8_t>(filling));
    EXPECT_TRUE(refuses([&](Bytes stream) { (void)decode_dense(stream, context); }, bytes)) << filling;
  }
}

FastContext fast_context_of(const Chart& chart) {
  const DenseContext context = context_of(chart);
  return {context.border, context.loop_sizes, context.counts, context.box, &kBuiltIn};
}

TEST(HostileChart, FastStreamsOfAnyKindEndInAChartOrAnError) {
  int taken = 0;
  for (const Chart& chart : small_charts()) {
    const FastContext context = fast_context_of(chart);
    const auto stream = encode_fast(chart, context);
    if (!stream) continue;
    const auto decode = [&](Bytes bytes) {
      const FastChart decoded = decode_fast(bytes, context);
      expect_valid(decoded.positions, decoded.faces);
      EXPECT_EQ(decoded.faces.size(), chart.faces.size());
      EXPECT_EQ(decoded.positions.size(), chart.positions.size());
    };
    taken += testing::count_taken_when_damaged(decode, stream->bytes);
    for (std::size_t n = 0; n < stream->bytes.size(); ++n)
      EXPECT_TRUE(refuses(decode, Bytes(stream->bytes).first(n)) || chart.faces.empty()) << n;
  }
  EXPECT_GT(taken, 0) << "otherwise the test above tried nothing but refusals";
}

TEST(HostileChart, RandomFastStreamsWithRandomCountsEnd) {
  std::mt19937 random(12);
  const Chart chart = testing::cut(testing::terrain(7, 30, 1));
  const auto good = encode_fast(chart, fast_context_of(chart));
  ASSERT_TRUE(good);
  for (int run = 0; run < 6000; ++run) {
    FastContext context = fast_context_of(chart);
    context.counts = {static_cast<std::uint32_t>(random() % 2000), static_cast<std::uint32_t>(random() % 4000)};
    if (run % 3 == 0) context.counts = fast_context_of(chart).counts;
    context.box = {{-kMaxLatticeCoordinate, -kMaxLatticeCoordinate, -kMaxLatticeCoordinate},
                   {kMaxLatticeCoordinate, kMaxLatticeCoordinate, kMaxLatticeCoordinate}};
    Buffer bytes = good->bytes;  // some begin well, so that what lies behind is tried, too
    const std::size_t kept = random() % 3 == 0 ? random() % bytes.size() : 0;
    bytes.resize(std::max<std::size_t>(kept, random() % 600));
    for (std::size_t i = kept; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(random());
    if (kept == 0 && bytes.size() > 2) {
      bytes[0] = static_cast<std::uint8_t>(random() % 128);
      bytes[1] = static_cast<std::uint8_t>(random() % std::min<std::size_t>(bytes.size(), 128));
    }
    (void)refuses(
        [&](Bytes stream) {
          const FastChart decoded = decode_fast(stream, context);
          expect_valid(decoded.positions, decoded.faces);
        },
        bytes);
  }
}

TEST(HostileChart, LongFastSentencesOfTheSameByteEndInTime) {
  FastContext context;
  context.counts = {1 << 16, 1 << 17};
  context.box = {{0, 0, 0}, {kMaxLatticeCoordinate, kMaxLatticeCoordinate, kMaxLatticeCoordinate}};
  context.tables = &kBuiltIn;
  for (const int filling : {0, 255, 1, 170, 85}) {
    const Buffer bytes(100000, static_cast<std::uint8_t>(filling));
    EXPECT_TRUE(refuses([&](Bytes stream) { (void)decode_fast(stream, context); }, bytes)) << filling;
  }
}

TEST(HostileChart, AnotherBorderTableOrRangeIsNoticed) {
  const testing::TestMesh land = testing::terrain(7, 30, 1);
  const Chart chart = testing::cut(land);
  const LatticeBox range = testing::box_of(chart);
  const EncodedChart encoded = encode_chart(chart, Profile::dense, kBuiltIn, range);
  std::vector<LatticePoint> border(chart.positions.begin(), chart.positions.begin() + chart.border_count());
  const auto decodes = [&](std::span<const std::uint32_t> loops, const CoderTables& tables, const LatticeBox& box) {
    return !refuses([&](Bytes bytes) { (void)decode_chart(bytes, border, loops, tables, box); }, encoded.blob);
  };
  EXPECT_TRUE(decodes(chart.loop_sizes, kBuiltIn, range));

  LatticeBox wider = range;
  wider.hi.z += 1;
  EXPECT_FALSE(decodes(chart.loop_sizes, kBuiltIn, wider));
  EXPECT_FALSE(decodes(chart.loop_sizes, kBuiltIn, {{0, 0, 0}, {2000000000, 0, 0}}));
  CoderTables other;
  other.plane[15][2] = static_cast<std::int16_t>(other.plane[15][2] + 1);
  EXPECT_FALSE(decodes(chart.loop_sizes, other, range));
  EXPECT_FALSE(decodes(std::vector<std::uint32_t>{3, chart.loop_sizes[0] - 3}, kBuiltIn, range));
  EXPECT_FALSE(decodes(std::vector<std::uint32_t>{2, chart.loop_sizes[0] - 2}, kBuiltIn, range));
  EXPECT_FALSE(decodes(std::vector<std::uint32_t>{0xffffffff, 0xffffffff}, kBuiltIn, range));
  EXPECT_FALSE(decodes({}, kBuiltIn, range));
  for (std::size_t v = 0; v < border.size(); ++v)
    for (const std::int32_t x : {border[v].x + 1, std::numeric_limits<std::int32_t>::min()}) {
      const std::int32_t before = std::exchange(border[v].x, x);
      EXPECT_FALSE(decodes(chart.loop_sizes, kBuiltIn, range)) << "border vertex " << v;
      border[v].x = before;
    }
}

TEST(HostileChart, OtherFastTablesAreNoticed) {
  const Chart chart = testing::cut(testing::terrain(7, 30, 1));
  const LatticeBox range = testing::box_of(chart);
  const EncodedChart encoded = encode_chart(chart, Profile::fast, kBuiltIn, range);
  ASSERT_EQ(encoded.coding, ChartCoding::fast);
  CoderTables other;
  FastNumbers numbers = other.fast.numbers();
  numbers.weights[287][5] = static_cast<std::int16_t>(numbers.weights[287][5] + 1);
  other.fast = FastTables(numbers);
  EXPECT_TRUE(refuses(
      [&](Bytes bytes) {
        (void)decode_chart(bytes, std::span(chart.positions).first(chart.border_count()), chart.loop_sizes, other,
                           range);
      },
      encoded.blob));
}

TEST(HostileChart, UnknownFormatsAndCodingsAreRefused) {
  const Blob blob = blob_of(testing::one_triangle(), testing::box_of(testing::one_triangle()));
  const auto code_with = [&](std::size_t at, int value) {
    Buffer changed = blob.encoded.blob;
    changed[at] = static_cast<std::uint8_t>(value);
    try {
      blob.decode(changed);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::cancelled;  // stands for "took it"
  };
  EXPECT_EQ(code_with(0, 0), Errc::corrupt);
  EXPECT_EQ(code_with(0, 2), Errc::unsupported_version);
  for (const int coding : {0, 4, 255}) EXPECT_EQ(code_with(1, coding), Errc::corrupt);
  for (const int flags : {2, 128}) EXPECT_EQ(code_with(2, flags), Errc::corrupt);
}

}  // namespace
}  // namespace ramcdb::codec
