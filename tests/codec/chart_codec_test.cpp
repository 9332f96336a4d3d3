#include "codec/chart_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "ramcdb/error.h"
#include "tests/codec/chart_cutter.h"
#include "tests/codec/chart_families.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

using testing::NamedChart;

const CoderTables kTables;

constexpr Profile kProfiles[] = {Profile::dense, Profile::fast};

EncodedChart encode(const Chart& chart, const LatticeBox& range, Profile profile = Profile::dense) {
  return encode_chart(chart, profile, kTables, range);
}
EncodedChart encode(const Chart& chart, Profile profile = Profile::dense) {
  return encode(chart, testing::box_of(chart), profile);
}

DecodedChart decode(const EncodedChart& encoded, const LatticeBox& range) {
  const Chart& chart = encoded.decoded;
  return decode_chart(encoded.blob, std::span(chart.positions).first(chart.border_count()), chart.loop_sizes, kTables,
                      range);
}

/// `faces` with each begun where it is least, sorted.
std::vector<Triangle> sorted_faces(std::vector<Triangle> faces) {
  for (Triangle& f : faces) f = std::min({f, Triangle{f[1], f[2], f[0]}, Triangle{f[2], f[0], f[1]}});
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// That `decoded` is `chart`, its inner vertices renumbered as `source` says and its faces in another order.
void expect_same_surface(const Chart& chart, const Chart& decoded, const std::vector<std::uint32_t>& source) {
  ASSERT_EQ(decoded.loop_sizes, chart.loop_sizes);
  ASSERT_EQ(source.size(), chart.positions.size());
  ASSERT_EQ(decoded.positions.size(), chart.positions.size());
  EXPECT_EQ(std::set<std::uint32_t>(source.begin(), source.end()).size(), source.size());
  for (std::uint32_t v = 0; v < source.size(); ++v) {
    ASSERT_LT(source[v], source.size());
    EXPECT_EQ(decoded.positions[v], chart.positions[source[v]]);
    EXPECT_TRUE(source[v] == v || v >= chart.border_count());
  }
  std::vector<Triangle> renumbered = decoded.faces;
  for (Triangle& f : renumbered)
    for (std::uint32_t& v : f) v = source[v];
  EXPECT_EQ(sorted_faces(renumbered), sorted_faces(chart.faces));
}

/// That every decoded face is the one that it says, from the corner that it says.
void expect_sources(const Chart& chart, const EncodedChart& encoded) {
  std::set<std::uint32_t> faces;
  ASSERT_EQ(encoded.source_corner.size(), chart.faces.size());
  for (std::size_t f = 0; f < chart.faces.size(); ++f) {
    const std::uint32_t corner = encoded.source_corner[f];
    ASSERT_LT(corner, 3 * chart.faces.size());
    EXPECT_TRUE(faces.insert(corner / 3).second);
    for (std::uint32_t i = 0; i < 3; ++i)
      EXPECT_EQ(encoded.source_vertex[encoded.decoded.faces[f][i]], chart.faces[corner / 3][(corner + i) % 3]);
  }
}

void expect_round_trip(const Chart& chart, const LatticeBox& range, Profile profile) {
  const EncodedChart encoded = encode(chart, range, profile);
  expect_same_surface(chart, encoded.decoded, encoded.source_vertex);
  expect_sources(chart, encoded);

  const DecodedChart decoded = decode(encoded, range);
  EXPECT_EQ(decoded.chart, encoded.decoded);
  EXPECT_EQ(decoded.coding, encoded.coding);
  EXPECT_EQ(decoded.cost, encoded.cost);
  const ChartCost& cost = encoded.cost;
  EXPECT_EQ(cost.header + cost.connectivity + cost.geometry, 8 * 256 * encoded.blob.size());

  const EncodedChart again = encode(encoded.decoded, range, profile);
  EXPECT_EQ(again.blob, encoded.blob);
  EXPECT_EQ(again.decoded, encoded.decoded);
}

void expect_round_trip(const Chart& chart, const LatticeBox& range) {
  for (const Profile profile : kProfiles) expect_round_trip(chart, range, profile);
}

TEST(ChartCodec, ManifoldChartsComeBackAndReencodeToTheSameBytes) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    SCOPED_TRACE(name);
    expect_round_trip(chart, testing::box_of(chart));
  }
}

TEST(ChartCodec, BrokenChartsComeBackToo) {
  for (const auto& [name, chart] : testing::broken_charts()) {
    SCOPED_TRACE(name);
    expect_round_trip(chart, testing::box_of(chart));
    for (const Profile profile : kProfiles) EXPECT_EQ(encode(chart, profile).coding, ChartCoding::raw);
  }
}

