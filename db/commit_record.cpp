#include "db/commit_record.h"

#include <nlohmann/json.hpp>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

using nlohmann::json;

// A run of chart ids is short for at most this many; more are no repository's.
constexpr std::uint64_t kMostChanged = std::uint64_t{1} << 28;

json roots_to_json(const std::vector<MeshRoot>& roots) {
  json out = json::array();
  for (const MeshRoot& r : roots)
    out.push_back({r.mesh.value, r.name, r.root_page.value, r.root_version.value, r.record_version.value});
  return out;
}

std::vector<MeshRoot> roots_from_json(const json& in) {
  std::vector<MeshRoot> roots;
  for (const json& r : in) {
    MeshRoot root;
    root.mesh = MeshId(r.at(0).get<std::uint32_t>());
    root.name = r.at(1).get<std::string>();
    root.root_page = PageId(r.at(2).get<std::uint32_t>());
    root.root_version = VersionId(r.at(3).get<std::uint32_t>());
    root.record_version = VersionId(r.at(4).get<std::uint32_t>());
    roots.push_back(std::move(root));
  }
  return roots;
}

json runs_of(const std::vector<ChartId>& charts) {
  json runs = json::array();
  for (std::size_t begin = 0, end; begin < charts.size(); begin = end) {
    for (end = begin + 1; end < charts.size() && charts[end].value == charts[end - 1].value + 1;) ++end;
    runs.push_back(charts[begin].value);
    runs.push_back(end - begin);
  }
  return runs;
}

std::vector<ChartId> charts_of(const json& runs) {
  std::vector<ChartId> charts;
  for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
    const auto first = runs[i].get<std::uint32_t>();
    const auto count = runs[i + 1].get<std::uint64_t>();
    if (count > kMostChanged || charts.size() + count > kMostChanged)
      throw Error(Errc::corrupt, "a list of changed charts is damaged", {}, "run `ramcdb verify`");
    for (std::uint32_t k = 0; k < count; ++k) charts.emplace_back(first + k);
  }
  return charts;
}

json changed_to_json(const std::vector<ChangedCharts>& changed) {
  json out = json::array();
  for (const ChangedCharts& c : changed) out.push_back({c.mesh.value, runs_of(c.charts)});
  return out;
}

std::vector<ChangedCharts> changed_from_json(const json& in) {
  std::vector<ChangedCharts> changed;
  for (const json& c : in) changed.push_back({MeshId(c.at(0).get<std::uint32_t>()), charts_of(c.at(1))});
  return changed;
}

/// What `read` makes of the bytes' JSON; throws corrupt where they hold something else.
template <class Read>
auto read_cbor(Bytes bytes, Read&& read) {
  try {
    return read(json::from_cbor(bytes.begin(), bytes.end()));
  } catch (const json::exception&) {
    throw Error(Errc::corrupt, "a record of the version history is damaged", {}, "run `ramcdb verify`");
  }
}

}  // namespace

Buffer encode_roots(const std::vector<MeshRoot>& roots) { return json::to_cbor(roots_to_json(roots)); }

Buffer encode_changed(const std::vector<ChangedCharts>& changed) { return json::to_cbor(changed_to_json(changed)); }

Buffer encode_record(const CommitRecord& record) {
  json parents = json::array();
  for (const VersionId p : record.info.parents) parents.push_back(p.value);
  return json::to_cbor(json{{"id", record.info.id.value},
                            {"parents", parents},
                            {"branch", record.info.branch},
                            {"author", record.info.author},
                            {"message", record.info.message},
                            {"time", record.info.time_us},
                            {"attempt", record.info.attempt},
                            {"figures", record.info.figures},
                            {"roots", roots_to_json(record.roots)},
                            {"changed", changed_to_json(record.changed)}});
}

std::vector<MeshRoot> decode_roots(Bytes bytes) {
  return read_cbor(bytes, [](const json& in) { return roots_from_json(in); });
}

std::vector<ChangedCharts> decode_changed(Bytes bytes) {
  return read_cbor(bytes, [](const json& in) { return changed_from_json(in); });
}

CommitRecord decode_record(Bytes bytes) {
  return read_cbor(bytes, [](const json& in) {
    CommitRecord record;
    record.info.id = VersionId(in.at("id").get<std::uint32_t>());
    for (const json& p : in.at("parents")) record.info.parents.emplace_back(p.get<std::uint32_t>());
    record.info.branch = in.at("branch").get<std::string>();
    record.info.author = in.at("author").get<std::string>();
    record.info.message = in.at("message").get<std::string>();
    record.info.time_us = in.at("time").get<std::int64_t>();
    record.info.attempt = in.at("attempt").get<std::string>();
    record.info.figures = in.at("figures").get<std::string>();
    record.roots = roots_from_json(in.at("roots"));
    record.changed = changed_from_json(in.at("changed"));
    return record;
  });
}

}  // namespace ramcdb::db
