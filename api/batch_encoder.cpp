#include "api/batch_encoder.h"

#include <algorithm>
#include <optional>

#include "api/layer_encoder.h"
#include "api/new_mesh.h"
#include "chartify/parallel.h"
#include "chartify/wire_net_builder.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

class BatchEncoder {
 public:
  BatchEncoder(const BatchedCharts& charts, const codec::CoderTables& tables, MeshRecord& record, BlobSpool& blobs,
               const LargeWork& work)
      : charts_(charts),
        tables_(tables),
        record_(record),
        blobs_(blobs),
        work_(work),
        wire_of_seam_(charts.seams.net.wires.size()),
        corner_of_shared_(charts.seams.net.corners.size()) {
    if (!charts.layers.empty()) triangles_.emplace(charts.mesh.faces().view());
  }

  NetEntries run() {
    parallel_in_order(
        charts_.batches.size(), charts_.at_a_time, work_.threads, [&](std::size_t b) { return prepare(b); },
        [&](std::size_t, const Prepared& prepared) { encode(prepared); }, [&](double) { report(0); });
    return std::move(entries_);
  }

 private:
  struct Prepared {
    ChartBatch batch;
    chartify::PartSeams seams;
    chartify::WireNet net;
  };

  [[nodiscard]] Prepared prepare(std::size_t b) const {
    ChartBatch batch = load_charts(charts_.spool, charts_.batches[b], charts_.mesh, record_.lattice);
    const auto shared = charts_.seams.shared_in(batch);
    auto seams =
        chartify::seams_of({batch.mesh, batch.charts, batch.number, shared}, charts_.seams.net, charts_.seams.wires[b]);
    auto net = chartify::build_wire_net(batch.mesh, batch.charts, seams.wires, seams.corners);
    return {std::move(batch), std::move(seams), std::move(net)};
  }

  [[nodiscard]] std::vector<Attribute> values_of_vertices(const ChartBatch& batch) const {
    std::vector<Attribute> attributes;
    for (const SpooledAttribute& spooled : charts_.mesh.attributes) {
      const mesh_file::AttributeView view = spooled.view();
      if (view.info.of != AttributeOf::vertex) continue;
      Attribute& attribute = attributes.emplace_back(Attribute{view.info, {}});
      const std::size_t components = view.info.components;
      for (const std::uint32_t v : batch.number) {
        const auto value = view.values.subspan(v * components, components);
        attribute.values.insert(attribute.values.end(), value.begin(), value.end());
      }
    }
    return attributes;
  }

  /// Those of vertices count as in the batch, all others as in the file.
  [[nodiscard]] mesh_file::AttributeViews attributes_with(const std::vector<Attribute>& of_vertices) const {
    mesh_file::AttributeViews views;
    auto of_vertex = of_vertices.begin();
    for (const SpooledAttribute& attribute : charts_.mesh.attributes) {
      if (attribute.info().of == AttributeOf::vertex)
        views.emplace_back(*of_vertex++);
      else
        views.push_back(attribute.view());
    }
    return views;
  }

  [[nodiscard]] LayerPlaces places_of(const ChartBatch& batch, const chartify::NetChart& chart,
                                      const codec::EncodedChart& encoded) const {
    LayerPlaces places;
    for (const std::uint32_t v : encoded.source_vertex) places.vertices.push_back(chart.mesh_vertex[v]);
    for (const std::uint32_t corner : encoded.source_corner) {
      if (!triangles_) break;  // nothing but exact positions
      const std::uint32_t face = chart.mesh_face[corner / 3];
      const TriangleSource source = charts_.mesh.source(batch.face[face]);
      const auto [a, b, c] = batch.mesh.faces[face];
      const std::uint32_t turn = turn_against({batch.number[a], batch.number[b], batch.number[c]},
                                              triangles_->as<Triangle>()[batch.face[face]]);
      places.faces.push_back(source.face);
      for (std::uint32_t i = 0; i < 3; ++i) places.corners.push_back(source.corners[(corner + i + turn) % 3]);
    }
    return places;
  }

  /// \param done of the batch that is encoded
  void report(double done) const {
    work_.report("encode", (static_cast<double>(encoded_) + done) / static_cast<double>(charts_.batches.size()));
  }

  void encode(const Prepared& prepared) {
    const ChartBatch& batch = prepared.batch;
    const chartify::WireNet& net = prepared.net;
    const NetIds ids = ids_for(batch, net, prepared.seams);
    std::vector<Point> exact;
    if (record_.exact)
      for (const std::uint32_t v : batch.number) exact.push_back(charts_.mesh.points.at(v));
    const std::vector<Attribute> of_vertices = values_of_vertices(batch);
    const LayerEncoder layers(charts_.layers, record_, attributes_with(of_vertices), exact);
    const auto encode_layers = [&](const chartify::NetChart& chart, const codec::EncodedChart& encoded) {
      return layers.empty() ? std::vector<LayerBlob>() : layers.encode(places_of(batch, chart, encoded), encoded);
    };
    const EncodedMesh encoded =
        encode_part(batch.mesh, net, ids, encode_layers, record_, tables_, work_.threads, [&](double d) { report(d); });
    keep(encoded, ids);
    ++encoded_;
  }

