#pragma once

#include <vector>

#include "api/layer_encoder.h"
#include "api/layers.h"
#include "api/mesh_file/mesh_file.h"
#include "api/mesh_record.h"
#include "chartify/wire_net_builder.h"
#include "codec/chart_codec.h"

namespace ramcdb::detail {

/// The layers of a mesh that is imported: what its file has, taken apart chart by chart.
class LayerSource {
 public:
  /// All must outlive the source. `mesh` is the canonical form of `cut`'s triangles. `exact` are the positions of the
  /// file's vertices where `record` says that they are kept to the last bit; else empty.
  LayerSource(const mesh_file::MeshData& data, const mesh_file::Triangulation& cut, const chartify::CanonicalMesh& mesh,
              const MeshRecord& record, const std::vector<Point>& exact, bool lossless_attributes);

  [[nodiscard]] const LayerTable& table() const { return table_; }
  /// Per canonical face the file's face that it was cut from; empty when all of them are triangles.
  [[nodiscard]] std::vector<std::uint32_t> polygon_of_face() const;

  /// The layer blobs of a chart, ascending. Charts of triangles alone need none for polygons.
  [[nodiscard]] std::vector<LayerBlob> encode(const chartify::NetChart& chart,
                                              const codec::EncodedChart& encoded) const;

 private:
  [[nodiscard]] LayerPlaces places_in_file(const chartify::NetChart& chart, const codec::EncodedChart& encoded) const;

  const mesh_file::MeshData& data_;
  const mesh_file::Triangulation& cut_;
  const chartify::CanonicalMesh& mesh_;
  std::vector<std::uint8_t> turns_;  ///< canonical corner i of a face is corner (i + turn) % 3 of its triangle
  LayerTable table_;
  LayerEncoder encoder_;
};

}  // namespace ramcdb::detail
