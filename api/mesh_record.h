#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "codec/chart_codec.h"
#include "ramcdb/attributes.h"
#include "ramcdb/bytes.h"
#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

namespace ramcdb::detail {

/// The layer of a chart that says which positions its lattice points stand for, when these are kept to the last bit
/// (codec/exact_codec.h). Not one of the layer table.
inline constexpr std::uint16_t kExactLayer = 0;

/// What a version knows of a mesh beside its pages: how it is coded, which ids come next, and running totals, so that
/// `info` need not decode a chart. Stored as one small blob per version that changed the mesh.
struct MeshRecord {
  Lattice lattice;
  std::uint32_t target_faces = 5000;
  codec::Profile profile = codec::Profile::dense;
  LatticeBox range;  ///< the shared quantization range of all charts: fixed at import
  /// float32 or float64: positions are kept to the last bit as numbers of this type, in layer kExactLayer of each
  /// chart.
  std::optional<NumberType> exact;
  /// The numbers that a whole mesh is written with again: float64 where that brings back the numbers of its file, and
  /// float32 would not.
  NumberType written_as = NumberType::float32;
  TableId table;            ///< coder tables of all charts that do not name the built-in ones, 0
  VersionId table_version;  ///< that wrote it; 0 without

  ChartId next_chart{1};
  WireId next_wire{1};
  CornerId next_corner{1};
  PageId next_page{1};
  TableId next_table{1};
  VersionId layers;  ///< the version that wrote the layer table; 0: the mesh has no layers

  std::uint64_t vertices = 0, faces = 0, charts = 0, wires = 0, corners = 0;
  std::uint64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
  std::uint64_t isolated_vertices = 0, degenerate_faces = 0, duplicate_faces = 0, inconsistent_edges = 0;

  codec::ChartCost chart_cost;    ///< of all charts, in 1/256 bit, without checksums
  std::uint64_t page_bytes = 0;   ///< of all pages, checksums included
  std::uint64_t wire_bytes = 0;   ///< of all wire blobs, checksums included
  std::uint64_t table_bytes = 0;  ///< of all coder tables and the layer table, checksums included
  std::uint64_t layer_bytes = 0;  ///< of all layer blobs but exact positions, checksums included
  std::uint64_t exact_bytes = 0;  ///< of all exact positions, checksums included
  std::uint64_t polygons = 0;     ///< faces of the file with more than three corners

  /// The position that the mesh keeps of one that a file or a program gives; the lattice then has its place.
  [[nodiscard]] Point rounded(const Point& p) const;
  /// The least box that surely holds all positions of a lattice box, model units: it is exact unless positions are kept
  /// to the last bit, which may lie half a step outside.
  [[nodiscard]] std::pair<Point, Point> bounds(const LatticeBox& box) const;
  friend bool operator==(const MeshRecord&, const MeshRecord&) = default;

  /// The counter of a layer's bytes.
  [[nodiscard]] std::uint64_t& bytes_of_layer(std::uint16_t layer) {
    return layer == kExactLayer ? exact_bytes : layer_bytes;
  }
};

/// As bytes; api/mesh_record.cpp has the grammar.
[[nodiscard]] Buffer encode_record(const MeshRecord& record);
/// Throws corrupt, naming `where`.
[[nodiscard]] MeshRecord decode_record(Bytes blob, std::string_view where);

}  // namespace ramcdb::detail