TEST(ChartCodec, TriangleSoupsComeBack) {
  for (std::uint32_t seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE(seed);
    const Chart soup = testing::triangle_soup(seed);
    expect_round_trip(soup, testing::box_of(soup));
  }
}

TEST(ChartCodec, LargeManifoldChartsAreCodedByProfile) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    const bool smooth = name.find("anywhere") == std::string::npos;
    if (chart.faces.size() <= 100 || !smooth) continue;
    EXPECT_EQ(encode(chart).coding, ChartCoding::dense) << name;
    EXPECT_EQ(encode(chart, Profile::fast).coding, ChartCoding::fast) << name;
  }
}

TEST(ChartCodec, BytesDoNotDependOnTheNumberingOfVerticesAndFaces) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    const std::set<LatticePoint> places(chart.positions.begin(), chart.positions.end());
    if (places.size() < chart.positions.size()) continue;  // then the numbering does tell vertices apart
    for (const Profile profile : kProfiles)
      EXPECT_EQ(encode(testing::shuffled(chart, 99), profile).blob, encode(chart, profile).blob) << name;
  }
}

TEST(ChartCodec, VerticesOutsideOfTheRangeBringTheirOwnBox) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    SCOPED_TRACE(name);
    const LatticeBox elsewhere{{-3, -3, -3}, {3, 3, 3}};
    expect_round_trip(chart, elsewhere);
    expect_round_trip(chart, LatticeBox{});
    const bool has_inner = chart.positions.size() > chart.border_count();
    EXPECT_EQ(encode(chart, LatticeBox{}).expanded_range, has_inner);
    EXPECT_FALSE(encode(chart).expanded_range);
  }
}

TEST(ChartCodec, ProfilesDifferInOrderOnly) {
  for (const auto& [name, chart] : testing::manifold_charts()) {
    const std::set<LatticePoint> places(chart.positions.begin(), chart.positions.end());
    if (places.size() < chart.positions.size()) continue;
    EXPECT_EQ(testing::normalized(encode(chart, Profile::fast).decoded), testing::normalized(encode(chart).decoded))
        << name;
  }
}

TEST(ChartCodec, AnyTableCodesAnyChart) {
  std::vector<CoderTables> tables(3);
  for (FanWeights& weights : tables[0].fan) weights.fill(kMaxWeight);
  for (PlaneWeights& weights : tables[0].plane) weights.fill(-kMaxWeight);
  for (FanWeights& weights : tables[1].fan) weights.fill(0);
  for (PlaneWeights& weights : tables[1].plane) weights.fill(0);
  for (FanWeights& weights : tables[2].fan) weights = {kMaxWeight, -kMaxWeight, 1, -1, kMaxWeight, kMaxWeight};
  for (const auto& [name, chart] : testing::manifold_charts())
    for (const CoderTables& table : tables) {
      const LatticeBox range = testing::box_of(chart);
      const EncodedChart encoded = encode_chart(chart, Profile::dense, table, range);
      const DecodedChart decoded = decode_chart(encoded.blob, std::span(chart.positions).first(chart.border_count()),
                                                chart.loop_sizes, table, range);
      expect_same_surface(chart, decoded.chart, encoded.source_vertex);
    }
}

TEST(ChartCodec, ChartsOfScansTakeFewBits) {
  const NamedChart scan = [] {
    for (auto& c : testing::manifold_charts())
      if (c.name == "scan") return c;
    return NamedChart{};
  }();
  const EncodedChart encoded = encode(scan.chart);
  const double bits = 8.0 * static_cast<double>(encoded.blob.size()) / static_cast<double>(scan.chart.positions.size());
  EXPECT_LT(bits, 21);
  EXPECT_GT(encoded.cost.geometry, encoded.cost.connectivity);
}

