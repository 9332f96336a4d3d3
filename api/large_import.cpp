#include "api/large_import.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "api/batch_encoder.h"
#include "api/block_cutter.h"
#include "api/chart_seams.h"
#include "api/face_blocks.h"
#include "api/mesh_spool.h"
#include "api/new_mesh.h"
#include "api/scratch_file.h"
#include "api/snapping.h"

namespace ramcdb::detail {
namespace {

/// Several parts at a time leave no processor idle, as long as each is large enough for good charts.
PartSizes part_sizes(const LargeWork& work, std::uint32_t chart_faces) {
  constexpr std::uint64_t kBytesPerFace = 320;  // with all that chartify/ and codec/ need for it
  constexpr std::uint64_t kLeastCharts = 4, kGoodCharts = 128, kMostAtATime = 8;
  const std::uint64_t faces = std::max<std::uint64_t>(work.memory / kBytesPerFace, kLeastCharts * chart_faces);
  const std::uint64_t at_a_time = std::clamp<std::uint64_t>(faces / (kGoodCharts * chart_faces), 1, kMostAtATime);
  return {faces / at_a_time, static_cast<std::size_t>(at_a_time)};
}

/// The positions of a mesh; every walk through them can be cancelled.
PositionSource positions_of(const MeshSpool& mesh, const LargeWork& work) {
  PositionSource source = mesh.points.source();
  source.walk = [&work, walk = std::move(source.walk)](const std::function<bool(std::span<const Point>)>& take) {
    walk([&](std::span<const Point> some) {
      work.report("snap", 0);
      return take(some);
    });
  };
  return source;
}

/// The record as far as it is known before polygons and charts are cut.
MeshRecord record_for(const MeshSpool& mesh, const ImportOptions& options, ImportReport& report,
                      const LargeWork& work) {
  const NumberType type = mesh.points.type();
  MeshRecord record = new_record(choose_lattice(positions_of(mesh, work), type, options), type, options);
  Snapping snapping(record.lattice, type);
  std::uint64_t seen = 0;
  mesh.points.source().walk([&](std::span<const Point> some) {
    for (const Point& p : some) record.range.add(snapping.snap(p));
    work.report("snap", static_cast<double>(seen += some.size()) / static_cast<double>(mesh.points.size()));
    return true;
  });
  report.measured_error = note_error(record, snapping.error(), type);
  record.vertices = mesh.vertices();
  return record;
}

ChartSpool cut_charts(const MeshSpool& mesh, const MeshRecord& record, const ImportOptions& options, PartSizes sizes,
                      const LargeWork& work) {
  chartify::Options chartify_options;
  chartify_options.target_faces = options.chart_faces;
  chartify_options.method = options.paper_chartify ? chartify::Method::paper : chartify::Method::refined;
  chartify_options.threads = options.threads;
  // Half is left to what waits for a block.
  const FaceBlocks blocks = sort_into_blocks(mesh, record.lattice, record.range, sizes.most_faces / 2, work);
  return cut_blocks(blocks, mesh, record.lattice, sizes, chartify_options, work);
}

LayerTable layers_of(const MeshSpool& mesh, const ImportOptions& options) {
  LayerTable table;
  if (mesh.polygons && mesh.polygons->count > 0) table.layers.push_back(polygon_layer(1));
  for (const SpooledAttribute& attribute : mesh.attributes)
    table.layers.push_back(layer_for(attribute.view(), static_cast<std::uint16_t>(table.layers.size() + 1),
                                     options.lossless || options.lossless_attributes));
  table.references = mesh.references;
  return table;
}

}  // namespace

ImportReport import_large(db::Store& store, const std::filesystem::path& file, const ImportOptions& options,
                          const std::string& name, const LargeWork& work) {
  ImportReport report;
  sweep_scratch(work.folder);
  MeshSpool mesh = spool_mesh(file, options.weld, work);
  report.vertices_welded = mesh.welded;
  for (const auto& left_out : mesh.dropped) report.dropped.push_back({left_out.what, left_out.count});
  MeshRecord record = record_for(mesh, options, report, work);
  cut_polygons(mesh, record.lattice, work);
  record.faces = mesh.faces().size();
  if (mesh.polygons) {
    record.polygons = report.polygons = mesh.polygons->count;
    report.polygons_as_fans = mesh.polygons->fans;
  }
  const PartSizes sizes = part_sizes(work, options.chart_faces);
  const ChartSpool spool = cut_charts(mesh, record, options, sizes, work);
  const std::vector<ChartSpool::Batch> batches = spool.batches(sizes.most_faces);
  const ChartSeams seams = find_seams(spool, batches, sizes.at_a_time, mesh, record.lattice, work);
  note_topology(record, seams.topology);

  const LayerTable layers = layers_of(mesh, options);
  const BatchedCharts charts{spool, batches, sizes.at_a_time, seams, mesh, layers};
  work.report("encode", 0);
  const codec::CoderTables tables = train_tables(charts, record);
  if (!(tables == codec::CoderTables{})) record.table = record.next_table;
  BlobSpool blobs(work.folder);
  const NetEntries entries = encode_batches(charts, tables, record, blobs, work);
  publish_mesh(store, {name, file, options}, {entries, record.table ? codec::encode_tables(tables) : Buffer(), layers},
               record, [&](db::Writer& writer, MeshId id) { blobs.put_all(writer, id, work); });
  return report;
}

}  // namespace ramcdb::detail
