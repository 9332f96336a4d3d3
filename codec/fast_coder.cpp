#include "codec/fast_coder.h"

#include <bit>

#include "codec/fast_predictor.h"
#include "codec/fast_steps.h"
#include "codec/fast_walk.h"
#include "codec/varint.h"

namespace ramcdb::codec {

// ---- encoding ----

std::optional<FastStream> encode_fast(const Chart& chart, const FastContext& context) {
  const std::optional<HalfEdges> edges = HalfEdges::of(chart);
  if (!edges) return std::nullopt;
  const FastTables& tables = context.tables->fast;
  const auto border = static_cast<std::uint32_t>(context.border.size());
  FastStepWriter steps(chart, *edges, context.box.lo);
  const auto isolated = static_cast<std::uint32_t>(steps.isolated().size());
  FastStream stream;
  FastPlan plan =
      FastWalk(steps, FastOutline{context.loop_sizes, context.counts, isolated, context.counts.faces}).run();
  stream.source_vertex = steps.source_vertices();
  stream.source_corner = steps.source_faces();

  std::vector<FastPosition> positions;
  for (const std::uint32_t v : stream.source_vertex) {
    stream.coded.positions.push_back(chart.positions[v]);
    positions.push_back(fast_position(chart.positions[v]));
  }
  const bool wide = needs_wide_sums(context.box, context.border);
  const auto residuals = misses(plan, border, positions, tables.weights(), wide);

  const Buffer side = steps.finish_side();
  put_varint(stream.bytes, isolated);
  put_varint(stream.bytes, steps.joins());
  put_varint(stream.bytes, side.size());
  for (const Buffer& part : {side, steps.finish_degrees(tables.step_tables()),
                             encode_residuals(plan, border, residuals, tables.miss_tables())})
    stream.bytes.insert(stream.bytes.end(), part.begin(), part.end());
  stream.coded.faces = std::move(plan.faces);
  return stream;
}

// ---- decoding ----

namespace {

/// A vertex takes more than 1/32 bit (no symbol takes all of its distribution), a face belongs to a vertex or a join.
void check_plausible(const ByteReader& reader, const FastContext& context, std::uint64_t joins) {
  const std::uint64_t most = 256 * (std::uint64_t{reader.rest().size()} + 64);
  const std::uint64_t vertices = context.border.size() + context.counts.inner_vertices;
  if (context.counts.inner_vertices > most || joins > most) reader.fail("declares more than it can hold");
  if (context.counts.faces > 2 * (vertices + joins)) reader.fail("declares more faces than it can have");
}

}  // namespace

FastChart decode_fast(Bytes bytes, const FastContext& context) {
  ByteReader reader(bytes, "chart's stream");
  const FastTables& tables = context.tables->fast;
  const auto border = static_cast<std::uint32_t>(context.border.size());
  const std::uint32_t inner = context.counts.inner_vertices;
  const std::uint32_t isolated = reader.varint_up_to(inner), joins = reader.varint_up_to(kMaxFastJoins);
  check_plausible(reader, context, joins);
  const Bytes side = reader.take(reader.varint_up_to(~std::uint32_t{0}));
  const std::vector<std::uint8_t> symbols =
      take_degrees(reader, border, inner - isolated + joins, tables.step_tables());
  FastStepReader steps(side, symbols, context.box.lo);
  FastPlan plan = FastWalk(steps, FastOutline{context.loop_sizes, context.counts, isolated, joins}).run();
  if (plan.joins != joins) reader.fail("has fewer joins than it declares");
  steps.finish();

  FastChart chart;
  chart.geometry_cost = 2048 * std::uint64_t{reader.rest().size()} + steps.free_cost();
  chart.connectivity_cost = 2048 * std::uint64_t{bytes.size()} - chart.geometry_cost;
  ResidualTokens misses = decode_tokens(reader.rest(), plan, border, tables.miss_tables());
  RawArray<FastPosition> positions(border + plan.places.size());
  for (std::uint32_t v = 0; v < border; ++v) positions[v] = fast_position(context.border[v]);
  place_all(plan, border, misses, steps.free_points(), tables.weights(), needs_wide_sums(context.box, context.border),
            positions);
  finish_raw_bits(misses);
  chart.positions = checked_points(positions, border, context.box);
  chart.faces = std::move(plan.faces);
  return chart;
}

}  // namespace ramcdb::codec
