#include "api/import.h"

#include <fmt/format.h>

#include <chrono>

#include "api/large_import.h"
#include "api/lattice_choice.h"
#include "api/mesh_encoder.h"
#include "api/mesh_file/mesh_file.h"
#include "api/new_mesh.h"
#include "api/progress.h"
#include "api/snapping.h"
#include "api/topology.h"
#include "chartify/chartify.h"
#include "chartify/parallel.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint64_t kDefaultMemory = std::uint64_t{1} << 30;

/// The file's positions become lattice points too, so that polygons are cut by these: the same however often a mesh
/// goes out and in.
std::vector<LatticePoint> snap_all(Snapping& snapping, mesh_file::MeshData& data) {
  std::vector<LatticePoint> points;
  points.reserve(data.positions.size());
  for (Point& p : data.positions) {
    const LatticePoint snapped = snapping.snap(p);
    p = {static_cast<double>(snapped.x), static_cast<double>(snapped.y), static_cast<double>(snapped.z)};
    points.push_back(snapped);
  }
  return points;
}

void put_blobs(db::Writer& writer, MeshId mesh, EncodedMesh& encoded) {
  for (std::uint32_t c = 0; c < encoded.charts.size(); ++c)
    writer.put({db::Kind::chart, mesh, c + 1, {}, 0}, std::move(encoded.charts[c]));
  for (auto& [first, group] : encoded.wires) writer.put({db::Kind::wire, mesh, first.value, {}, 0}, std::move(group));
  for (std::uint32_t c = 0; c < encoded.layers.size(); ++c)
    for (LayerBlob& layer : encoded.layers[c])
      writer.put({db::Kind::attribute, mesh, c + 1, {}, layer.layer}, std::move(layer.bytes));
}

}  // namespace

mesh_file::MeshData read_file_whole(const std::filesystem::path& file, std::optional<bool> weld,
                                    const Progress& progress, std::uint64_t& welded,
                                    std::vector<ImportReport::Dropped>& dropped) {
  mesh_file::MeshData data = mesh_file::read_mesh(file, stage(progress, "read"));
  if (weld.value_or(data.soup)) {
    begin_stage(progress, "weld");
    const std::size_t before = data.positions.size();
    mesh_file::weld_exact(data);
    welded = before - data.positions.size();
  }
  for (const auto& left_out : data.dropped) dropped.push_back({left_out.what, left_out.count});
  return data;
}

namespace {

/// What a mesh in memory takes at most while it is imported, from its file to its blobs.
std::uint64_t bytes_in_core(const std::filesystem::path& file) {
  constexpr std::uint64_t kPerFace = 180, kPerFaceOfSoup = 400;
  const bool is_soup = mesh_file::format_of(file) == mesh_file::Format::stl;
  return mesh_file::estimate_faces(file) * (is_soup ? kPerFaceOfSoup : kPerFace);
}

ImportReport import_in_core(db::Store& store, const std::filesystem::path& file, const ImportOptions& options,
                            const std::string& name) {
  ImportReport report;
  mesh_file::MeshData data =
      read_file_whole(file, options.weld, options.progress, report.vertices_welded, report.dropped);
  begin_stage(options.progress, "snap");
  const NumberType type = type_of(data.positions);
  MeshRecord record = new_record(choose_lattice(PositionSource::of(data.positions), type, options), type, options);
  std::vector<Point> exact;
  if (options.lossless) exact = data.positions;
  Snapping snapping(record.lattice, type);
  std::vector<LatticePoint> points = snap_all(snapping, data);
  report.measured_error = note_error(record, snapping.error(), type);
  const auto sorting = stage(options.progress, "sort");
  const mesh_file::Triangulation cut = mesh_file::triangulate(data);
  record.polygons = report.polygons = cut.polygons;
  report.polygons_as_fans = cut.fans;
  chartify::CanonicalMesh canonical =
      chartify::canonical_order({std::move(points), mesh_file::triangles_of(data, cut)}, options.threads, sorting);
  const LayerSource layers(data, cut, canonical, record, exact, options.lossless || options.lossless_attributes);
  canonical.mesh.polygon_of_face = layers.polygon_of_face();
  record.vertices = canonical.mesh.positions.size();
  record.faces = canonical.mesh.faces.size();
  for (const LatticePoint p : canonical.mesh.positions) record.range.add(p);

  chartify::Options chartify_options;
  chartify_options.target_faces = options.chart_faces;
  chartify_options.method = options.paper_chartify ? chartify::Method::paper : chartify::Method::refined;
  chartify_options.threads = options.threads;
  chartify_options.progress = stage(options.progress, "chartify");
  chartify::Adjacency adjacency(canonical.mesh);
  chartify::Charts charts;
  run_beside(
      options.threads, [&] { note_topology(record, analyze(canonical.mesh, adjacency)); },
      [&] { charts = chartify::chartify(canonical.mesh, adjacency, chartify_options); });
  begin_stage(options.progress, "join");
  const chartify::WireNet net = chartify::build_wire_net(canonical.mesh, std::move(adjacency), charts, options.threads);

  const codec::CoderTables tables = train_tables(net, record.profile, record.vertices);
  if (!(tables == codec::CoderTables{})) record.table = record.next_table;
  EncodedMesh encoded =
      encode_mesh(canonical.mesh, net, layers, record, tables, options.threads, stage(options.progress, "encode"));
  note_blobs(record, encoded);
  begin_stage(options.progress, "store");
  publish_mesh(store, {name, file, options}, {encoded.entries, encoded.tables, layers.table()}, record,
               [&](db::Writer& writer, MeshId mesh) { put_blobs(writer, mesh, encoded); });
  return report;
}

}  // namespace

ImportReport import_mesh(db::Store& store, const std::filesystem::path& folder, const std::filesystem::path& file,
                         const ImportOptions& options, std::string& name) {
  const auto start = std::chrono::steady_clock::now();
  name = mesh_name(file, options);
  refuse_taken_name(store, options, file);
  const LargeWork work{folder, options.memory.value_or(kDefaultMemory), options.threads, options.progress};
  ImportReport report;
  try {
    report = mesh_file::reads_in_pieces(mesh_file::format_of(file)) && bytes_in_core(file) > work.memory
                 ? import_large(store, file, options, name, work)
                 : import_in_core(store, file, options, name);
  } catch (const mesh_file::NotInPieces&) {
    if (options.memory) throw;
    report = import_in_core(store, file, options, name);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
