#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "api/change_set.h"
#include "api/layers.h"
#include "api/mesh_record.h"
#include "api/page_delta.h"
#include "codec/tables.h"
#include "db/store.h"

namespace ramcdb::detail {

/// An edit, coded on top of one version: all that a version over it writes.
struct EncodedEdit {
  struct Blob {
    db::BlobKey key;  ///< its version is that of the writer
    Buffer bytes;
  };
  std::vector<Blob> blobs;  ///< charts, layers, wires, tables
  PageDelta pages;
  /// Of the new version, but for its pages' bytes and ids. A table is the new version's where `table_version` is 0.
  MeshRecord record;
  bool new_layer_table = false;

  // For reports.
  std::vector<ChartId> changed;  ///< charts of which something is written, and those that go; ascending
  std::vector<ChartId> added;    ///< of them, new ones
  std::uint64_t charts_reencoded = 0;
  std::uint64_t wires_reencoded = 0, layers_reencoded = 0, ranges_expanded = 0;
};

/// Codes the charts and wires that an edit touches. A moved inner vertex touches its chart; a point of a wire, the wire
/// and every chart on it; a corner, all wires that end there and all charts around it, also those outside the region,
/// whose other vertices stay; the exact positions of a lossless mesh follow its charts. A changed value touches its
/// layer in the same charts, and nothing else. Charts whose connectivity changes are cut anew, between the wires that
/// other charts share with them (recut_encoder.h).
/// \param region charts of `at`, with attributes: all that the edit touches
/// \param may_recut whether a chart outside `region` may be cut anew where the edit leaves too small a one beside it
[[nodiscard]] EncodedEdit encode_edit(const Snapshot::Impl& at, RegionMesh region, EditedRegion edited,
                                      const std::function<bool(ChartId)>& may_recut, unsigned threads);

/// Codes all charts of a mesh anew with other tables, in any profile; what charts hold stays as it is. Layers are coded
/// anew where their order follows that of the chart's vertices or faces. `progress` gets the share that is done.
[[nodiscard]] EncodedEdit encode_again(const Snapshot::Impl& at, codec::Profile profile,
                                       const codec::CoderTables& tables, unsigned threads,
                                       const std::function<void(double)>& progress);

}  // namespace ramcdb::detail
