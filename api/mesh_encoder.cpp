#include "api/mesh_encoder.h"

#include <algorithm>
#include <set>

#include "api/page_index.h"
#include "api/surface_pieces.h"
#include "chartify/parallel.h"
#include "codec/dense_training.h"
#include "codec/fast_training.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {
namespace {

PageChart chart_entry(const chartify::NetChart& chart, ChartId id, const NetIds& ids, TableId table) {
  PageChart entry;
  entry.id = id;
  entry.table = table;
  entry.faces = static_cast<std::uint32_t>(chart.chart.faces.size());
  entry.inner_vertices = static_cast<std::uint32_t>(chart.chart.positions.size()) - chart.chart.border_count();
  for (const LatticePoint p : chart.chart.positions) entry.box.add(p);
  for (const auto& steps : chart.loops) {
    WireLoop& loop = entry.loops.emplace_back();
    for (const chartify::NetLoopStep step : steps) loop.push_back({ids.wires[step.wire], step.reversed});
  }
  entry.pieces = pieces_of(chart.chart);
  return entry;
}

PageWire wire_entry(const chartify::NetWire& wire, WireId id, const NetIds& ids) {
  PageWire entry;
  entry.id = entry.group = id;
  entry.begin = ids.corners[wire.begin_corner];
  entry.end = ids.corners[wire.end_corner];
  entry.inner_points = static_cast<std::uint32_t>(wire.vertices.size() - 2);
  for (const std::uint32_t chart : wire.charts) entry.charts.push_back(ids.charts[chart]);
  return entry;
}

/// Codes the wires that are new and have inner points, and tells their entries where.
std::map<WireId, Buffer> encode_paths(const chartify::IndexedMesh& mesh, const std::vector<chartify::NetWire>& paths,
                                      WireId first_new, std::vector<PageWire>& entries) {
  std::vector<Wire> wires(paths.size());
  std::vector<codec::WireOfGroup> coded;
  std::vector<std::size_t> place;
  for (std::size_t w = 0; w < paths.size(); ++w) {
    if (paths[w].vertices.size() <= 2 || entries[w].id < first_new) continue;
    for (const std::uint32_t v : paths[w].vertices) wires[w].points.push_back(mesh.positions[v]);
    coded.push_back({entries[w].id, &wires[w]});
    place.push_back(w);
  }
  std::map<WireId, Buffer> blobs;
  for (codec::CodedWireGroup& group : codec::encode_in_groups(coded)) {
    for (std::size_t i = 0; i < group.count; ++i) entries[place[group.first + i]].group = coded[group.first].id;
    blobs.emplace(coded[group.first].id, std::move(group.blob));
  }
  return blobs;
}

template <class Id>
std::vector<Id> ids_in_order(std::size_t count) {
  std::vector<Id> ids;
  for (std::uint32_t i = 0; i < count; ++i) ids.emplace_back(i + 1);
  return ids;
}

LeafPage build_leaf(const NetEntries& mesh, std::size_t first, std::size_t last, VersionId version) {
  LeafPage leaf;
  std::set<WireId> wires;
  std::set<CornerId> corners;
  for (std::size_t c = first; c < last; ++c) {
    leaf.charts.push_back(mesh.charts[c]);
    leaf.charts.back().version = version;
    for (LayerRef& layer : leaf.charts.back().layers) layer.version = version;
    for (const WireLoop& loop : mesh.charts[c].loops)
      for (const DirectedWire step : loop) wires.insert(step.wire);
  }
  for (const WireId id : wires) {
    leaf.wires.push_back(mesh.wires[id.value - 1]);
    leaf.wires.back().version = version;
    corners.insert({leaf.wires.back().begin, leaf.wires.back().end});
  }
  for (const CornerId id : corners) leaf.corners.push_back(mesh.corners[id.value - 1]);
  return leaf;
}

}  // namespace

std::size_t training_step(std::uint64_t vertices) {
  constexpr std::uint64_t kMostVertices = 100'000;
  return vertices / kMostVertices + 1;
}

