#pragma once

#include <cstdint>
#include <string_view>

#include "codec/chart_codec.h"
#include "ramcdb/bytes.h"
#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

namespace ramcdb::detail {

/// What a version knows of a mesh beside its pages: how it is coded, which ids come next, and running totals, so that
/// `info` need not decode a chart. Stored as one small blob per version that changed the mesh.
struct MeshRecord {
  Lattice lattice;
  std::uint32_t target_faces = 5000;
  codec::Profile profile = codec::Profile::dense;
  LatticeBox range;  ///< the shared quantization range of all charts: fixed at import
  TableId table;     ///< coder tables of newly coded charts; 0: the built-in ones

  ChartId next_chart{1};
  WireId next_wire{1};
  CornerId next_corner{1};
  PageId next_page{1};
  TableId next_table{1};
  VersionId layers;  ///< the version that wrote the layer table; 0: the mesh has no layers

  std::uint64_t vertices = 0, faces = 0, charts = 0, wires = 0, corners = 0;
  std::uint64_t components = 0, boundary_loops = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0;
  std::uint64_t isolated_vertices = 0, degenerate_faces = 0, duplicate_faces = 0, inconsistent_edges = 0;

  codec::ChartCost chart_cost;    ///< of all charts, in 1/256 bit, without checksums
  std::uint64_t page_bytes = 0;   ///< of all pages, checksums included
  std::uint64_t wire_bytes = 0;   ///< of all wire blobs, checksums included
  std::uint64_t table_bytes = 0;  ///< of all coder tables and the layer table, checksums included
  std::uint64_t layer_bytes = 0;  ///< of all layer blobs, checksums included
  std::uint64_t polygons = 0;     ///< faces of the file with more than three corners
};

/// As CBOR with short keys.
[[nodiscard]] Buffer encode_record(const MeshRecord& record);
/// Throws corrupt, naming `where`.
[[nodiscard]] MeshRecord decode_record(Bytes blob, std::string_view where);

}  // namespace ramcdb::detail
