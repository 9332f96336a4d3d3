#pragma once

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "api/layer_source.h"
#include "api/mesh_record.h"
#include "chartify/wire_net_builder.h"
#include "codec/tables.h"
#include "ramcdb/wire_net.h"

namespace ramcdb::detail {

/// What the pages of a new mesh say. Ids are positions + 1. Versions are left 0: they are known once the writer is.
struct NetEntries {
  std::vector<PageChart> charts;
  std::vector<PageWire> wires;
  std::vector<PageCorner> corners;
};

/// All blobs of a new mesh but its pages, with the ids that they get: position in the wire-net + 1.
struct EncodedMesh {
  std::vector<Buffer> charts;
  std::map<WireId, Buffer> wires;              ///< groups, by their first wire
  std::vector<std::vector<LayerBlob>> layers;  ///< per chart
  NetEntries entries;
  Buffer tables;  ///< empty: the built-in ones
  codec::ChartCost cost;
};

/// The ids that the charts, wires and corners of a wire-net get.
struct NetIds {
  std::vector<ChartId> charts;
  std::vector<WireId> wires;
  std::vector<CornerId> corners;
  WireId first_wire{1};  ///< those below it are coded already
};

/// The layer blobs of a chart.
using EncodeLayers =
    std::function<std::vector<LayerBlob>(const chartify::NetChart& chart, const codec::EncodedChart& encoded)>;

/// Of a mesh with so many vertices, every n-th chart is enough to train coder tables on.
[[nodiscard]] std::size_t training_step(std::uint64_t vertices);
/// Coder tables of a profile that suit a mesh of so many vertices, from a sample of its charts.
[[nodiscard]] codec::CoderTables train_tables(std::span<const Chart* const> sample, codec::Profile profile,
                                              std::uint64_t vertices);
[[nodiscard]] codec::CoderTables train_tables(const chartify::WireNet& net, codec::Profile profile,
                                              std::uint64_t vertices);

/// Codes every chart with its layers, and every wire.
[[nodiscard]] EncodedMesh encode_mesh(const chartify::IndexedMesh& mesh, const chartify::WireNet& net,
                                      const LayerSource& layers, const MeshRecord& record,
                                      const codec::CoderTables& tables, unsigned threads,
                                      const std::function<void(double)>& progress);

/// The same for a part of a mesh, under the ids that its parts have in the whole. Entries come in the part's order, and
/// know of charts in the part only. REQUIRES: new wires' ids ascend
[[nodiscard]] EncodedMesh encode_part(const chartify::IndexedMesh& mesh, const chartify::WireNet& net,
                                      const NetIds& ids, const EncodeLayers& layers, const MeshRecord& record,
                                      const codec::CoderTables& tables, unsigned threads,
                                      const std::function<void(double)>& progress);

/// The pages of a new mesh, from the leaves up to the root, which is the last. Their ids are positions + 1.
[[nodiscard]] std::vector<Page> build_pages(const NetEntries& mesh, VersionId version);

}  // namespace ramcdb::detail
