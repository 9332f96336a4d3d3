#include "api/mesh_record.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using nlohmann::json;

constexpr int kRecordFormat = 1;

json point_json(LatticePoint p) { return json::array({p.x, p.y, p.z}); }
LatticePoint point_from(const json& j) {
  return {j.at(0).get<std::int32_t>(), j.at(1).get<std::int32_t>(), j.at(2).get<std::int32_t>()};
}

/// Every counter of a record with its key, for both directions.
template <class Record, class Visit>
void visit_counters(Record& r, Visit&& visit) {
  visit("v", r.vertices);
  visit("f", r.faces);
  visit("c", r.charts);
  visit("w", r.wires);
  visit("k", r.corners);
  visit("co", r.components);
  visit("bl", r.boundary_loops);
  visit("ne", r.nonmanifold_edges);
  visit("nv", r.nonmanifold_vertices);
  visit("iv", r.isolated_vertices);
  visit("df", r.degenerate_faces);
  visit("du", r.duplicate_faces);
  visit("ie", r.inconsistent_edges);
  visit("ch", r.chart_cost.header);
  visit("cc", r.chart_cost.connectivity);
  visit("cg", r.chart_cost.geometry);
  visit("pb", r.page_bytes);
  visit("wb", r.wire_bytes);
  visit("tb", r.table_bytes);
  visit("lb", r.layer_bytes);
  visit("xb", r.exact_bytes);
  visit("po", r.polygons);
}

template <class Record, class Visit>
void visit_ids(Record& r, Visit&& visit) {
  visit("nc", r.next_chart.value);
  visit("nw", r.next_wire.value);
  visit("nk", r.next_corner.value);
  visit("np", r.next_page.value);
  visit("nt", r.next_table.value);
  visit("ti", r.table.value);
  visit("tv", r.table_version.value);
  visit("la", r.layers.value);
  visit("tf", r.target_faces);
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
  json j;
  j["format"] = kRecordFormat;
  j["o"] = json::array({record.lattice.origin.x, record.lattice.origin.y, record.lattice.origin.z});
  j["s"] = record.lattice.step;
  j["n"] = record.lattice.steps_per_unit;
  j["t"] = static_cast<int>(record.written_as);
  j["x"] = record.exact ? static_cast<int>(*record.exact) : 0;
  j["p"] = static_cast<int>(record.profile);
  if (!record.range.empty()) {
    j["lo"] = point_json(record.range.lo);
    j["hi"] = point_json(record.range.hi);
  }
  visit_ids(record, [&](const char* key, std::uint32_t value) { j[key] = value; });
  visit_counters(record, [&](const char* key, std::uint64_t value) { j[key] = value; });
  return json::to_cbor(j);
}

MeshRecord decode_record(Bytes blob, std::string_view where) {
  const auto damaged = [&](std::string_view why) {
    return Error(Errc::corrupt, std::string("the mesh record is damaged: ").append(why), where, "run `ramcdb verify`");
  };
  try {
    const json j = json::from_cbor(blob.begin(), blob.end());
    if (j.at("format").get<int>() != kRecordFormat)
      throw Error(Errc::unsupported_version, "the mesh record has a newer format", where, "use a newer ramcdb");
    MeshRecord record;
    for (int a = 0; a < 3; ++a) record.lattice.origin[a] = j.at("o").at(static_cast<std::size_t>(a)).get<double>();
    record.lattice.step = j.at("s").get<double>();
    record.lattice.steps_per_unit = j.at("n").get<double>();
    record.written_as = static_cast<NumberType>(j.at("t").get<int>());
    if (!is_float(record.written_as)) throw damaged("bad type of coordinates");
    if (const int exact = j.at("x").get<int>(); exact != 0) record.exact = static_cast<NumberType>(exact);
    if (record.exact && !is_float(*record.exact)) throw damaged("bad type of positions");
    if (!(record.lattice.steps_per_unit >= 0) || !std::isfinite(record.lattice.steps_per_unit))
      throw damaged("bad lattice steps");
    if (!(record.lattice.step > 0) || !std::isfinite(record.lattice.step)) throw damaged("bad lattice step");
    for (int a = 0; a < 3; ++a)
      if (!std::isfinite(record.lattice.origin[a])) throw damaged("bad lattice origin");
    record.profile = static_cast<codec::Profile>(j.at("p").get<int>());
    if (record.profile != codec::Profile::dense && record.profile != codec::Profile::fast)
      throw Error(Errc::unsupported_version, "the mesh uses an unknown profile", where, "use a newer ramcdb");
    if (j.contains("lo")) {
      record.range.lo = point_from(j.at("lo"));
      record.range.hi = point_from(j.at("hi"));
    }
    visit_ids(record, [&](const char* key, std::uint32_t& value) { value = j.at(key).get<std::uint32_t>(); });
    visit_counters(record, [&](const char* key, std::uint64_t& value) { value = j.at(key).get<std::uint64_t>(); });
    return record;
  } catch (const json::exception& e) {
    throw damaged(e.what());
  }
}

}  // namespace ramcdb::detail
