#include "codec/chart_header.h"

#include <xxhash.h>

#include <array>
#include <bit>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace ramcdb::codec {

namespace {

constexpr std::uint8_t kOwnBox = 1, kAligned = 2;

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

/// The header as far as the check.
void put_fields(Buffer& out, const ChartHeader& header) {
  out.push_back(kChartFormat);
  out.push_back(static_cast<std::uint8_t>(header.coding));
  out.push_back(static_cast<std::uint8_t>((header.own_box ? kOwnBox : 0) | (header.aligned ? kAligned : 0)));
  put_varint(out, header.counts.inner_vertices);
  put_varint(out, header.counts.faces);
  if (header.own_box) put_box(out, header.box);
  if (header.coding == ChartCoding::dense) out.push_back(static_cast<std::uint8_t>(header.edge_exponent));
}

/// XXH3-64 of bytes and whole numbers, each of these as four bytes, lowest first.
class WordHash {
 public:
  WordHash() : state_(XXH3_createState(), XXH3_freeState) {
    if (!state_ || XXH3_64bits_reset(state_.get()) != XXH_OK) throw std::bad_alloc();
  }

  void add(Bytes bytes) { (void)XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }
  void add(std::uint32_t word) {
    const std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                                            static_cast<std::uint8_t>(word >> 16),
                                            static_cast<std::uint8_t>(word >> 24)};
    add(Bytes(bytes));
  }
  void add(LatticePoint p) {
    for (int a = 0; a < 3; ++a) add(static_cast<std::uint32_t>(p[a]));
  }
  /// Things that are nothing but such numbers, in one go where memory has them in that order.
  template <class T>
  void add_all(const std::vector<T>& things) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
    if constexpr (std::endian::native == std::endian::little) {
      (void)XXH3_64bits_update(state_.get(), things.data(), things.size() * sizeof(T));
    } else {
      for (const T& thing : things)
        for (const std::uint32_t word : std::bit_cast<std::array<std::uint32_t, sizeof(T) / 4>>(thing)) add(word);
    }
  }
  [[nodiscard]] std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace

void put_chart_header(Buffer& out, const ChartHeader& header) {
  put_fields(out, header);
  put_fixed32(out, header.check);
}

ChartHeader take_chart_header(ByteReader& reader, const LatticeBox& range) {
  if (const std::uint8_t format = reader.byte(); format != kChartFormat) {
    if (format > kChartFormat) throw Error(Errc::unsupported_version, "a chart blob of a newer format");
    reader.fail("is of no known format");
  }
  ChartHeader header;
  const std::uint8_t coding = reader.byte();
  if (coding < static_cast<std::uint8_t>(ChartCoding::raw) || coding > static_cast<std::uint8_t>(ChartCoding::fast))
    reader.fail("is coded in no known way");
  header.coding = static_cast<ChartCoding>(coding);
  const std::uint8_t flags = reader.byte();
  header.own_box = flags & kOwnBox;
  header.aligned = flags & kAligned;
  if (flags > (kOwnBox | kAligned) || (header.aligned && header.coding != ChartCoding::dense))
    reader.fail("has unknown flags");
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

std::uint32_t chart_check(const ChartHeader& header, Bytes payload, const Chart& chart, const LatticeBox& range,
                          const CoderTables& tables) {
  Buffer fields;
  put_fields(fields, header);
  WordHash hash;
  hash.add(Bytes(fields));
  hash.add(payload);
  hash.add(static_cast<std::uint32_t>(chart.loop_sizes.size()));
  hash.add_all(chart.loop_sizes);
  hash.add_all(chart.positions);
  hash.add_all(chart.faces);
  hash.add(range.lo);
  hash.add(range.hi);
  if (header.coding == ChartCoding::fast) {
    for (int shift = 0; shift < 64; shift += 32) hash.add(static_cast<std::uint32_t>(tables.fast.digest() >> shift));
  } else {
    for (const FanWeights& weights : tables.fan)
      for (const std::int16_t w : weights) hash.add(static_cast<std::uint32_t>(w));
    for (const PlaneWeights& weights : tables.plane)
      for (const std::int16_t w : weights) hash.add(static_cast<std::uint32_t>(w));
  }
  return static_cast<std::uint32_t>(hash.digest());
}

}  // namespace ramcdb::codec
