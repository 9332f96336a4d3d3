#include "api/new_mesh.h"

#include <fmt/format.h>

#include <vector>

#include "api/store_format.h"
#include "api/version_figures.h"
#include "codec/page_codec.h"
#include "db/ref_name.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

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

/// The layer table has a key of its own among the layers: chart 0.
void put_layer_table(db::Writer& writer, MeshId mesh, const LayerTable& table, MeshRecord& record) {
  if (table.empty()) return;
  Buffer blob = encode_layer_table(table);
  record.layers = writer.version();
  record.table_bytes += blob.size() + kBlobOverhead;
  writer.put({db::Kind::attribute, mesh, 0, {}, 0}, std::move(blob));
}

/// Puts all but what others put, and returns where the mesh stands.
db::MeshRoot put_mesh(db::Writer& writer, const std::string& name, const NewMeshParts& parts, MeshRecord& record,
                      const std::function<void(db::Writer&, MeshId)>& put_blobs) {
  const MeshId mesh = writer.new_mesh_id();
  const VersionId version = writer.version();
  const std::vector<Page> pages = build_pages(parts.entries, version);
  record.next_page = PageId(static_cast<std::uint32_t>(pages.size() + 1));
  for (std::uint32_t p = 0; p < pages.size(); ++p) {
    Buffer blob = codec::encode_page(pages[p]);
    record.page_bytes += blob.size() + kBlobOverhead;
    writer.put({db::Kind::page, mesh, p + 1, {}, 0}, std::move(blob));
  }
  put_blobs(writer, mesh);
  if (record.table) {
    record.table_version = version;
    record.next_table = TableId(record.table.value + 1);
    record.table_bytes += parts.tables.size() + kBlobOverhead;
    writer.put({db::Kind::table, mesh, record.table.value, {}, 0}, parts.tables);
  }
  put_layer_table(writer, mesh, parts.layers, record);
  writer.put({db::Kind::mesh_record, mesh, 1, {}, 0}, encode_record(record));
  return {mesh, name, PageId(static_cast<std::uint32_t>(pages.size())), version, version};
}

db::ChangedCharts all_charts(MeshId mesh, std::uint64_t count) {
  db::ChangedCharts changed{mesh, {}};
  for (std::uint32_t c = 1; c <= count; ++c) changed.charts.emplace_back(c);
  return changed;
}

}  // namespace

std::string mesh_name(const std::filesystem::path& file, const ImportOptions& options) {
  std::string name = options.name.empty() ? file.stem().string() : options.name;
  if (name.empty() || name.size() > 200 || name.find_first_of("\n\r\t") != std::string::npos)
    throw Error(Errc::invalid_argument, fmt::format("'{}' cannot name a mesh", name), {}, "choose one with --name");
  return name;
}

void refuse_taken_name(db::Store& store, const ImportOptions& options, const std::filesystem::path& file) {
  refuse_taken(store, base_of(store, options.branch), mesh_name(file, options));
}

MeshRecord new_record(const Lattice& lattice, NumberType type, const ImportOptions& options) {
  MeshRecord record;
  record.lattice = lattice;
  record.profile = options.profile == ChartProfile::fast ? codec::Profile::fast : codec::Profile::dense;
  record.target_faces = options.chart_faces;
  if (options.lossless) record.exact = type;
  return record;
}

double note_error(MeshRecord& record, double error, NumberType type) {
  const double kept = record.exact ? 0 : error;
  if (kept == 0) record.written_as = type;
  return kept;
}

void note_topology(MeshRecord& record, const Topology& t) {
  record.nonmanifold_edges = t.nonmanifold_edges;
  record.nonmanifold_vertices = t.nonmanifold_vertices;
  record.inconsistent_edges = t.inconsistent_edges;
  record.degenerate_faces = t.degenerate_faces;
  record.duplicate_faces = t.duplicate_faces;
  record.isolated_vertices = t.isolated_vertices;
}

void note_entries(MeshRecord& record, const NetEntries& entries) {
  record.charts = entries.charts.size();
  record.wires = entries.wires.size();
  record.corners = entries.corners.size();
  record.next_chart = ChartId(static_cast<std::uint32_t>(record.charts + 1));
  record.next_wire = WireId(static_cast<std::uint32_t>(record.wires + 1));
  record.next_corner = CornerId(static_cast<std::uint32_t>(record.corners + 1));
}

void note_blobs(MeshRecord& record, const EncodedMesh& encoded) {
  record.chart_cost.header += encoded.cost.header;
  record.chart_cost.connectivity += encoded.cost.connectivity;
  record.chart_cost.geometry += encoded.cost.geometry;
  for (const auto& [first, group] : encoded.wires) record.wire_bytes += group.size() + kBlobOverhead;
  for (const auto& chart : encoded.layers)
    for (const LayerBlob& layer : chart) record.bytes_of_layer(layer.layer) += layer.bytes.size() + kBlobOverhead;
}

void publish_mesh(db::Store& store, const NewMeshSource& source, const NewMeshParts& parts, MeshRecord& record,
                  const std::function<void(db::Writer& writer, MeshId mesh)>& put_blobs) {
  const ImportOptions& options = source.options;
  const auto writer = store.writer();
  const VersionId tip = base_of(store, options.branch);
  refuse_taken(store, tip, source.name);
  note_entries(record, parts.entries);
  db::CommitInfo info;
  info.branch = options.branch;
  info.expected_tip = writer->tip(options.branch);
  if (tip) info.parents = {tip};
  info.author = options.author;
  info.message = options.message.empty() ? "import " + source.file.filename().string() : options.message;
  info.attempt = db::new_attempt_id();
  info.roots = store.roots(tip);
  info.roots.push_back(put_mesh(*writer, source.name, parts, record, put_blobs));
  info.changed = {all_charts(info.roots.back().mesh, record.charts)};
  VersionFigures figures;
  figures.operation = "import";
  figures.charts_touched = record.charts;
  figures.vertices_added = record.vertices;
  figures.bytes_written = writer->bytes_put();
  info.figures = encode_figures(figures);
  (void)writer->publish(info);
}

}  // namespace ramcdb::detail
