#include "api/layer_source.h"

#include <algorithm>
#include <unordered_map>

#include "codec/exact_codec.h"

namespace ramcdb::detail {

/// Where the vertices, corners and faces of a coded chart stand in the file.
struct LayerSource::Places {
  std::vector<std::uint32_t> vertices, corners, faces;

  [[nodiscard]] const std::vector<std::uint32_t>& of(AttributeOf what) const {
    return what == AttributeOf::vertex ? vertices : what == AttributeOf::corner ? corners : faces;
  }
};

LayerSource::LayerSource(const mesh_file::MeshData& data, const mesh_file::Triangulation& cut,
                         const chartify::CanonicalMesh& mesh, const MeshRecord& record, const std::vector<Point>& exact,
                         bool lossless_attributes)
    : data_(data), cut_(cut), mesh_(mesh), record_(record), exact_(exact) {
  std::uint16_t id = 0;
  if (cut.polygons) {
    Layer layer;
    layer.id = ++id;
    layer.coding = LayerCoding::polygons;
    layer.info.name = "polygons";
    layer.info.of = AttributeOf::face;
    table_.layers.push_back(layer);
  }
  for (const Attribute& attribute : data.attributes)
    table_.layers.push_back(layer_for(attribute, ++id, lossless_attributes));
  table_.references = data.references;
  if (table_.layers.empty()) return;
  turns_.resize(mesh.mesh.faces.size());
  for (std::size_t f = 0; f < turns_.size(); ++f) {
    const Triangle& source = cut.corners[mesh.source_face[f]];
    const auto is_turned = [&](std::uint32_t turn) {
      for (std::uint32_t i = 0; i < 3; ++i)
        if (mesh.source_vertex[mesh.mesh.faces[f][i]] != data.corners[source[(i + turn) % 3]]) return false;
      return true;
    };
    while (turns_[f] < 2 && !is_turned(turns_[f])) ++turns_[f];
  }
}

std::vector<std::uint32_t> LayerSource::polygon_of_face() const {
  std::vector<std::uint32_t> polygons;
  if (cut_.polygons)
    for (const std::uint32_t f : mesh_.source_face) polygons.push_back(cut_.face[f]);
  return polygons;
}

LayerSource::Places LayerSource::places_in_file(const chartify::NetChart& chart,
                                                const codec::EncodedChart& encoded) const {
  Places places;
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

codec::LayerValues LayerSource::values(const Layer& layer, const Attribute& attribute, const Places& places) const {
  const std::size_t components = layer.info.components, numbers = layer.shape().components;
  const auto& source = places.of(layer.info.of);
  codec::LayerValues values;
  values.numbers.resize(source.size() * numbers);
  values.absent.resize(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    values.absent[i] = !to_numbers(layer, std::span(attribute.values).subspan(source[i] * components, components),
                                   std::span(values.numbers).subspan(i * numbers, numbers));
  return values;
}

Buffer LayerSource::exact(const codec::EncodedChart& encoded, const Places& places) const {
  std::vector<Point> positions;
  for (const std::uint32_t v : places.vertices) positions.push_back(record_.rounded(exact_[v]));
  return codec::encode_exact(positions, encoded.decoded.positions, record_.lattice, *record_.exact);
}

codec::Polygons LayerSource::polygons(const Places& places) const {
  // A polygon begins where its first face is met; its corners in the file's order.
  std::unordered_map<std::uint32_t, std::uint32_t> number, corner_at;
  for (std::uint32_t c = 0; c < places.corners.size(); ++c) corner_at.try_emplace(places.corners[c], c);
  codec::Polygons polygons;
  std::vector<std::uint32_t> file_faces;
  for (const std::uint32_t face : places.faces) {
    const auto [it, is_new] = number.try_emplace(face, static_cast<std::uint32_t>(number.size()));
    if (is_new) file_faces.push_back(face), polygons.sizes.push_back(2);
    polygons.of_face.push_back(it->second);
    ++polygons.sizes[it->second];
  }
  std::vector<std::uint32_t> least(file_faces.size(), ~std::uint32_t{0});
  for (std::size_t c = 0; c < places.corners.size(); ++c) {
    std::uint32_t& first = least[polygons.of_face[c / 3]];
    first = std::min(first, places.corners[c]);
  }
  for (std::size_t p = 0; p < least.size(); ++p)
    for (std::uint32_t i = 0; i < polygons.sizes[p]; ++i) polygons.corners.push_back(corner_at.at(least[p] + i));
  return polygons;
}

std::vector<LayerSource::Blob> LayerSource::encode(const chartify::NetChart& chart,
                                                   const codec::EncodedChart& encoded) const {
  std::vector<Blob> blobs;
  if (table_.layers.empty() && !record_.exact) return blobs;
  const Places places = places_in_file(chart, encoded);
  if (record_.exact) blobs.push_back({kExactLayer, exact(encoded, places)});
  const codec::LayerOrder order(encoded.decoded);
  auto attribute = data_.attributes.begin();
  for (const Layer& layer : table_.layers) {
    if (layer.coding == LayerCoding::polygons) {
      const codec::Polygons joined = polygons(places);
      if (joined.sizes.size() < encoded.decoded.faces.size())
        blobs.push_back({layer.id, codec::encode_polygons(joined, encoded.decoded, order)});
    } else {
      blobs.push_back(
          {layer.id, codec::encode_layer(values(layer, *attribute++, places), layer.shape(), encoded.decoded, order)});
    }
  }
  return blobs;
}

}  // namespace ramcdb::detail