  /// Ids of what earlier batches had already, and new ones.
  [[nodiscard]] NetIds ids_for(const ChartBatch& batch, const chartify::WireNet& net,
                               const chartify::PartSeams& seams) {
    NetIds ids;
    ids.first_wire = WireId(next_wire_);
    for (std::size_t c = 0; c < net.charts.size(); ++c) ids.charts.emplace_back(next_chart_++);
    for (std::size_t w = 0; w < net.wires.size(); ++w) {
      const std::uint32_t fixed = net.origin[w].fixed;
      if (fixed == chartify::kNone) {
        ids.wires.emplace_back(next_wire_++);
        continue;
      }
      if (net.wires[w].vertices.size() != seams.wires[fixed].vertices.size())
        throw Error(Errc::corrupt, "a wire between two parts of the mesh was cut in one of them", {},
                    "this is an error of the program: import with a larger --memory, and report it");
      WireId& id = wire_of_seam_[seams.wire[fixed]];
      if (!id) id = WireId(next_wire_++);
      ids.wires.push_back(id);
    }
    for (const std::uint32_t v : net.corners) {
      const auto& known = charts_.seams.net.corners;
      const auto at = std::lower_bound(known.begin(), known.end(), batch.number[v]);
      if (at == known.end() || *at != batch.number[v]) {
        ids.corners.emplace_back(next_corner_++);
        continue;
      }
      CornerId& id = corner_of_shared_[static_cast<std::size_t>(at - known.begin())];
      if (!id) id = CornerId(next_corner_++);
      ids.corners.push_back(id);
    }
    return ids;
  }

  void keep(const EncodedMesh& encoded, const NetIds& ids) {
    for (std::size_t c = 0; c < encoded.charts.size(); ++c) {
      blobs_.add(db::Kind::chart, ids.charts[c].value, 0, encoded.charts[c]);
      for (const LayerBlob& layer : encoded.layers[c])
        blobs_.add(db::Kind::attribute, ids.charts[c].value, layer.layer, layer.bytes);
    }
    for (const auto& [first, group] : encoded.wires) blobs_.add(db::Kind::wire, first.value, 0, group);
    note_blobs(record_, encoded);
    entries_.charts.insert(entries_.charts.end(), encoded.entries.charts.begin(), encoded.entries.charts.end());
    for (const PageWire& wire : encoded.entries.wires) {
      if (wire.id < ids.first_wire) {
        auto& known = entries_.wires[wire.id.value - 1].charts;
        known.insert(known.end(), wire.charts.begin(), wire.charts.end());
      } else {
        entries_.wires.push_back(wire);
      }
    }
    for (const PageCorner& corner : encoded.entries.corners)
      if (corner.id.value > entries_.corners.size()) entries_.corners.push_back(corner);
  }

  const BatchedCharts& charts_;
  const codec::CoderTables& tables_;
  MeshRecord& record_;
  BlobSpool& blobs_;
  const LargeWork& work_;
  std::optional<ScratchView> triangles_;    ///< of the mesh, where there are layers
  std::vector<WireId> wire_of_seam_;        ///< 0: no batch had it yet
  std::vector<CornerId> corner_of_shared_;  ///< of the net's corners, likewise
  std::size_t encoded_ = 0;                 ///< batches
  std::uint32_t next_chart_ = 1, next_wire_ = 1, next_corner_ = 1;
  NetEntries entries_;
};

}  // namespace

void BlobSpool::put_all(db::Writer& writer, MeshId mesh, const LargeWork& work) const {
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (i % 64 == 0) work.report("store", static_cast<double>(i) / static_cast<double>(entries_.size()));
    writer.put({entry.kind, mesh, entry.id, {}, entry.layer}, file_.read(entry.begin, entry.size));
    if ((held += entry.size) < work.memory / 16) continue;
    writer.flush();
    held = 0;
  }
}

codec::CoderTables train_tables(const BatchedCharts& charts, const MeshRecord& record) {
  std::vector<std::size_t> which;
  for (std::size_t c = 0; c < charts.spool.count(); c += training_step(record.vertices)) which.push_back(c);
  const ChartBatch sample = load_charts(charts.spool, which, charts.mesh, record.lattice);
  const chartify::WireNet net = chartify::build_wire_net(sample.mesh, sample.charts);
  std::vector<const Chart*> samples;
  for (const chartify::NetChart& chart : net.charts) samples.push_back(&chart.chart);
  return train_tables(samples, record.profile, record.vertices);
}

NetEntries encode_batches(const BatchedCharts& charts, const codec::CoderTables& tables, MeshRecord& record,
                          BlobSpool& blobs, const LargeWork& work) {
  return BatchEncoder(charts, tables, record, blobs, work).run();
}

}  // namespace ramcdb::detail
