#include "codec/chart_codec.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "codec/chart_header.h"
#include "codec/dense_coder.h"
#include "codec/fast_coder.h"
#include "codec/raw_chart.h"

namespace ramcdb::codec {

namespace {

constexpr std::string_view kBlob = "chart blob";

// ---- what both directions check and compute ----

/// The number of border vertices, when loops are loops and there are that many.
std::uint32_t checked_border(std::span<const std::uint32_t> loop_sizes, std::size_t vertices, Errc blame) {
  std::uint64_t border = 0;
  for (const std::uint32_t size : loop_sizes) {
    if (size < 3) throw Error(blame, "a border loop of a chart has less than three vertices");
    border += size;
  }
  if (border > vertices || border > kMaxChartVertices)
    throw Error(blame, "the border loops of a chart have more vertices than the chart");
  return static_cast<std::uint32_t>(border);
}

/// That a lattice point may be one at all keeps all differences within int32.
bool on_lattice(LatticePoint p) {
  for (int a = 0; a < 3; ++a)
    if (p[a] < -kMaxLatticeCoordinate || p[a] > kMaxLatticeCoordinate) return false;
  return true;
}

void require_range(const LatticeBox& range, Errc blame) {
  if (!on_lattice(range.lo) || !on_lattice(range.hi))
    throw Error(blame, "the range of a chart lies beyond any lattice");
}

/// Costs that add up to the blob: the header takes what the stream's models do not account for, that is the bytes
/// before the stream and the last few bits of it.
ChartCost blob_cost(std::size_t blob_size, std::uint64_t connectivity, std::uint64_t geometry) {
  const std::uint64_t total = 8 * 256 * std::uint64_t{blob_size};
  ChartCost cost;
  cost.connectivity = std::min(connectivity, total);
  cost.geometry = std::min(geometry, total - cost.connectivity);
  cost.header = total - cost.connectivity - cost.geometry;
  return cost;
}

/// All that follows the header of a raw chart, shared out by bytes.
ChartCost raw_cost(std::size_t blob_size, std::size_t payload, const std::vector<LatticePoint>& positions,
                   std::size_t border, LatticePoint box_low) {
  Buffer bytes;
  LatticePoint before = box_low;
  for (std::size_t v = border; v < positions.size(); ++v) {
    for (int a = 0; a < 3; ++a) put_signed_varint(bytes, std::int64_t{positions[v][a]} - before[a]);
    before = positions[v];
  }
  return blob_cost(blob_size, 2048 * std::uint64_t{payload - bytes.size()}, 2048 * std::uint64_t{bytes.size()});
}

DenseContext dense_context(std::span<const LatticePoint> border, std::span<const std::uint32_t> loop_sizes,
                           const ChartHeader& header, const CoderTables& tables) {
  DenseContext context;
  context.border = border;
  context.loop_sizes = loop_sizes;
  context.counts = context.expected = header.counts;
  context.edge_exponent = header.edge_exponent;
  context.aligned = header.aligned;
  context.box = header.box;
  context.tables = &tables;
  return context;
}

FastContext fast_context(std::span<const LatticePoint> border, std::span<const std::uint32_t> loop_sizes,
                         const ChartHeader& header, const CoderTables& tables) {
  return {border, loop_sizes, header.counts, header.box, &tables};
}

// ---- encoding ----

void require_chart(const Chart& chart) {
  checked_border(chart.loop_sizes, chart.positions.size(), Errc::invalid_argument);
  if (chart.positions.size() > kMaxChartVertices || chart.faces.size() > kMaxChartFaces)
    throw Error(Errc::limit_exceeded, "a chart has too many vertices or faces", {}, "use smaller charts");
  for (const LatticePoint p : chart.positions)
    if (!on_lattice(p)) throw Error(Errc::invalid_argument, "a vertex of a chart lies beyond any lattice");
  for (const Triangle& face : chart.faces)
    for (const std::uint32_t v : face)
      if (v >= chart.positions.size())
        throw Error(Errc::invalid_argument, "a face of a chart names a vertex that the chart does not have");
}

ChartHeader header_of(const Chart& chart, std::uint32_t border, const LatticeBox& range) {
  ChartHeader header;
  header.counts.inner_vertices = static_cast<std::uint32_t>(chart.positions.size()) - border;
  header.counts.faces = static_cast<std::uint32_t>(chart.faces.size());
  LatticeBox own;
  for (std::size_t v = border; v < chart.positions.size(); ++v) {
    own.add(chart.positions[v]);
    header.own_box |= !range.contains(chart.positions[v]);
  }
  header.box = header.own_box ? own : range;
  return header;
}

/// Puts the pieces of a coded chart together; `payload` is what the coder wrote.
EncodedChart assemble(ChartHeader header, Chart decoded, const Buffer& payload, const CoderTables& tables,
                      const LatticeBox& range) {
  header.check = chart_check(header, payload, decoded, range, tables);
  EncodedChart encoded;
  put_chart_header(encoded.blob, header);
  encoded.blob.insert(encoded.blob.end(), payload.begin(), payload.end());
  encoded.coding = header.coding;
  encoded.expanded_range = header.own_box;
  encoded.decoded = std::move(decoded);
  return encoded;
}

bool decodes_to_itself(EncodedChart& encoded, std::uint32_t border, const CoderTables& tables,
                       const LatticeBox& range) {
  try {
    const Chart& chart = encoded.decoded;
    const DecodedChart decoded =
        decode_chart(encoded.blob, std::span(chart.positions).first(border), chart.loop_sizes, tables, range);
    encoded.cost = decoded.cost;
    return decoded.chart == chart;
  } catch (const Error&) {
    return false;
  }
}

/// What a coder wrote, as a blob that was decoded again. Nothing when that failed, or when there is no stream.
template <class Stream>
std::optional<EncodedChart> verified(const Chart& chart, const ChartHeader& header, std::optional<Stream> stream,
                                     const CoderTables& tables, const LatticeBox& range) {
  if (!stream) return std::nullopt;
  Chart decoded{chart.loop_sizes, std::move(stream->coded.positions), std::move(stream->coded.faces)};
  EncodedChart encoded = assemble(header, std::move(decoded), stream->bytes, tables, range);
  encoded.source_vertex = std::move(stream->source_vertex);
  encoded.source_corner = std::move(stream->source_corner);
  if (!decodes_to_itself(encoded, chart.border_count(), tables, range)) return std::nullopt;
  return encoded;
}

/// Whether coding coordinates by those of neighbours may pay, which costs encoding twice to see: most that missed
/// were there, or these took many bits. On scans a fifth of all coordinates is there, too, by chance: not worth it.
bool looks_aligned(const DenseMisses& misses, ChartCounts counts) {
  return 2 * misses.aligned > misses.all || 2 * misses.aligned_bits > 3 * std::uint64_t{counts.inner_vertices};
}

std::optional<EncodedChart> encode_densely(const Chart& chart, ChartHeader header, const CoderTables& tables,
                                           const LatticeBox& range) {
  header.coding = ChartCoding::dense;
  header.edge_exponent = mean_edge_exponent(chart);
  const auto border = std::span(chart.positions).first(chart.border_count());
  const auto coded = [&] { return encode_dense(chart, dense_context(border, chart.loop_sizes, header, tables)); };
  std::optional<DenseStream> stream = coded();
  if (stream && looks_aligned(stream->misses, header.counts)) {
    header.aligned = true;
    std::optional<DenseStream> aligned = coded();
    header.aligned = aligned && aligned->bytes.size() < stream->bytes.size();
    if (header.aligned) stream = std::move(aligned);
  }
  return verified(chart, header, std::move(stream), tables, range);
}

std::optional<EncodedChart> encode_quickly(const Chart& chart, ChartHeader header, const CoderTables& tables,
                                           const LatticeBox& range) {
  header.coding = ChartCoding::fast;
  const auto border = std::span(chart.positions).first(chart.border_count());
  return verified(chart, header, encode_fast(chart, fast_context(border, chart.loop_sizes, header, tables)), tables,
                  range);
}

EncodedChart encode_rawly(const Chart& chart, ChartHeader header, const CoderTables& tables, const LatticeBox& range) {
  header.coding = ChartCoding::raw;
  RawChart raw = encode_raw(chart, header.box.lo);
  Chart decoded{chart.loop_sizes, std::move(raw.positions), std::move(raw.faces)};
  EncodedChart encoded = assemble(header, std::move(decoded), raw.bytes, tables, range);
  encoded.source_vertex = std::move(raw.source_vertex);
  encoded.source_corner = std::move(raw.source_corner);
  if (!decodes_to_itself(encoded, chart.border_count(), tables, range))
    throw Error(Errc::invalid_argument, "a chart cannot be coded", {}, "report this: it is a bug");
  return encoded;
}

}  // namespace

EncodedChart encode_chart(const Chart& chart, Profile profile, const CoderTables& tables, const LatticeBox& range) {
  if (profile != Profile::dense && profile != Profile::fast)
    throw Error(Errc::invalid_argument, "an unknown chart coding profile");
  require_chart(chart);
  require_range(range, Errc::invalid_argument);
  const ChartHeader header = header_of(chart, chart.border_count(), range);
  std::optional<EncodedChart> coded = profile == Profile::dense ? encode_densely(chart, header, tables, range)
                                                                : encode_quickly(chart, header, tables, range);
  // Raw coding takes a byte per number at least; mostly that settles it.
  const std::size_t least_raw = 3 * (std::size_t{header.counts.inner_vertices} + header.counts.faces);
  if (coded && coded->blob.size() <= least_raw) return *std::move(coded);
  EncodedChart raw = encode_rawly(chart, header, tables, range);
  return coded && coded->blob.size() <= raw.blob.size() ? *std::move(coded) : std::move(raw);
}

// ---- decoding ----

namespace {

/// A modelled bit takes 1/1000 bit at least, a face or vertex one modelled bit: so many can a stream hold.
void check_plausible(const ByteReader& reader, const ChartHeader& header) {
  const std::uint64_t most = 8192 * (std::uint64_t{reader.rest().size()} + 8);
  if (header.counts.faces > most || header.counts.inner_vertices > most) reader.fail("declares more than it can hold");
}

/// Memory for what a stream of such a length usually holds; more comes with growth, when it is really there.
ChartCounts usual_counts(const ByteReader& reader, ChartCounts declared) {
  const auto usual = static_cast<std::uint32_t>(std::min<std::size_t>(16 * reader.rest().size(), kMaxChartFaces));
  return {std::min(declared.inner_vertices, usual), std::min(declared.faces, usual)};
}

}  // namespace

DecodedChart decode_chart(Bytes blob, std::span<const LatticePoint> border, std::span<const std::uint32_t> loop_sizes,
                          const CoderTables& tables, const LatticeBox& range) {
  if (checked_border(loop_sizes, border.size(), Errc::corrupt) != border.size() ||
      !std::all_of(border.begin(), border.end(), on_lattice))
    throw Error(Errc::corrupt, "the border of a chart does not fit its loops");
  require_range(range, Errc::corrupt);
  ByteReader reader(blob, kBlob);
  const ChartHeader header = take_chart_header(reader, range);
  if (border.size() + header.counts.inner_vertices > kMaxChartVertices) reader.fail("declares too many vertices");

  const Bytes payload = reader.rest();
  DecodedChart decoded;
  decoded.coding = header.coding;
  decoded.chart.loop_sizes.assign(loop_sizes.begin(), loop_sizes.end());
  if (header.coding == ChartCoding::dense) {
    check_plausible(reader, header);
    DenseContext context = dense_context(border, loop_sizes, header, tables);
    context.expected = usual_counts(reader, header.counts);
    DenseChart dense = decode_dense(reader.rest(), context);
    decoded.chart.positions = std::move(dense.positions);
    decoded.chart.faces = std::move(dense.faces);
    decoded.cost = blob_cost(blob.size(), dense.connectivity_cost, dense.geometry_cost);
  } else if (header.coding == ChartCoding::fast) {
    FastChart fast = decode_fast(reader.rest(), fast_context(border, loop_sizes, header, tables));
    decoded.chart.positions = std::move(fast.positions);
    decoded.chart.faces = std::move(fast.faces);
    decoded.cost = blob_cost(blob.size(), fast.connectivity_cost, fast.geometry_cost);
  } else {
    RawContent raw = decode_raw(reader, border, header.counts, header.box);
    decoded.cost = raw_cost(blob.size(), payload.size(), raw.positions, border.size(), header.box.lo);
    decoded.chart.positions = std::move(raw.positions);
    decoded.chart.faces = std::move(raw.faces);
  }
  if (chart_check(header, payload, decoded.chart, range, tables) != header.check)
    reader.fail("is damaged, or was not coded with this border, table and range");
  return decoded;
}

}  // namespace ramcdb::codec