TEST(ChartCodec, RefusesWhatIsNoChart) {
  const Chart good = testing::one_triangle();
  const auto code_of = [](const Chart& chart, const LatticeBox& range = {{0, 0, 0}, {9, 9, 9}}) {
    try {
      (void)encode(chart, range);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::cancelled;  // stands for "took it"
  };
  Chart bad = good;
  bad.faces[0][2] = 3;
  EXPECT_EQ(code_of(bad), Errc::invalid_argument);
  bad = good;
  bad.loop_sizes = {2};
  EXPECT_EQ(code_of(bad), Errc::invalid_argument);
  bad.loop_sizes = {4};
  EXPECT_EQ(code_of(bad), Errc::invalid_argument);
  bad.loop_sizes = {0xffffffffu, 4};
  EXPECT_EQ(code_of(bad), Errc::invalid_argument);
  bad = good;
  bad.positions[1].y = kMaxLatticeCoordinate + 1;
  EXPECT_EQ(code_of(bad), Errc::invalid_argument);
  bad = good;
  bad.positions.resize((1u << 19) + 1);
  EXPECT_EQ(code_of(bad), Errc::limit_exceeded);
  EXPECT_EQ(code_of(good, {{std::numeric_limits<std::int32_t>::min(), 0, 0}, {0, 0, 0}}), Errc::invalid_argument);
  EXPECT_EQ(code_of(good), Errc::cancelled);
  EXPECT_THROW((void)encode(good, static_cast<Profile>(3)), Error);
}

TEST(ChartCodec, AlignedChartsTakeCoordinatesFromTheirNeighbours) {
  constexpr std::uint8_t kAligned = 2;  // of the flags, the third byte
  const auto flags_of = [](const Chart& chart) {
    return encode_chart(chart, Profile::dense, {}, testing::box_of(chart)).blob.at(2);
  };
  const Chart boxes = testing::boxes(60);
  EXPECT_EQ(flags_of(boxes), kAligned);
  EXPECT_EQ(flags_of(testing::cut(testing::terrain(20, 40, 5))), 0);
  const EncodedChart encoded = encode_chart(boxes, Profile::dense, {}, testing::box_of(boxes));
  EXPECT_LT(8 * encoded.blob.size(), 11 * boxes.positions.size()) << "bits per vertex";
  EXPECT_EQ(encode_chart(encoded.decoded, Profile::dense, {}, testing::box_of(boxes)).blob, encoded.blob);
}

TEST(ChartCodec, GoldenBytes) {
  // Bytes of format 1: never to change.
  EXPECT_EQ(testing::hex(encode(testing::one_triangle()).blob), "01020000010338ccd9f73d");
  const Chart tetrahedron_and_point{
      {}, {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {4, 4, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  EXPECT_EQ(testing::hex(encode(tetrahedron_and_point).blob), "010202050403c07977a8ed1defb13debcaf873");
  const Chart soup{{3}, {{0, 0, 0}, {10, 0, 1}, {0, 10, 2}, {3, 3, 3}}, {{0, 1, 2}, {1, 0, 3}, {0, 0, 1}}};
  EXPECT_EQ(testing::hex(encode(soup).blob), "01010001036da48bf2060606000002000204000602");
  EXPECT_EQ(testing::hex(encode(testing::cut(testing::terrain(4, 30, 1))).blob),
            "0102000920051a44b1825ec04eb29afde65b20d373bd6fe879319abbe69c115657");
}

TEST(ChartCodec, GoldenBytesOfTheFastProfile) {
  // Bytes of format 1: never to change.
  EXPECT_EQ(testing::hex(encode(testing::one_triangle(), Profile::fast).blob), "0101000001dcf94a6c000204");
  const Chart tetrahedron_and_point{
      {}, {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {4, 4, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  EXPECT_EQ(testing::hex(encode(tetrahedron_and_point, Profile::fast).blob),
            "0101000504e99ff9fc0000000000120012110809080a0707000204000408000802020602");
  EXPECT_EQ(testing::hex(encode(testing::cut(testing::terrain(4, 30, 1)), Profile::fast).blob),
            "0103000920beba29620000008371010363c19a48c68f0b4efcab0a9c540300d5115810a06c2cf890f38c52f329162a049a50");
}

TEST(ChartCodec, GoldenSizeAndSumOfManyFastCharts) {
  std::uint64_t sum = 0;
  std::size_t bytes = 0;
  const testing::TestMesh land = testing::terrain(20, 40, 5);
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const Chart chart =
        testing::cut(land, testing::random_region(land, 8 * seed, 1 + static_cast<int>(seed % 5), seed));
    const EncodedChart encoded = encode(chart, Profile::fast);
    for (const std::uint8_t b : encoded.blob) sum = sum * 1000003 + b;
    bytes += encoded.blob.size();
  }
  EXPECT_EQ(bytes, 49257u);
  EXPECT_EQ(sum, 7676507294950533421u);
}

TEST(ChartCodec, GoldenSizeAndSumOfManyCharts) {
  std::uint64_t sum = 0;
  std::size_t bytes = 0;
  const testing::TestMesh land = testing::terrain(20, 40, 5);
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const Chart chart =
        testing::cut(land, testing::random_region(land, 8 * seed, 1 + static_cast<int>(seed % 5), seed));
    for (const std::uint8_t b : encode(chart).blob) sum = sum * 1000003 + b;
    bytes += encode(chart).blob.size();
  }
  EXPECT_EQ(bytes, 42465u);
  EXPECT_EQ(sum, 5374541735520113288u);
}

}  // namespace
}  // namespace ramcdb::codec
