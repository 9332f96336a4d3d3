#include "codec/chart_header.h"

#include <xxhash.h>

#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <new>

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

/// The header as far as the check.
void put_fields(Buffer& out, const ChartHeader& header) {
  out.push_back(kChartFormat);
  out.push_back(static_cast<std::uint8_t>(header.coding));
  out.push_back(header.own_box ? kOwnBox : 0);
  put_varint(out, header.counts.inner_vertices);
  put_varint(out, header.counts.faces);
  if (header.own_box) put_box(out, header.box);
  if (header.coding == ChartCoding::dense) out.push_back(static_cast<std::uint8_t>(header.edge_exponent));
}

/// XXH3-64 of whole numbers, each as four bytes, lowest first.
class WordHash {
 public:
  WordHash() : state_(XXH3_createState(), XXH3_freeState) {
    if (!state_ || XXH3_64bits_reset(state_.get()) != XXH_OK) throw std::bad_alloc();
  }

  void add(std::uint32_t word) {
    if constexpr (std::endian::native != std::endian::little) word = swapped(word);
    std::memcpy(bytes_.data() + filled_, &word, 4);
    filled_ += 4;
    if (filled_ == bytes_.size()) pass_on();
  }
  /// Arrays of 32-bit numbers, however they are grouped: all at once where memory holds them as they are hashed.
  template <class T>
  void add_all(std::span<const T> items) {
    static_assert(sizeof(T) % 4 == 0 && std::is_trivially_copyable_v<T>);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(items.data());
    if constexpr (std::endian::native == std::endian::little) {
      pass_on();
      (void)XXH3_64bits_update(state_.get(), bytes, items.size_bytes());
    } else {
      for (std::size_t i = 0; i < items.size_bytes(); i += 4) {
        std::uint32_t word;
        std::memcpy(&word, bytes + i, 4);
        add(word);
      }
    }
  }
  [[nodiscard]] std::uint64_t digest() {
    pass_on();
    return XXH3_64bits_digest(state_.get());
  }

 private:
  static std::uint32_t swapped(std::uint32_t x) { return x << 24 | (x << 8 & 0xff0000) | (x >> 8 & 0xff00) | x >> 24; }
  void pass_on() {
    (void)XXH3_64bits_update(state_.get(), bytes_.data(), filled_);
    filled_ = 0;
  }

  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
  std::array<std::uint8_t, 4096> bytes_;
  std::size_t filled_ = 0;
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

std::uint32_t chart_check(const ChartHeader& header, const Chart& chart, const LatticeBox& range,
                          const CoderTables& tables) {
  Buffer fields;
  put_fields(fields, header);
  WordHash hash;
  for (const std::uint8_t field : fields) hash.add(field);
  hash.add(static_cast<std::uint32_t>(chart.loop_sizes.size()));
  hash.add_all(std::span(chart.loop_sizes));
  hash.add_all(std::span(chart.positions));
  hash.add_all(std::span(chart.faces));
  hash.add_all(std::span(&range.lo, 1));
  hash.add_all(std::span(&range.hi, 1));
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
