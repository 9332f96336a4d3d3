#include "codec/chart_header.h"

#include <xxhash.h>

namespace ramcdb::codec {

namespace {

constexpr std::uint8_t kOwnBox = 1;

void put_box(Buffer& out, const LatticeBox& box) {
  for (int a = 0; a < 3; ++a) {
    put_signed_varint(out, box.lo[a]);
    put_varint(out, static_cast<std::uint64_t>(std::int64_t{box.hi[a]} - box.lo[a]));
  }
}

LatticeBox take_box(ByteReader& reader) {
  LatticeBox box;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t low = reader.signed_varint();
    const std::uint64_t width = reader.varint();
    if (low < -kMaxLatticeCoordinate || low > kMaxLatticeCoordinate ||
        width > static_cast<std::uint64_t>(kMaxLatticeCoordinate - low))
      reader.fail("has a box beyond any lattice");
    box.lo[a] = static_cast<std::int32_t>(low);
    box.hi[a] = static_cast<std::int32_t>(low + static_cast<std::int64_t>(width));
  }
  return box;
}

void put_point(Buffer& out, LatticePoint p) {
  for (int a = 0; a < 3; ++a) put_fixed32(out, static_cast<std::uint32_t>(p[a]));
}

}  // namespace

void put_chart_header(Buffer& out, const ChartHeader& header) {
  out.push_back(kChartFormat);
  out.push_back(static_cast<std::uint8_t>(header.coding));
  out.push_back(header.own_box ? kOwnBox : 0);
  put_varint(out, header.counts.inner_vertices);
  put_varint(out, header.counts.faces);
  if (header.own_box) put_box(out, header.box);
  if (header.coding == ChartCoding::dense) out.push_back(static_cast<std::uint8_t>(header.edge_exponent));
  put_fixed32(out, header.check);
}

ChartHeader take_chart_header(ByteReader& reader, const LatticeBox& range) {
  if (const std::uint8_t format = reader.byte(); format != kChartFormat) {
    if (format > kChartFormat) throw Error(Errc::unsupported_version, "a chart blob of a newer format");
    reader.fail("is of no known format");
  }
  ChartHeader header;
  const std::uint8_t coding = reader.byte();
  if (coding != static_cast<std::uint8_t>(ChartCoding::raw) && coding != static_cast<std::uint8_t>(ChartCoding::dense))
    reader.fail("is coded in no known way");
  header.coding = static_cast<ChartCoding>(coding);
  const std::uint8_t flags = reader.byte();
  if (flags > kOwnBox) reader.fail("has unknown flags");
  header.own_box = flags == kOwnBox;
  header.counts.inner_vertices = reader.varint_up_to(kMaxChartVertices);
  header.counts.faces = reader.varint_up_to(kMaxChartFaces);
  header.box = header.own_box ? take_box(reader) : range;
  if (header.coding == ChartCoding::dense) {
    header.edge_exponent = reader.byte();
    if (header.edge_exponent > 31) reader.fail("has edges longer than any lattice");
  }
  header.check = reader.fixed32();
  return header;
}

std::uint32_t chart_check(const Chart& chart, const LatticeBox& range, const CoderTables& tables) {
  Buffer all;
  all.reserve(4 * (chart.loop_sizes.size() + 3 * (chart.positions.size() + chart.faces.size())) + 4096);
  put_fixed32(all, static_cast<std::uint32_t>(chart.loop_sizes.size()));
  put_fixed32(all, static_cast<std::uint32_t>(chart.positions.size()));
  for (const std::uint32_t size : chart.loop_sizes) put_fixed32(all, size);
  for (const LatticePoint p : chart.positions) put_point(all, p);
  for (const Triangle& face : chart.faces)
    for (const std::uint32_t v : face) put_fixed32(all, v);
  put_point(all, range.lo);
  put_point(all, range.hi);
  for (const FanWeights& weights : tables.fan)
    for (const std::int16_t w : weights) put_fixed32(all, static_cast<std::uint32_t>(w));
  for (const PlaneWeights& weights : tables.plane)
    for (const std::int16_t w : weights) put_fixed32(all, static_cast<std::uint32_t>(w));
  return static_cast<std::uint32_t>(XXH3_64bits(all.data(), all.size()));
}

}  // namespace ramcdb::codec
