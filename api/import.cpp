#include "api/import.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "api/lattice_choice.h"
#include "api/mesh_encoder.h"
#include "api/mesh_file/mesh_file.h"
#include "api/progress.h"
#include "api/store_format.h"
#include "api/topology.h"
#include "api/version_figures.h"
#include "chartify/chartify.h"
#include "codec/page_codec.h"
#include "db/ref_name.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::string mesh_name(const std::filesystem::path& file, const ImportOptions& options) {
  std::string name = options.name.empty() ? file.stem().string() : options.name;
  if (name.empty() || name.size() > 200 || name.find_first_of("\n\r\t") != std::string::npos)
    throw Error(Errc::invalid_argument, fmt::format("'{}' cannot name a mesh", name), {}, "choose one with --name");
  return name;
}

/// What a version on this branch begins from: its tip; for a branch that is not there yet, main's.
VersionId base_of(db::Store& store, const std::string& branch) {
  if (const VersionId tip = store.tip(branch)) return tip;
  db::require_ref_name(branch);
  return store.tip("main");
}

void refuse_taken(db::Store& store, VersionId tip, const std::string& name) {
  for (const db::MeshRoot& root : store.roots(tip))
    if (root.name == name)
      throw Error(Errc::invalid_argument, fmt::format("the repository already holds a mesh '{}'", name),
                  fmt::format("version {}", tip.value), "choose another with --name");
}

/// Snaps every position, and measures how far the farthest moved along an axis: none, where all come back as the
/// numbers of `type` that they were. The file's positions become lattice points too, so that polygons are cut by these:
/// the same however often a mesh goes out and in.
std::vector<LatticePoint> snap_to(const Lattice& lattice, NumberType type, mesh_file::MeshData& data,
                                  double& measured_error) {
  std::vector<LatticePoint> points;
  points.reserve(data.positions.size());
  bool all_come_back = true;
  for (Point& p : data.positions) {
    const LatticePoint snapped = lattice.snap(p);
    const Point q = lattice.position(snapped);
    for (int a = 0; a < 3; ++a) {
      measured_error = std::max(measured_error, std::abs(q[a] - p[a]));
      all_come_back &= as_type(q[a], type) == p[a];
    }
    p = {static_cast<double>(snapped.x), static_cast<double>(snapped.y), static_cast<double>(snapped.z)};
    points.push_back(snapped);
  }
  if (all_come_back) measured_error = 0;
  return points;
}

void note_topology(MeshRecord& record, const chartify::IndexedMesh& mesh) {
  const Topology t = analyze(mesh);
  record.vertices = mesh.positions.size();
  record.faces = mesh.faces.size();
  record.nonmanifold_edges = t.nonmanifold_edges;
  record.nonmanifold_vertices = t.nonmanifold_vertices;
  record.inconsistent_edges = t.inconsistent_edges;
  record.degenerate_faces = t.degenerate_faces;
  record.duplicate_faces = t.duplicate_faces;
  record.isolated_vertices = t.isolated_vertices;
}

void note_encoding(MeshRecord& record, const EncodedMesh& encoded) {
  record.charts = encoded.charts.size();
  record.wires = encoded.wire_entries.size();
  record.corners = encoded.corner_entries.size();
  record.chart_cost = encoded.cost;
  record.next_chart = ChartId(static_cast<std::uint32_t>(record.charts + 1));
  record.next_wire = WireId(static_cast<std::uint32_t>(record.wires + 1));
  record.next_corner = CornerId(static_cast<std::uint32_t>(record.corners + 1));
  for (const auto& [first, group] : encoded.wires) record.wire_bytes += group.size() + kBlobOverhead;
  for (const auto& chart : encoded.layers)
    for (const LayerBlob& layer : chart) record.bytes_of_layer(layer.layer) += layer.bytes.size() + kBlobOverhead;
}

/// The layer table has a key of its own among the layers: chart 0.
void put_layers(db::Writer& writer, MeshId mesh, EncodedMesh& encoded, const LayerTable& table, MeshRecord& record) {
  if (!table.empty()) {
    Buffer blob = encode_layer_table(table);
    record.layers = writer.version();
    record.table_bytes += blob.size() + kBlobOverhead;
    writer.put({db::Kind::attribute, mesh, 0, {}, 0}, std::move(blob));
  }
  for (std::uint32_t c = 0; c < encoded.layers.size(); ++c)
    for (LayerBlob& layer : encoded.layers[c])
      writer.put({db::Kind::attribute, mesh, c + 1, {}, layer.layer}, std::move(layer.bytes));
}

/// Puts all blobs under the attempt's version and returns where the mesh stands.
db::MeshRoot put_mesh(db::Writer& writer, const std::string& name, EncodedMesh& encoded, const LayerTable& table,
                      MeshRecord& record) {
  const MeshId mesh = writer.new_mesh_id();
  const VersionId version = writer.version();
  const std::vector<Page> pages = build_pages(encoded, version);
  record.next_page = PageId(static_cast<std::uint32_t>(pages.size() + 1));
  for (std::uint32_t p = 0; p < pages.size(); ++p) {
    Buffer blob = codec::encode_page(pages[p]);
    record.page_bytes += blob.size() + kBlobOverhead;
    writer.put({db::Kind::page, mesh, p + 1, {}, 0}, std::move(blob));
  }
  for (std::uint32_t c = 0; c < encoded.charts.size(); ++c)
    writer.put({db::Kind::chart, mesh, c + 1, {}, 0}, std::move(encoded.charts[c]));
  for (auto& [first, group] : encoded.wires) writer.put({db::Kind::wire, mesh, first.value, {}, 0}, std::move(group));
  if (record.table) {
    record.table_version = version;
    record.next_table = TableId(record.table.value + 1);
    record.table_bytes += encoded.tables.size() + kBlobOverhead;
    writer.put({db::Kind::table, mesh, record.table.value, {}, 0}, std::move(encoded.tables));
  }
  put_layers(writer, mesh, encoded, table, record);
  writer.put({db::Kind::mesh_record, mesh, 1, {}, 0}, encode_record(record));
  return {mesh, name, PageId(static_cast<std::uint32_t>(pages.size())), version, version};
}

