#include "api/mesh_record.h"

#include <bit>
#include <cmath>
#include <string>

#include "codec/varint.h"
#include "ramcdb/error.h"

/// Mesh record blob; numbers are varints (codec/varint.h) unless a type says otherwise:
///
///   record  = format:1 flags:1 written_as profile [exact] step:f64 [steps_per_unit:f64] origin [range] ids counters
///   flags   = 1 exact is there, 2 steps_per_unit is there, 4 range is there, 8 the origin is three f32, else three f64
///   range   = 3 x (low: signed, high - low)
///   ids, counters: in the order of visit_ids() and visit_counters()
///
/// f32, f64: IEEE 754, lowest byte first. NumberType and Profile by their numbers.
namespace ramcdb::detail {
namespace {

using codec::ByteReader;

constexpr std::uint8_t kRecordFormat = 1;
constexpr std::uint8_t kExact = 1, kStepsPerUnit = 2, kRange = 4, kShortOrigin = 8;

void put_double(Buffer& out, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  codec::put_fixed32(out, static_cast<std::uint32_t>(bits));
  codec::put_fixed32(out, static_cast<std::uint32_t>(bits >> 32));
}
double take_double(ByteReader& reader) {
  const std::uint64_t low = reader.fixed32();
  return std::bit_cast<double>(low | std::uint64_t{reader.fixed32()} << 32);
}

bool is_float(const Point& p) {
  for (int a = 0; a < 3; ++a)
    if (static_cast<double>(static_cast<float>(p[a])) != p[a]) return false;
  return true;
}

void put_origin(Buffer& out, const Point& origin) {
  for (int a = 0; a < 3; ++a) {
    if (is_float(origin))
      codec::put_fixed32(out, std::bit_cast<std::uint32_t>(static_cast<float>(origin[a])));
    else
      put_double(out, origin[a]);
  }
}
Point take_origin(ByteReader& reader, bool is_short) {
  Point origin;
  for (int a = 0; a < 3; ++a) {
    origin[a] = is_short ? static_cast<double>(std::bit_cast<float>(reader.fixed32())) : take_double(reader);
    if (!std::isfinite(origin[a])) reader.fail("has a bad lattice origin");
  }
  return origin;
}

LatticeBox take_range(ByteReader& reader) {
  LatticeBox range;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t low = reader.signed_varint();
    const std::uint64_t width = reader.varint();
    if (low < -kMaxLatticeCoordinate || low > kMaxLatticeCoordinate ||
        width > static_cast<std::uint64_t>(kMaxLatticeCoordinate - low))
      reader.fail("has a range beyond any lattice");
    range.lo[a] = static_cast<std::int32_t>(low);
    range.hi[a] = static_cast<std::int32_t>(low + static_cast<std::int64_t>(width));
  }
  return range;
}

NumberType take_float_type(ByteReader& reader) {
  const auto type = static_cast<NumberType>(reader.varint_up_to(255));
  if (!ramcdb::is_float(type)) reader.fail("has a bad type of coordinates");
  return type;
}

/// Every counter of a record, for both directions.
template <class Record, class Visit>
void visit_counters(Record& r, Visit&& visit) {
  visit(r.vertices);
  visit(r.faces);
  visit(r.charts);
  visit(r.wires);
  visit(r.corners);
  visit(r.nonmanifold_edges);
  visit(r.nonmanifold_vertices);
  visit(r.isolated_vertices);
  visit(r.degenerate_faces);
  visit(r.duplicate_faces);
  visit(r.inconsistent_edges);
  visit(r.chart_cost.header);
  visit(r.chart_cost.connectivity);
  visit(r.chart_cost.geometry);
  visit(r.page_bytes);
  visit(r.wire_bytes);
  visit(r.table_bytes);
  visit(r.layer_bytes);
  visit(r.exact_bytes);
  visit(r.polygons);
}

template <class Record, class Visit>
void visit_ids(Record& r, Visit&& visit) {
  visit(r.next_chart.value);
  visit(r.next_wire.value);
  visit(r.next_corner.value);
  visit(r.next_page.value);
  visit(r.next_table.value);
  visit(r.table.value);
  visit(r.table_version.value);
  visit(r.layers.value);
  visit(r.target_faces);
}

}  // namespace

