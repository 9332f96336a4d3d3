#pragma once

#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "api/snapshot_impl.h"
#include "codec/chart_codec.h"
#include "codec/layer_codec.h"
#include "codec/polygon_codec.h"
#include "codec/wire_codec.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// A chart as it stands at a version, decoded, with the identity of every vertex.
struct LoadedChart {
  PageChart entry;
  Chart chart;
  std::vector<VertexKey> keys;  ///< per local vertex; border vertices may repeat a key
  codec::ChartCost cost;
  std::uint64_t blob_bytes = 0;            ///< checksum included
  std::vector<Point> exact;                ///< per local vertex, where the mesh keeps positions to the last bit
  std::vector<codec::LayerValues> layers;  ///< per layer of the mesh, when asked for; those of polygons are empty
  codec::Polygons polygons;                ///< when asked for and the mesh has any
  std::map<std::uint16_t, std::uint64_t> layer_bytes;  ///< of the layer blobs that were read, checksums included
};

/// A wire with its decoded points.
struct LoadedWire {
  PageWire entry;
  Wire wire;
  std::uint64_t blob_bytes = 0;  ///< its share of its blob, checksum included; 0 without inner points
};

/// Reads charts of one snapshot and, once each, the wires they pass.
class ChartLoader {
 public:
  explicit ChartLoader(const Snapshot::Impl& at) : at_(at) {}

  /// Decodes charts, in the order asked. Throws not_found for an unknown id, corrupt naming chart and version.
  [[nodiscard]] std::vector<LoadedChart> load(std::span<const ChartId> charts, unsigned threads = 1,
                                              ReadCost* cost = nullptr, bool with_layers = false);

  /// The wires read so far, with all wires that loaded charts pass among them.
  [[nodiscard]] const std::unordered_map<WireId, LoadedWire>& wires() const { return wires_; }

 private:
  struct Job;
  struct Group {
    codec::WireGroup wires;
    std::uint64_t bytes;
  };
  [[nodiscard]] const Group& group_of(const PageWire& entry, db::BlobReader& reader);
  void read_wires(const LeafPage& leaf, const PageChart& chart, db::BlobReader& reader);
  void read_layers(Job& job, db::BlobReader& reader) const;
  [[nodiscard]] LoadedChart decode(const Job& job) const;
  void decode_exact(const Job& job, LoadedChart& loaded) const;
  void decode_layers(const Job& job, LoadedChart& loaded) const;

  const Snapshot::Impl& at_;
  std::unordered_map<WireId, LoadedWire> wires_;
  std::map<std::pair<WireId, VersionId>, Group> groups_;
};

/// The border of a chart from its wires: positions and keys, loop after loop, as Chart and its decoder want them.
struct Border {
  std::vector<LatticePoint> points;
  std::vector<VertexKey> keys;
  std::vector<std::uint32_t> loop_sizes;
};
[[nodiscard]] Border border_of(const std::vector<WireLoop>& loops,
                               const std::function<const LoadedWire&(WireId)>& wire);

}  // namespace ramcdb::detail