db::ChangedCharts all_charts(MeshId mesh, std::uint64_t count) {
  db::ChangedCharts changed{mesh, {}};
  for (std::uint32_t c = 1; c <= count; ++c) changed.charts.emplace_back(c);
  return changed;
}

void publish(db::Store& store, const std::string& name, const std::filesystem::path& file, const ImportOptions& options,
             EncodedMesh& encoded, const LayerTable& table, MeshRecord& record) {
  const auto writer = store.writer();
  const VersionId tip = base_of(store, options.branch);
  refuse_taken(store, tip, name);
  db::CommitInfo info;
  info.branch = options.branch;
  info.expected_tip = writer->tip(options.branch);
  if (tip) info.parents = {tip};
  info.author = options.author;
  info.message = options.message.empty() ? "import " + file.filename().string() : options.message;
  info.attempt = db::new_attempt_id();
  info.roots = store.roots(tip);
  info.roots.push_back(put_mesh(*writer, name, encoded, table, record));
  info.changed = {all_charts(info.roots.back().mesh, record.charts)};
  VersionFigures figures;
  figures.operation = "import";
  figures.charts_touched = record.charts;
  figures.vertices_added = record.vertices;
  figures.bytes_written = writer->bytes_put();
  info.figures = encode_figures(figures);
  (void)writer->publish(info);
}

}  // namespace

void refuse_taken_name(db::Store& store, const ImportOptions& options, const std::filesystem::path& file) {
  refuse_taken(store, base_of(store, options.branch), mesh_name(file, options));
}

mesh_file::MeshData read_file_whole(const std::filesystem::path& file, std::optional<bool> weld,
                                    const Progress& progress, std::uint64_t& welded,
                                    std::vector<ImportReport::Dropped>& dropped) {
  mesh_file::MeshData data = mesh_file::read_mesh(file, stage(progress, "read"));
  if (weld.value_or(data.soup)) {
    const std::size_t before = data.positions.size();
    mesh_file::weld_exact(data);
    welded = before - data.positions.size();
  }
  for (const auto& left_out : data.dropped) dropped.push_back({left_out.what, left_out.count});
  return data;
}

ImportReport import_mesh(db::Store& store, const std::filesystem::path& file, const ImportOptions& options,
                         std::string& name) {
  const auto start = std::chrono::steady_clock::now();
  ImportReport report;
  name = mesh_name(file, options);
  refuse_taken(store, base_of(store, options.branch), name);
  MeshRecord record;
  mesh_file::MeshData data =
      read_file_whole(file, options.weld, options.progress, report.vertices_welded, report.dropped);
  const NumberType type = type_of(data.positions);
  record.lattice = choose_lattice(data.positions, type, options);
  record.profile = options.profile == ChartProfile::fast ? codec::Profile::fast : codec::Profile::dense;
  record.target_faces = options.chart_faces;
  std::vector<Point> exact;
  if (options.lossless) {
    record.exact = type;
    exact = data.positions;
  }
  std::vector<LatticePoint> points = snap_to(record.lattice, type, data, report.measured_error);
  if (options.lossless) report.measured_error = 0;
  if (report.measured_error == 0) record.written_as = type;
  const mesh_file::Triangulation cut = mesh_file::triangulate(data);
  record.polygons = report.polygons = cut.polygons;
  report.polygons_as_fans = cut.fans;
  chartify::CanonicalMesh canonical =
      chartify::canonical_order({std::move(points), mesh_file::triangles_of(data, cut)});
  const LayerSource layers(data, cut, canonical, record, exact, options.lossless || options.lossless_attributes);
  canonical.mesh.polygon_of_face = layers.polygon_of_face();
  note_topology(record, canonical.mesh);
  for (const LatticePoint p : canonical.mesh.positions) record.range.add(p);

  chartify::Options chartify_options;
  chartify_options.target_faces = options.chart_faces;
  chartify_options.method = options.paper_chartify ? chartify::Method::paper : chartify::Method::refined;
  chartify_options.threads = options.threads;
  chartify_options.progress = stage(options.progress, "chartify");
  const chartify::Charts charts = chartify::chartify(canonical.mesh, chartify_options);
  const chartify::WireNet net = chartify::build_wire_net(canonical.mesh, charts);

  const codec::CoderTables tables = train_tables(net, record.profile, canonical.mesh.positions.size());
  if (!(tables == codec::CoderTables{})) record.table = record.next_table;
  EncodedMesh encoded =
      encode_mesh(canonical.mesh, net, layers, record, tables, options.threads, stage(options.progress, "encode"));
  note_encoding(record, encoded);
  begin_stage(options.progress, "store");
  publish(store, name, file, options, encoded, layers.table(), record);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
