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

/// All blobs of a new mesh but its pages, with the ids that they get: position in the wire-net + 1.
struct EncodedMesh {
  std::vector<Buffer> charts;
  std::map<WireId, Buffer> wires;              ///< groups, by their first wire
  std::vector<std::vector<LayerBlob>> layers;  ///< per chart
  std::vector<PageChart> chart_entries;
  std::vector<PageWire> wire_entries;
  std::vector<PageCorner> corner_entries;
  Buffer tables;  ///< empty: the built-in ones
  codec::ChartCost cost;
};

/// Of a mesh with so many vertices, every n-th chart is enough to train coder tables on.
[[nodiscard]] std::size_t training_step(std::uint64_t vertices);
/// Coder tables of a profile that suit a mesh of so many vertices, from a sample of its charts.
[[nodiscard]] codec::CoderTables train_tables(std::span<const Chart* const> sample, codec::Profile profile,
                                              std::uint64_t vertices);
[[nodiscard]] codec::CoderTables train_tables(const chartify::WireNet& net, codec::Profile profile,
                                              std::uint64_t vertices);

/// Codes every chart with its layers, and every wire. Versions in the entries are left 0: they are known once the
/// writer is.
[[nodiscard]] EncodedMesh encode_mesh(const chartify::IndexedMesh& mesh, const chartify::WireNet& net,
                                      const LayerSource& layers, const MeshRecord& record,
                                      const codec::CoderTables& tables, unsigned threads,
                                      const std::function<void(double)>& progress);

/// The pages of a new mesh, from the leaves up to the root, which is the last. Their ids are positions + 1.
[[nodiscard]] std::vector<Page> build_pages(const EncodedMesh& mesh, VersionId version);

}  // namespace ramcdb::detail
