#pragma once

#include <span>
#include <utility>
#include <vector>

#include "api/layers.h"
#include "api/mesh_file/mesh_file.h"
#include "api/mesh_record.h"
#include "codec/chart_codec.h"
#include "codec/polygon_codec.h"

namespace ramcdb::detail {

/// Where the vertices, corners and faces of a coded chart stand in the mesh that has their values. Its faces are
/// polygons, whose corners follow one another; vertices, corners and faces count as in its attributes.
struct LayerPlaces {
  std::vector<std::uint32_t> vertices, corners, faces;

  [[nodiscard]] const std::vector<std::uint32_t>& of(AttributeOf what) const {
    return what == AttributeOf::vertex ? vertices : what == AttributeOf::corner ? corners : faces;
  }
};

/// How far a face's corners are turned against those of the triangle that it is: corner i is corner (i + turn) % 3.
/// Both by vertices of one numbering.
[[nodiscard]] std::uint32_t turn_against(const Triangle& face, const Triangle& triangle);

struct LayerBlob {
  std::uint16_t layer = 0;
  Buffer bytes;
};

/// Codes the layers of charts from the values of the mesh that they are cut from.
class LayerEncoder {
 public:
  /// All must outlive the encoder, and what the attributes view.
  /// \param attributes those of `table`'s layers, in their order
  /// \param exact positions of the mesh's vertices where `record` says that they are kept to the last bit; else empty
  LayerEncoder(const LayerTable& table, const MeshRecord& record, mesh_file::AttributeViews attributes,
               std::span<const Point> exact)
      : table_(table), record_(record), attributes_(std::move(attributes)), exact_(exact) {}

  [[nodiscard]] bool empty() const { return table_.layers.empty() && !record_.exact; }
  /// The layer blobs of a chart, ascending. Charts of triangles alone need none for polygons.
  [[nodiscard]] std::vector<LayerBlob> encode(const LayerPlaces& places, const codec::EncodedChart& encoded) const;

 private:
  [[nodiscard]] Buffer exact(const codec::EncodedChart& encoded, const LayerPlaces& places) const;
  [[nodiscard]] static codec::LayerValues values(const Layer& layer, const mesh_file::AttributeView& attribute,
                                                 const LayerPlaces& places);

  const LayerTable& table_;
  const MeshRecord& record_;
  mesh_file::AttributeViews attributes_;
  std::span<const Point> exact_;
};

}  // namespace ramcdb::detail
