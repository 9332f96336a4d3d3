#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "codec/chart_codec.h"
#include "codec/exact_codec.h"
#include "codec/layer_codec.h"
#include "codec/page_codec.h"
#include "codec/polygon_codec.h"
#include "codec/range_coder.h"
#include "codec/wire_codec.h"
#include "tests/codec/hostile_bytes.h"

/// The worked examples of codec/FORMAT.md: what they say is what is written and read.
namespace ramcdb::codec {
namespace {

/// Whether the document has a line of just these bytes.
::testing::AssertionResult is_in_the_document(const Buffer& bytes) {
  std::ifstream file(RAMCDB_SOURCE_DIR "/codec/FORMAT.md");
  EXPECT_TRUE(file);
  const std::string wanted = testing::hex(bytes);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("    ")) continue;
    std::erase(line, ' ');
    if (line == wanted) return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "not there:\n" << wanted;
}

TEST(FormatExample, Lattice) {
  const Lattice lattice{{10, 0, -10}, 0.25};
  EXPECT_EQ(lattice.snap({11.2, 0.125, -9.9}), (LatticePoint{5, 1, 0}));
  EXPECT_EQ(lattice.position({5, 1, 0}), (Point{11.25, 0.25, -10}));
}

TEST(FormatExample, RangeCoder) {
  RangeEncoder encoder;
  AdaptiveBit bit;
  for (const bool b : {true, false, true}) encoder.code(bit, b);
  encoder.code_raw(5, 3);
  EXPECT_TRUE(is_in_the_document(encoder.finish()));
}

TEST(FormatExample, Wire) {
  const Wire wire{{{0, 0, 0}, {4, 1, 0}, {10, 0, 0}}};
  const WireOfGroup alone{WireId(1), &wire};
  const Buffer blob = encode_wires(std::span(&alone, 1));
  EXPECT_TRUE(is_in_the_document(blob));
  EXPECT_EQ(WireGroup(blob).wire(WireId(1), {0, 0, 0}, {10, 0, 0}, 1), wire);
}

TEST(FormatExample, LeafPage) {
  LeafPage page;
  PageChart chart{ChartId(1), VersionId(1), TableId(), 4, 1, {{0, 0, 0}, {10, 10, 4}}, {{{WireId(1), false}}},
                  {},         {{0}, 0}};
  page.charts.push_back(chart);
  page.wires.push_back({WireId(1), VersionId(1), WireId(1), CornerId(1), CornerId(1), 3, {ChartId(1)}});
  page.corners.push_back({CornerId(1), {0, 0, 0}});
  EXPECT_TRUE(is_in_the_document(encode_page(page)));
  EXPECT_EQ(decode_page(encode_page(page)), Page(page));
}

TEST(FormatExample, InnerPage) {
  InnerPage page;
  page.pages.push_back({PageId(1), VersionId(2), {{0, 0, 0}, {10, 10, 4}}, 4, {{ChartId(1), 1}}});
  EXPECT_TRUE(is_in_the_document(encode_page(page)));
  EXPECT_EQ(decode_page(encode_page(page)), Page(page));
}

void expect_example(const Chart& chart, const LatticeBox& range, ChartCoding coding, const std::vector<Triangle>& faces,
                    Profile profile = Profile::dense) {
  const EncodedChart encoded = encode_chart(chart, profile, {}, range);
  EXPECT_EQ(encoded.coding, coding);
  EXPECT_TRUE(is_in_the_document(encoded.blob));
  const auto decoded =
      decode_chart(encoded.blob, std::span(chart.positions).first(chart.border_count()), chart.loop_sizes, {}, range);
  EXPECT_EQ(decoded.chart.positions, chart.positions);
  EXPECT_EQ(decoded.chart.faces, faces);
}

TEST(FormatExample, RawChart) {
  const Chart chart{{3}, {{0, 0, 0}, {10, 0, 1}, {0, 10, 2}, {3, 3, 3}}, {{0, 1, 2}, {0, 3, 1}, {0, 0, 1}}};
  expect_example(chart, {{0, 0, 0}, {10, 10, 3}}, ChartCoding::raw, {{0, 0, 1}, {0, 1, 2}, {0, 3, 1}});
}

Chart tent() {
  return {
      {4}, {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, 4}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

TEST(FormatExample, DenseChart) {
  expect_example(tent(), {{0, 0, 0}, {10, 10, 4}}, ChartCoding::dense, {{3, 0, 4}, {4, 0, 1}, {4, 1, 2}, {4, 2, 3}});
}

TEST(FormatExample, FastChart) {
  Chart chart{{12}, {}, {}};
  for (std::int32_t i = 0; i < 12; ++i) chart.positions.push_back({10 * i, i * i, 0});
  chart.positions.push_back({50, 40, 4});
  for (std::uint32_t i = 0; i < 12; ++i) chart.faces.push_back({i, (i + 1) % 12, 12});
  std::vector<Triangle> faces{{11, 0, 12}};
  for (std::uint32_t i = 0; i < 11; ++i) faces.push_back({12, i, i + 1});
  expect_example(chart, {{0, 0, 0}, {110, 121, 4}}, ChartCoding::fast, faces, Profile::fast);
}

TEST(FormatExample, Layer) {
  const LayerShape shape{AttributeOf::vertex, 1, 8};
  const LayerValues values{{10, 20, 30, 40, 25}, {}};
  const LayerOrder order(tent());
  const Buffer blob = encode_layer(values, shape, tent(), order);
  EXPECT_TRUE(is_in_the_document(blob));
  EXPECT_EQ(decode_layer(blob, shape, tent(), order), values);
}

TEST(FormatExample, Exact) {
  const Lattice lattice{{-4, 0, 512.125}, 0.001, 1000};
  const std::vector<Point> positions{{0.5, -0.25, 512}, {1.0 / 3, 0.1, 600}, {-0.0, 2, 513.25}};
  const std::vector<LatticePoint> points{{4500, -250, -125}, {4333, 100, 87875}, {4000, 2000, 1125}};
  const Buffer blob = encode_exact(positions, points, lattice, NumberType::float64);
  EXPECT_TRUE(is_in_the_document(blob));
  EXPECT_EQ(decode_exact(blob, points, lattice, NumberType::float64), positions);
}

TEST(FormatExample, Polygons) {
  const Polygons polygons{{0, 0, 1, 1}, {4, 4}, {0, 3, 4, 2, 6, 9, 10, 8}};
  const LayerOrder order(tent());
  const Buffer blob = encode_polygons(polygons, tent(), order);
  EXPECT_TRUE(is_in_the_document(blob));
  EXPECT_EQ(decode_polygons(blob, tent(), order).of_face, polygons.of_face);
}

TEST(FormatExample, Tables) {
  CoderTables tables;
  tables.fan[9] = {1, -2, 300, -16384, 16384, 0};
  tables.plane[15] = {64, 64, 0};
  EXPECT_TRUE(is_in_the_document(encode_tables(tables)));
  EXPECT_EQ(decode_tables(encode_tables(tables)), tables);
}

}  // namespace
}  // namespace ramcdb::codec