Point MeshRecord::rounded(const Point& p) const {
  if (exact != NumberType::float32) return p;
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

std::pair<Point, Point> MeshRecord::bounds(const LatticeBox& box) const {
  Point lo = lattice.position(box.lo), hi = lattice.position(box.hi);
  for (int axis = 0; exact && axis < 3; ++axis) {
    lo[axis] -= lattice.step / 2;
    hi[axis] += lattice.step / 2;
  }
  return {lo, hi};
}

Buffer encode_record(const MeshRecord& record) {
  const Lattice& lattice = record.lattice;
  Buffer out{kRecordFormat};
  out.push_back(
      static_cast<std::uint8_t>((record.exact ? kExact : 0) | (lattice.steps_per_unit != 0 ? kStepsPerUnit : 0) |
                                (record.range.empty() ? 0 : kRange) | (is_float(lattice.origin) ? kShortOrigin : 0)));
  codec::put_varint(out, static_cast<std::uint64_t>(record.written_as));
  codec::put_varint(out, static_cast<std::uint64_t>(record.profile));
  if (record.exact) codec::put_varint(out, static_cast<std::uint64_t>(*record.exact));
  put_double(out, lattice.step);
  if (lattice.steps_per_unit != 0) put_double(out, lattice.steps_per_unit);
  put_origin(out, lattice.origin);
  for (int a = 0; a < 3 && !record.range.empty(); ++a) {
    codec::put_signed_varint(out, record.range.lo[a]);
    codec::put_varint(out, static_cast<std::uint64_t>(std::int64_t{record.range.hi[a]} - record.range.lo[a]));
  }
  const auto put = [&](std::uint64_t value) { codec::put_varint(out, value); };
  visit_ids(record, put);
  visit_counters(record, put);
  return out;
}

MeshRecord decode_record(Bytes blob, std::string_view where) {
  ByteReader reader(blob, "mesh record");
  try {
    const std::uint8_t format = reader.byte();
    if (format > kRecordFormat)
      throw Error(Errc::unsupported_version, "the mesh record has a newer format", where, "use a newer ramcdb");
    if (format == 0) reader.fail("is of no known format");
    const std::uint8_t flags = reader.byte();
    if (flags > (kExact | kStepsPerUnit | kRange | kShortOrigin)) reader.fail("has unknown flags");
    MeshRecord record;
    record.written_as = take_float_type(reader);
    record.profile = static_cast<codec::Profile>(reader.varint_up_to(255));
    if (record.profile != codec::Profile::dense && record.profile != codec::Profile::fast)
      throw Error(Errc::unsupported_version, "the mesh uses an unknown profile", where, "use a newer ramcdb");
    if (flags & kExact) record.exact = take_float_type(reader);
    Lattice& lattice = record.lattice;
    lattice.step = take_double(reader);
    if (!(lattice.step > 0) || !std::isfinite(lattice.step)) reader.fail("has a bad lattice step");
    if (flags & kStepsPerUnit) lattice.steps_per_unit = take_double(reader);
    if (!(lattice.steps_per_unit >= 0) || !std::isfinite(lattice.steps_per_unit)) reader.fail("has bad lattice steps");
    lattice.origin = take_origin(reader, flags & kShortOrigin);
    if (flags & kRange) record.range = take_range(reader);
    visit_ids(record, [&](std::uint32_t& value) { value = reader.varint_up_to(~std::uint32_t{0}); });
    visit_counters(record, [&](std::uint64_t& value) { value = reader.varint(); });
    reader.expect_end();
    return record;
  } catch (const Error& e) {
    if (e.code() != Errc::corrupt) throw;
    throw Error(Errc::corrupt, e.what(), where, "run `ramcdb verify`");
  }
}

}  // namespace ramcdb::detail
