#include "tools/benchmark/cut_bench.h"

#include <metis.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "api/mesh_encoder.h"
#include "chartify/partition.h"
#include "codec/page_codec.h"
#include "tools/benchmark/peer.h"

namespace ramcdb::benchmark {
namespace {

/// Positions and triangles alone, snapped to a lattice of so many bits along the largest extent.
mesh_file::MeshData read_snapped(const std::filesystem::path& file, unsigned bits, std::vector<LatticePoint>& points) {
  mesh_file::MeshData data = mesh_file::read_mesh(file);
  data.attributes.clear();
  Point lo = data.positions.front(), hi = lo;
  for (const Point& p : data.positions)
    for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], p[a]), hi[a] = std::max(hi[a], p[a]);
  const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  const Lattice lattice{lo, extent / static_cast<double>((1U << bits) - 1)};
  for (const Point& p : data.positions) points.push_back(lattice.snap(p));
  return data;
}

/// The dual graph of the faces that are cut at all, through METIS.
std::vector<std::uint32_t> cut_with_metis(const chartify::IndexedMesh& mesh, std::uint32_t target) {
  const auto neighbours = chartify::find_neighbours(chartify::find_twins(mesh, chartify::group_half_edges(mesh)));
  const chartify::Regions components = chartify::find_components(neighbours, target);
  std::vector<idx_t> node_of(mesh.faces.size(), -1), begin{0}, edges;
  std::vector<std::uint32_t> face_of;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t region = components.region_of_face[f];
    if (region == chartify::kNone || components.charts[region] == 0) continue;
    node_of[f] = static_cast<idx_t>(face_of.size());
    face_of.push_back(f);
  }
  for (const std::uint32_t f : face_of) {
    for (std::size_t e = 0; e < 3; ++e)
      if (const std::uint32_t n = neighbours[3 * f + e]; n != chartify::kNone) edges.push_back(node_of[n]);
    begin.push_back(static_cast<idx_t>(edges.size()));
  }
  std::vector<std::uint32_t> chart_of_face(mesh.faces.size(), 0);
  idx_t parts = 0;
  for (const std::uint32_t charts : components.charts) parts += static_cast<idx_t>(charts);
  if (parts < 2) return chart_of_face;

  idx_t nodes = static_cast<idx_t>(face_of.size()), constraints = 1, volume = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_OBJTYPE] = METIS_OBJTYPE_VOL;
  options[METIS_OPTION_UFACTOR] = 100;  // charts of up to 1.1 times the mean
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> part(face_of.size());
  if (METIS_PartGraphKway(&nodes, &constraints, begin.data(), edges.data(), nullptr, nullptr, nullptr, &parts, nullptr,
                          nullptr, options, &volume, part.data()) != METIS_OK)
    throw std::runtime_error("METIS failed");
  for (std::size_t i = 0; i < face_of.size(); ++i) chart_of_face[face_of[i]] = static_cast<std::uint32_t>(part[i]);
  return chart_of_face;
}

/// All blobs of a mesh that is cut so, with their checksums.
std::uint64_t bytes_of(const mesh_file::MeshData& data, const chartify::CanonicalMesh& canonical,
                       const chartify::Charts& charts) {
  const chartify::WireNet net = chartify::build_wire_net(canonical.mesh, charts);
  detail::MeshRecord record;
  for (const LatticePoint p : canonical.mesh.positions) record.range.add(p);
  const codec::CoderTables tables = detail::train_tables(net, codec::Profile::dense, canonical.mesh.positions.size());
  if (!(tables == codec::CoderTables{})) record.table = record.next_table;
  const mesh_file::Triangulation cut = mesh_file::triangulate(data);
  const std::vector<Point> exact;
  const detail::LayerSource no_layers(data, cut, canonical, record, exact, false);
  const detail::EncodedMesh encoded =
      detail::encode_mesh(canonical.mesh, net, no_layers, record, tables, 1, [](double) {});
  std::uint64_t bytes = record.table ? encoded.tables.size() + kBlobOverhead : 0;
  for (const Buffer& chart : encoded.charts) bytes += chart.size() + kBlobOverhead;
  for (const auto& [first, group] : encoded.wires) bytes += group.size() + kBlobOverhead;
  for (const Page& page : detail::build_pages(encoded.entries, VersionId(1)))
    bytes += codec::encode_page(page).size() + kBlobOverhead;
  return bytes;
}

}  // namespace

CutFigures measure_cut(const std::filesystem::path& file, unsigned bits, std::uint32_t chart_faces) {
  std::vector<LatticePoint> points;
  mesh_file::MeshData data = read_snapped(file, bits, points);
  const chartify::CanonicalMesh canonical =
      chartify::canonical_order({points, mesh_file::triangles_of(data, mesh_file::triangulate(data))});
  chartify::Options options;
  options.target_faces = chart_faces;
  const chartify::Charts ours = chartify::chartify(canonical.mesh, options);
  const chartify::Charts theirs =
      chartify::refine_cut(canonical.mesh, cut_with_metis(canonical.mesh, chart_faces), options);
  return {file.stem(),      points.size(),     bytes_of(data, canonical, ours), bytes_of(data, canonical, theirs),
          ours.chart_count, theirs.chart_count};
}

}  // namespace ramcdb::benchmark
