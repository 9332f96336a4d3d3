#include "cli/json_out.h"
#include "cli/attribute_text.h"

#include <nlohmann/json.hpp>

#include "cli/text.h"

namespace ramcdb::cli {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order in which they are written here

std::string printed(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n'; }

Json of(const Point& p) { return Json::array({p.x, p.y, p.z}); }

template <class Tag>
Json of(const std::vector<Id<Tag>>& ids) {
  Json json = Json::array();
  for (const auto id : ids) json.push_back(id.value);
  return json;
}

/// The kinds of bytes, each passed through `figure`.
template <class Figure>
Json by_kind(const MeshBytes& bytes, Figure figure) {
  return {{"wire_net", figure(bytes.wire_net)},
          {"wires", figure(bytes.wires)},
          {"connectivity", figure(bytes.connectivity)},
          {"geometry", figure(bytes.geometry)},
          {"chart_headers", figure(bytes.chart_headers)},
          {"attributes", figure(bytes.attributes)},
          {"tables", figure(bytes.tables)},
          {"payload", figure(bytes.payload)},
          {"store", figure(bytes.store)}};
}

Json of(const Lattice& lattice, bool lossless) {
  return {{"step", lattice.step}, {"origin", of(lattice.origin)}, {"lossless", lossless}};
}

Json of(const std::vector<MeshInfo::Layer>& attributes) {
  Json json = Json::array();
  for (const MeshInfo::Layer& layer : attributes)
    json.push_back({{"name", layer.info.name},
                    {"of", name_of(layer.info.of)},
                    {"type", name_of(layer.info.type)},
                    {"components", layer.info.components},
                    {"meaning", name_of(layer.info.meaning)},
                    {"names", layer.info.names.size()},
                    {"max_error", layer.max_error}});
  return json;
}

Json of(const std::vector<ImportReport::Dropped>& dropped) {
  Json json = Json::array();
  for (const auto& d : dropped) json.push_back({{"what", d.what}, {"count", d.count}});
  return json;
}

Json of(const MeshInfo& info) {
  return {{"mesh", info.mesh},
          {"revision", info.revision.value},
          {"vertices", info.vertices},
          {"faces", info.faces},
          {"charts", info.charts},
          {"wires", info.wires},
          {"corners", info.corners},
          {"components", info.components},
          {"boundary_loops", info.boundary_loops},
          {"nonmanifold_edges", info.nonmanifold_edges},
          {"lattice", of(info.lattice, info.lossless)},
          {"max_error", info.max_error},
          {"profile", info.profile},
          {"bytes", by_kind(info.bytes, [](std::uint64_t bytes) { return bytes; })},
          {"bits_per_vertex",
           by_kind(info.bytes, [&](std::uint64_t bytes) { return bits_per_vertex(bytes, info.vertices); })},
          {"chart_faces",
           {{"min", info.chart_faces.min},
            {"median", info.chart_faces.median},
            {"p95", info.chart_faces.p95},
            {"max", info.chart_faces.max}}},
          {"nonmanifold_vertices", info.nonmanifold_vertices},
          {"isolated_vertices", info.isolated_vertices},
          {"polygons", info.polygons},
          {"attributes", of(info.attributes)},
          {"references", info.references},
          {"degenerate_faces", info.degenerate_faces},
          {"duplicate_faces", info.duplicate_faces},
          {"inconsistent_edges", info.inconsistent_edges},
          {"target_faces", info.target_faces},
          {"box", {{"lo", of(info.lo)}, {"hi", of(info.hi)}}}};
}

Json of(const ChartSummary& chart) {
  return {{"id", chart.id.value},
          {"faces", chart.faces},
          {"vertices", chart.inner_vertices + chart.border_vertices},
          {"inner_vertices", chart.inner_vertices},
          {"border_vertices", chart.border_vertices},
          {"box", {{"lo", of(chart.lo)}, {"hi", of(chart.hi)}}},
          {"bytes", chart.bytes},
          {"attribute_bytes", chart.attribute_bytes},
          {"neighbours", of(chart.neighbours)},
          {"version", chart.version.value}};
}

Json of(const LockInfo& lock) {
  return {{"id", lock.id},
          {"mesh", lock.mesh},
          {"charts", of(lock.charts)},
          {"gone", of(lock.gone)},
          {"owner", lock.owner},
          {"reason", lock.reason},
          {"branch", lock.branch},
          {"taken", iso_time(lock.taken_us, true)},
          {"expires", iso_time(lock.expires_us, true)}};
}

Json of(const std::vector<LockInfo>& locks) {
  Json json = Json::array();
  for (const LockInfo& lock : locks) json.push_back(of(lock));
  return json;
}

Json of(const LockReport& report) { return {{"lock", of(report.lock)}, {"stolen", of(report.stolen)}}; }

Json of(const std::vector<RefName>& refs) {
  Json json = Json::array();
  for (const RefName& ref : refs) json.push_back({{"name", ref.name}, {"kind", ref.is_tag ? "tag" : "branch"}});
  return json;
}

Json of(const FileNotes& notes) {
  return {{"frame", notes.frame},
          {"snapped_back", notes.snapped_back},
          {"attributes_missing", notes.attributes_missing},
          {"attributes_not_taken", notes.not_taken},
          {"values_interpolated", notes.values_interpolated}};
}

const char* name_of(ChangeClass change_class) {
  switch (change_class) {
    case ChangeClass::remeshed:
      return "remeshed";
    case ChangeClass::moved:
      return "moved";
    case ChangeClass::attributes:
      return "attributes";
    case ChangeClass::untouched:
      break;
  }
  return "untouched";
}

/// What of a change stands behind the keys that all have.
Json more_of(const ChangeFigures& figures) {
  Json json = {{"faces_added", figures.faces_added},
               {"faces_removed", figures.faces_removed},
               {"area_before", figures.area_before},
               {"area_after", figures.area_after},
               {"volume_change", nullptr}};
  if (figures.volume_change) json["volume_change"] = *figures.volume_change;
  return json;
}

Json of(const ChangeReport& report) {
  Json json = {{"base", report.base.value},
               {"tip", report.tip.value},
               {"charts_touched", report.charts_touched.size()},
               {"vertices_moved", report.vertices_moved},
               {"vertices_added", report.vertices_added},
               {"vertices_removed", report.vertices_removed},
               {"max_displacement", report.max_displacement},
               {"conflicts", of(report.conflicts)},
               {"clean", report.clean()},
               {"values_changed", report.values_changed},
               {"charts", of(report.charts_touched)},
               {"border_vertices_moved", report.border_vertices_moved},
               {"rms_displacement", report.rms_displacement},
               {"changed_by_others", of(report.changed_by_others)},
               {"locks", of(report.locks)}};
  json.update(more_of(report));
  json["notes"] = of(report.notes);
  return json;
}

Json of(const std::vector<ChartChange>& changes) {
  Json json = Json::array();
  for (const ChartChange& change : changes) {
    json.push_back({{"chart", change.chart.value},
                    {"class", name_of(change.change_class())},
                    {"vertices_moved", change.vertices_moved},
                    {"vertices_added", change.vertices_added},
                    {"vertices_removed", change.vertices_removed},
                    {"values_changed", change.values_changed},
                    {"max_displacement", change.max_displacement},
                    {"rms_displacement", change.rms_displacement}});
    json.back().update(more_of(change));
  }
  return json;
}

Json mesh_names(const VersionRecord& version) {
  Json json = Json::array();
  for (const auto& change : version.changes) json.push_back(change.mesh);
  return json;
}

Json of(const VersionRecord& version) {
  return {{"id", version.id.value},        {"parents", of(version.parents)},           {"branch", version.branch},
          {"author", version.author},      {"time", iso_time(version.time_us, true)},  {"message", version.message},
          {"meshes", mesh_names(version)}, {"charts_touched", version.charts_touched}, {"refs", of(version.refs)}};
}

Json of(const VerifyReport::Problem& problem) {
  return {{"kind", problem.kind},
          {"mesh", problem.mesh},
          {"object", problem.object},
          {"revision", problem.revision.value},
          {"text", problem.text}};
}

Json of(const std::vector<MergeConflict>& conflicts) {
  Json places = Json::array();
  for (const MergeConflict& conflict : conflicts)
    places.push_back({{"mesh", conflict.mesh},
                      {"chart", conflict.chart.value},
                      {"place", {conflict.place.x, conflict.place.y, conflict.place.z}},
                      {"what", conflict.what}});
  return places;
}

Json of(const CommitReport& report) {
  Json json = {{"revision", report.revision.value},
               {"parent", report.parent.value},
               {"charts_touched", report.charts_touched},
               {"charts_reencoded", report.charts_reencoded},
               {"charts_added", report.charts_added},
               {"charts_removed", report.charts_removed},
               {"wires_reencoded", report.wires_reencoded},
               {"ranges_expanded", report.ranges_expanded},
               {"vertices_moved", report.vertices_moved},
               {"vertices_added", report.vertices_added},
               {"vertices_removed", report.vertices_removed},
               {"max_displacement", report.max_displacement},
               {"bytes_written", report.bytes_written},
               {"seconds", report.seconds},
               {"values_changed", report.values_changed},
               {"layers_reencoded", report.layers_reencoded},
               {"nothing_changed", report.nothing_changed},
               {"conflicts", of(report.conflicts)},
               {"merged", report.merged},
               {"conflict_places", of(report.conflict_places)},
               {"normals_left", report.normals_left},
               {"faces_added", report.faces_added},
               {"faces_removed", report.faces_removed},
               {"added", of(report.added)},
               {"removed", of(report.removed)},
               {"notes", of(report.notes)}};
  if (report.per_mesh.empty()) return json;
  json["meshes"] = Json::array();
  for (const CommitReport& of_mesh : report.per_mesh) {
    json["meshes"].push_back(of(of_mesh));
    json["meshes"].back()["mesh"] = of_mesh.mesh;
  }
  return json;
}

}  // namespace

std::string init_json(const std::filesystem::path& folder, const std::string& id) {
  return printed({{"repository", folder.string()}, {"id", id}});
}

std::string import_json(const ImportReport& report) {
  Json json = of(report.info);
  json["dropped"] = of(report.dropped);
  json["polygons_as_fans"] = report.polygons_as_fans;
  json["vertices_welded"] = report.vertices_welded;
  json["measured_error"] = report.measured_error;
  json["seconds"] = report.seconds;
  return printed(json);
}

std::string info_json(const MeshInfo& info) { return printed(of(info)); }

std::string meshes_json(const std::vector<MeshSummary>& meshes, VersionId revision) {
  Json json = {{"revision", revision.value}, {"meshes", Json::array()}};
  for (const MeshSummary& mesh : meshes)
    json["meshes"].push_back({{"name", mesh.name},
                              {"id", mesh.id.value},
                              {"vertices", mesh.vertices},
                              {"faces", mesh.faces},
                              {"charts", mesh.charts},
                              {"payload", mesh.payload}});
  return printed(json);
}

std::string charts_json(const std::vector<ChartSummary>& charts, VersionId revision) {
  Json json = {{"revision", revision.value}, {"charts", Json::array()}};
  for (const ChartSummary& chart : charts) json["charts"].push_back(of(chart));
  return printed(json);
}

std::string checkout_json(const CheckoutReport& report) {
  Json json = {
      {"revision", report.revision.value}, {"charts", report.charts},         {"faces", report.faces},
      {"vertices", report.vertices},       {"bytes_read", report.bytes_read}, {"blobs_read", report.blobs_read},
      {"seconds", report.seconds},         {"pages_read", report.pages_read}, {"local_origin", of(report.local_origin)},
      {"left_out", of(report.left_out)}};
  if (report.lock) json.update(of(*report.lock));
  return printed(json);
}

std::string status_json(const ChangeReport& report) { return diff_json(report); }

std::string diff_json(const ChangeReport& report) {
  Json json = of(report);
  json["per_chart"] = of(report.per_chart);
  return printed(json);
}

std::string diff_json(const DiffReport& report) {
  Json json = {{"from", report.from.value},
               {"to", report.to.value},
               {"changed", of(report.changed)},
               {"added", of(report.added)},
               {"removed", of(report.removed)},
               {"vertices_moved", report.vertices_moved},
               {"max_displacement", report.max_displacement},
               {"rms_displacement", report.rms_displacement},
               {"per_chart", of(report.per_chart)},
               {"vertices_added", report.vertices_added},
               {"vertices_removed", report.vertices_removed},
               {"values_changed", report.values_changed}};
  json.update(more_of(report));
  json["bytes_read"] = report.bytes_read;
  json["blobs_read"] = report.blobs_read;
  json["pages_read"] = report.pages_read;
  return printed(json);
}

std::string merge_json(const MergeReport& report) {
  Json json = {{"revision", report.revision.value},
               {"parent", report.parent.value},
               {"theirs", report.theirs.value},
               {"base", report.base.value},
               {"nothing_changed", report.nothing_changed},
               {"charts_taken", report.charts_taken},
               {"charts_reencoded", report.commit.charts_reencoded},
               {"vertices_moved", report.commit.vertices_moved},
               {"bytes_written", report.commit.bytes_written},
               {"conflicts", of(report.commit.conflicts)},
               {"conflict_places", of(report.commit.conflict_places)},
               {"seconds", report.seconds}};
  if (!report.commit.per_mesh.empty()) json["meshes"] = of(report.commit)["meshes"];
  return printed(json);
}

std::string commit_json(const CommitReport& report) { return printed(of(report)); }

std::string import_into_json(const ImportIntoReport& report) {
  Json json = of(report.commit);
  json["vertices"] = report.vertices;
  json["faces"] = report.faces;
  json["dropped"] = of(report.dropped);
  json["polygons"] = report.polygons;
  json["polygons_as_fans"] = report.polygons_as_fans;
  json["vertices_welded"] = report.vertices_welded;
  json["measured_error"] = report.measured_error;
  json["attributes_missing"] = report.commit.notes.attributes_missing;
  return printed(json);
}

std::string repack_json(const RepackReport& report) {
  const auto same = [](std::uint64_t bytes) { return bytes; };
  return printed({{"revision", report.revision.value},
                  {"parent", report.parent.value},
                  {"nothing_changed", report.nothing_changed},
                  {"profile", report.profile},
                  {"charts", report.charts},
                  {"bytes_before", by_kind(report.before, same)},
                  {"bytes", by_kind(report.after, same)},
                  {"bytes_written", report.bytes_written},
                  {"seconds", report.seconds}});
}

std::string log_json(const std::vector<VersionRecord>& versions) {
  Json json = {{"revisions", Json::array()}};
  for (const VersionRecord& version : versions) json["revisions"].push_back(of(version));
  return printed(json);
}

std::string show_json(const VersionRecord& version) {
  Json json = of(version);
  json["operation"] = version.operation;
  json["changes"] = Json::array();
  for (const auto& change : version.changes)
    json["changes"].push_back({{"mesh", change.mesh}, {"charts", of(change.charts)}});
  json["vertices_moved"] = version.vertices_moved;
  json["vertices_added"] = version.vertices_added;
  json["vertices_removed"] = version.vertices_removed;
  json["max_displacement"] = version.max_displacement;
  json["bytes_written"] = version.bytes_written;
  return printed(json);
}

std::string branches_json(const std::vector<Branch>& branches) {
  Json json = {{"branches", Json::array()}};
  for (const Branch& branch : branches)
    json["branches"].push_back(
        {{"name", branch.name}, {"version", branch.tip.value}, {"ahead", branch.ahead}, {"behind", branch.behind}});
  return printed(json);
}

std::string tags_json(const std::vector<Tag>& tags) {
  Json json = {{"tags", Json::array()}};
  for (const Tag& tag : tags) json["tags"].push_back({{"name", tag.name}, {"version", tag.version.value}});
  return printed(json);
}

std::string name_change_json(const NameChange& change) {
  Json json = {{"kind", change.kind}, {"name", change.name}};
  if (!change.before.empty()) json["before"] = change.before;
  if (change.version) json["version"] = change.version.value;
  json["nameless"] = of(change.nameless);
  return printed(json);
}

std::string locks_json(const std::vector<LockInfo>& locks, const char* key) { return printed({{key, of(locks)}}); }

std::string lock_json(const LockReport& report) { return printed(of(report)); }

std::string verify_json(const VerifyReport& report) {
  Json json = {{"ok", report.ok()},
               {"objects", report.objects},
               {"decoded_charts", report.decoded_charts},
               {"problems", Json::array()}};
  for (const auto& problem : report.problems) json["problems"].push_back(of(problem));
  return printed(json);
}

}  // namespace ramcdb::cli
