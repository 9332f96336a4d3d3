#include "api/layer_source.h"

namespace ramcdb::detail {

LayerSource::LayerSource(const mesh_file::MeshData& data, const mesh_file::Triangulation& cut,
                         const chartify::CanonicalMesh& mesh, const MeshRecord& record, const std::vector<Point>& exact,
                         bool lossless_attributes)
    : data_(data), cut_(cut), mesh_(mesh), encoder_(table_, record, data.attributes, exact) {
  std::uint16_t id = 0;
  if (cut.polygons) table_.layers.push_back(polygon_layer(++id));
  for (const Attribute& attribute : data.attributes)
    table_.layers.push_back(layer_for(attribute, ++id, lossless_attributes));
  table_.references = data.references;
  if (table_.layers.empty()) return;
  turns_.resize(mesh.mesh.faces.size());
  for (std::size_t f = 0; f < turns_.size(); ++f) {
    const Triangle &face = mesh.mesh.faces[f], &source = cut.corners[mesh.source_face[f]];
    const auto in_file = [&](std::size_t i) { return mesh.source_vertex[face[i]]; };
    const auto vertex = [&](std::size_t i) { return data.corners[source[i]]; };
    turns_[f] = static_cast<std::uint8_t>(
        turn_against({in_file(0), in_file(1), in_file(2)}, {vertex(0), vertex(1), vertex(2)}));
  }
}

std::vector<std::uint32_t> LayerSource::polygon_of_face() const {
  std::vector<std::uint32_t> polygons;
  if (cut_.polygons)
    for (const std::uint32_t f : mesh_.source_face) polygons.push_back(cut_.face[f]);
  return polygons;
}

LayerPlaces LayerSource::places_in_file(const chartify::NetChart& chart, const codec::EncodedChart& encoded) const {
  LayerPlaces places;
  for (const std::uint32_t v : encoded.source_vertex)
    places.vertices.push_back(mesh_.source_vertex[chart.mesh_vertex[v]]);
  for (const std::uint32_t corner : encoded.source_corner) {
    const std::uint32_t face = chart.mesh_face[corner / 3], triangle = mesh_.source_face[face];
    places.faces.push_back(cut_.face[triangle]);
    for (std::uint32_t i = 0; i < 3 && !turns_.empty(); ++i)
      places.corners.push_back(cut_.corners[triangle][(corner + i + turns_[face]) % 3]);
  }
  return places;
}

std::vector<LayerBlob> LayerSource::encode(const chartify::NetChart& chart, const codec::EncodedChart& encoded) const {
  if (encoder_.empty()) return {};
  return encoder_.encode(places_in_file(chart, encoded), encoded);
}

}  // namespace ramcdb::detail
