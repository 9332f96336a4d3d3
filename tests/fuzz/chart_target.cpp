#include <algorithm>

#include "codec/chart_codec.h"
#include "codec/chart_header.h"
#include "codec/dense_coder.h"
#include "codec/fast_coder.h"
#include "codec/raw_chart.h"
#include "tests/codec/chart_cutter.h"
#include "tests/fuzz/coder_input.h"

/// A chart that is decoded is one, and comes back from its own blob. The check in a blob's header finds nearly all
/// damage in the end, so that streams of each coder are tried without it, too.
namespace ramcdb::fuzz {
namespace {

using codec::ChartCounts;

enum class Way : std::uint8_t { blob, dense, raw, fast };
constexpr int kWays = 4;
/// More than any of the charts has, and little enough to try many a second.
constexpr std::uint32_t kMostInner = 300, kMostFaces = 600;

const codec::CoderTables& tables() {
  static const codec::CoderTables built_in;
  return built_in;
}

/// The box of the chart's vertices; of a chart without any, one point.
LatticeBox range_of(const Chart& chart) {
  const LatticeBox box = codec::testing::box_of(chart);
  return box.empty() ? LatticeBox{{0, 0, 0}, {0, 0, 0}} : box;
}

std::span<const LatticePoint> border_of(const Chart& chart) {
  return std::span(chart.positions).first(chart.border_count());
}

codec::DenseContext context_of(const Chart& chart, ChartCounts counts, int edge_exponent) {
  codec::DenseContext context;
  context.border = border_of(chart);
  context.loop_sizes = chart.loop_sizes;
  context.counts = context.expected = counts;
  context.edge_exponent = edge_exponent;
  context.box = range_of(chart);
  context.tables = &tables();
  return context;
}

codec::FastContext fast_context_of(const Chart& chart, ChartCounts counts) {
  return {border_of(chart), chart.loop_sizes, counts, range_of(chart), &tables()};
}

ChartCounts counts_of(const Chart& chart) {
  return {static_cast<std::uint32_t>(chart.positions.size()) - chart.border_count(),
          static_cast<std::uint32_t>(chart.faces.size())};
}

Chart decode(Way way, CoderInput& input, const Chart& known) {
  if (way == Way::blob)
    return codec::decode_chart(input.blob(), border_of(known), known.loop_sizes, tables(), range_of(known)).chart;
  const ChartCounts counts{input.word() % kMostInner, input.word() % kMostFaces};
  Chart chart{known.loop_sizes, {}, {}};
  if (way == Way::dense) {
    const int exponent = input.byte() % 32;
    auto dense = codec::decode_dense(input.blob(), context_of(known, counts, exponent));
    chart.positions = std::move(dense.positions);
    chart.faces = std::move(dense.faces);
  } else if (way == Way::fast) {
    auto fast = codec::decode_fast(input.blob(), fast_context_of(known, counts));
    chart.positions = std::move(fast.positions);
    chart.faces = std::move(fast.faces);
  } else {
    codec::ByteReader reader(input.blob(), "raw chart");
    auto raw = codec::decode_raw(reader, border_of(known), counts, range_of(known));
    chart.positions = std::move(raw.positions);
    chart.faces = std::move(raw.faces);
  }
  require(chart.faces.size() == counts.faces, "another number of faces");
  require(chart.positions.size() == known.border_count() + counts.inner_vertices, "another number of vertices");
  return chart;
}

void check(const Chart& chart, const Chart& known) {
  require_valid(chart.positions, chart.faces);
  const auto border = border_of(known);
  require(chart.loop_sizes == known.loop_sizes && std::equal(border.begin(), border.end(), chart.positions.begin()),
          "another border");
  for (const codec::Profile profile : {codec::Profile::dense, codec::Profile::fast}) {
    const auto encoded = codec::encode_chart(chart, profile, tables(), range_of(known));
    const auto again = codec::decode_chart(encoded.blob, border, chart.loop_sizes, tables(), range_of(known));
    require(again.chart == encoded.decoded, "another chart comes back");
    require(codec::encode_chart(again.chart, profile, tables(), range_of(known)).blob == encoded.blob,
            "the same chart gives other bytes");
  }
}

CoderSeed seed_of(std::size_t number, Way way) {
  CoderSeed seed;
  seed.byte(number).byte(static_cast<std::size_t>(way));
  return seed;
}

}  // namespace

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (std::size_t number = 0; number < charts().size(); ++number) {
    const Chart& chart = charts()[number];
    const std::string name = "chart-" + std::to_string(number);
    all.push_back(seed_of(number, Way::blob)
                      .named(name, codec::encode_chart(chart, codec::Profile::dense, tables(), range_of(chart)).blob));
    const ChartCounts counts = counts_of(chart);
    const int exponent = codec::mean_edge_exponent(chart);
    if (const auto dense = codec::encode_dense(chart, context_of(chart, counts, exponent)))
      all.push_back(seed_of(number, Way::dense)
                        .word(counts.inner_vertices)
                        .word(counts.faces)
                        .byte(static_cast<std::size_t>(exponent))
                        .named(name + "-dense", dense->bytes));
    if (const auto fast = codec::encode_fast(chart, fast_context_of(chart, counts)))
      all.push_back(
          seed_of(number, Way::fast).word(counts.inner_vertices).word(counts.faces).named(name + "-fast", fast->bytes));
    all.push_back(seed_of(number, Way::raw)
                      .word(counts.inner_vertices)
                      .word(counts.faces)
                      .named(name + "-raw", codec::encode_raw(chart, range_of(chart).lo).bytes));
  }
  return all;
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  fuzz::CoderInput input(data, size);
  const Chart& known = fuzz::chart_of(input.byte());
  const auto way = static_cast<fuzz::Way>(input.byte() % fuzz::kWays);
  Chart chart;
  if (!fuzz::refuses([&] { chart = fuzz::decode(way, input, known); })) fuzz::check(chart, known);
  return 0;
}