codec::CoderTables train_tables(const chartify::WireNet& net, codec::Profile profile, std::uint64_t vertices) {
  std::vector<const Chart*> sample;
  for (std::size_t c = 0; c < net.charts.size(); c += training_step(vertices)) sample.push_back(&net.charts[c].chart);
  return train_tables(sample, profile, vertices);
}

codec::CoderTables train_tables(std::span<const Chart* const> sample, codec::Profile profile, std::uint64_t vertices) {
  if (profile == codec::Profile::dense) return codec::train_dense(sample, vertices);
  codec::CoderTables tables;
  codec::FastTrainer trainer(tables.fast);
  for (const Chart* chart : sample) trainer.add(*chart);
  tables.fast = trainer.learn();
  return tables;
}

EncodedMesh encode_mesh(const chartify::IndexedMesh& mesh, const chartify::WireNet& net, const LayerSource& layers,
                        const MeshRecord& record, const codec::CoderTables& tables, unsigned threads,
                        const std::function<void(double)>& progress) {
  const NetIds ids{ids_in_order<ChartId>(net.charts.size()), ids_in_order<WireId>(net.wires.size()),
                   ids_in_order<CornerId>(net.corners.size())};
  const auto encode_layers = [&](const chartify::NetChart& chart, const codec::EncodedChart& encoded) {
    return layers.encode(chart, encoded);
  };
  EncodedMesh out = encode_part(mesh, net, ids, encode_layers, record, tables, threads, progress);
  if (record.table) out.tables = codec::encode_tables(tables);
  return out;
}

EncodedMesh encode_part(const chartify::IndexedMesh& mesh, const chartify::WireNet& net, const NetIds& ids,
                        const EncodeLayers& layers, const MeshRecord& record, const codec::CoderTables& tables,
                        unsigned threads, const std::function<void(double)>& progress) {
  EncodedMesh out;
  out.charts.resize(net.charts.size());
  out.entries.charts.resize(net.charts.size());
  out.layers.resize(net.charts.size());
  std::vector<codec::ChartCost> costs(net.charts.size());
  parallel_for(
      net.charts.size(), threads,
      [&](std::size_t c) {
        auto encoded = codec::encode_chart(net.charts[c].chart, record.profile, tables, record.range);
        out.layers[c] = layers(net.charts[c], encoded);
        out.charts[c] = std::move(encoded.blob);
        costs[c] = encoded.cost;
        out.entries.charts[c] = chart_entry(net.charts[c], ids.charts[c], ids, record.table);
        for (const LayerBlob& blob : out.layers[c]) out.entries.charts[c].layers.push_back({blob.layer, {}});
      },
      progress);
  for (const codec::ChartCost& cost : costs) {
    out.cost.header += cost.header;
    out.cost.connectivity += cost.connectivity;
    out.cost.geometry += cost.geometry;
  }
  for (std::size_t w = 0; w < net.wires.size(); ++w)
    out.entries.wires.push_back(wire_entry(net.wires[w], ids.wires[w], ids));
  out.wires = encode_paths(mesh, net.wires, ids.first_wire, out.entries.wires);
  for (std::size_t k = 0; k < net.corners.size(); ++k)
    out.entries.corners.push_back({ids.corners[k], mesh.positions[net.corners[k]]});
  return out;
}

std::vector<Page> build_pages(const NetEntries& mesh, VersionId version) {
  std::vector<Page> pages;
  for (std::size_t c = 0; c < mesh.charts.size(); c += kLeafCharts)
    pages.emplace_back(build_leaf(mesh, c, std::min(c + kLeafCharts, mesh.charts.size()), version));
  for (std::size_t level = 0; pages.size() - level > 1;) {
    const std::size_t level_end = pages.size();
    for (std::size_t first = level; first < level_end; first += kInnerPages) {
      InnerPage inner;
      for (std::size_t p = first; p < std::min(first + kInnerPages, level_end); ++p)
        inner.pages.push_back(entry_for(pages[p], PageId(static_cast<std::uint32_t>(p + 1)), version));
      pages.emplace_back(std::move(inner));
    }
    level = level_end;
  }
  return pages;
}

}  // namespace ramcdb::detail
