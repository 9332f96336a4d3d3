#include "ramcdb/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "api/region_mesh.h"
#include "api/region_query.h"
#include "api/snapshot_impl.h"
#include "api/store_format.h"
#include "api/surface_pieces.h"
#include "ramcdb/error.h"

namespace ramcdb {
namespace {

MeshInfo::Spread spread_of(std::vector<std::uint32_t> sizes) {
  if (sizes.empty()) return {};
  std::sort(sizes.begin(), sizes.end());
  const auto at = [&](double share) {
    return sizes[std::min(sizes.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sizes.size())))];
  };
  return {sizes.front(), at(0.5), at(0.95), sizes.back()};
}

std::vector<std::uint32_t> chart_sizes(const detail::PageIndex& pages) {
  std::vector<std::uint32_t> sizes;
  pages.visit([](const LatticeBox&) { return true; },
              [&](const detail::LeafRef& ref) {
                for (const PageChart& chart : ref.leaf->charts) sizes.push_back(chart.faces);
              });
  return sizes;
}

ChartSummary summary_of(const Snapshot::Impl& at, db::BlobReader& reader, const LeafPage& leaf,
                        const PageChart& chart) {
  ChartSummary summary;
  summary.id = chart.id;
  summary.faces = chart.faces;
  summary.inner_vertices = chart.inner_vertices;
  std::set<ChartId> neighbours;
  for (const WireLoop& loop : chart.loops)
    for (const DirectedWire step : loop) {
      const PageWire& wire = *detail::find_wire(leaf, step.wire);
      summary.border_vertices += wire.inner_points + 1;
      neighbours.insert(wire.charts.begin(), wire.charts.end());
    }
  neighbours.erase(chart.id);
  summary.neighbours.assign(neighbours.begin(), neighbours.end());
  std::tie(summary.lo, summary.hi) = at.record().bounds(chart.box);
  summary.version = chart.version;
  for (const LayerRef& layer : chart.layers) {
    summary.version = std::max(summary.version, layer.version);
    const db::BlobKey key{db::Kind::attribute, at.root().mesh, chart.id.value, layer.version, layer.layer};
    (layer.layer == detail::kExactLayer ? summary.bytes : summary.attribute_bytes) +=
        reader.get(key).size() + detail::kBlobOverhead;
  }
  summary.bytes +=
      reader.get({db::Kind::chart, at.root().mesh, chart.id.value, chart.version, 0}).size() + detail::kBlobOverhead;
  return summary;
}

}  // namespace

VersionId Snapshot::version() const { return impl_->version(); }
const Lattice& Snapshot::lattice() const { return impl_->record().lattice; }

MeshInfo Snapshot::info() const {
  const detail::MeshRecord& record = impl_->record();
  MeshInfo info;
  info.mesh = impl_->root().name;
  info.revision = impl_->version();
  info.vertices = record.vertices;
  info.faces = record.faces;
  info.charts = record.charts;
  info.wires = record.wires;
  info.corners = record.corners;
  info.polygons = record.polygons;
  const detail::SurfaceCounts surfaces = detail::count_surfaces(impl_->pages());
  info.components = surfaces.components;
  info.boundary_loops = surfaces.boundary_loops;
  info.nonmanifold_edges = record.nonmanifold_edges;
  info.nonmanifold_vertices = record.nonmanifold_vertices;
  info.inconsistent_edges = record.inconsistent_edges;
  info.isolated_vertices = record.isolated_vertices;
  info.degenerate_faces = record.degenerate_faces;
  info.duplicate_faces = record.duplicate_faces;
  info.lattice = record.lattice;
  info.lossless = record.exact.has_value();
  info.max_error = info.lossless ? 0 : record.lattice.step / 2;
  info.profile = record.profile == codec::Profile::fast ? "fast" : "dense";
  info.target_faces = record.target_faces;
  std::tie(info.lo, info.hi) = record.bounds(impl_->pages().box());
  for (const detail::Layer& layer : impl_->layers().layers)
    if (layer.coding != detail::LayerCoding::polygons) info.attributes.push_back({layer.info, layer.max_error()});
  info.references = impl_->layers().references;
  info.bytes = impl_->bytes();
  info.chart_faces = spread_of(chart_sizes(impl_->pages()));
  return info;
}

std::vector<ChartId> Snapshot::find(const Region& region, ReadCost* cost) const {
  return detail::find_charts(*impl_, region, cost);
}

std::vector<ChartSummary> Snapshot::describe(const std::vector<ChartId>& charts) const {
  std::vector<ChartSummary> summaries;
  const auto reader = impl_->store().reader();
  for (const ChartId id : charts) {
    const auto ref = impl_->pages().leaf_of(id);
    if (!ref) throw Error(Errc::not_found, fmt::format("there is no chart {}", id.value), impl_->root().name);
    summaries.push_back(summary_of(*impl_, *reader, *ref->leaf, *detail::find_chart(*ref->leaf, id)));
  }
  return summaries;
}

namespace {

RegionMesh load(const Snapshot::Impl& at, std::vector<ChartId> charts, unsigned threads, ReadCost* cost,
                bool with_layers) {
  std::sort(charts.begin(), charts.end());
  charts.erase(std::unique(charts.begin(), charts.end()), charts.end());
  const detail::RegionPart part{&at, std::move(charts)};
  return detail::load_region(std::span(&part, 1), threads, cost, with_layers);
}

}  // namespace

RegionMesh Snapshot::read(const std::vector<ChartId>& charts, unsigned threads, ReadCost* cost) const {
  return load(*impl_, charts, threads, cost, false);
}

RegionMesh Snapshot::read_with_attributes(const std::vector<ChartId>& charts, unsigned threads, ReadCost* cost) const {
  return load(*impl_, charts, threads, cost, true);
}

}  // namespace ramcdb
