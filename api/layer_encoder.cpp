#include "api/layer_encoder.h"

#include <algorithm>
#include <unordered_map>

#include "codec/exact_codec.h"

namespace ramcdb::detail {
namespace {

codec::Polygons polygons_of(const LayerPlaces& places) {
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

}  // namespace

std::uint32_t turn_against(const Triangle& face, const Triangle& triangle) {
  std::uint32_t turn = 0;
  while (turn < 2 && face != Triangle{triangle[turn], triangle[(turn + 1) % 3], triangle[(turn + 2) % 3]}) ++turn;
  return turn;
}

codec::LayerValues LayerEncoder::values(const Layer& layer, const mesh_file::AttributeView& attribute,
                                        const LayerPlaces& places) {
  const std::size_t components = layer.info.components, numbers = layer.shape().components;
  const auto& source = places.of(layer.info.of);
  codec::LayerValues values;
  values.numbers.resize(source.size() * numbers);
  values.absent.resize(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    values.absent[i] = !to_numbers(layer, attribute.values.subspan(source[i] * components, components),
                                   std::span(values.numbers).subspan(i * numbers, numbers));
  return values;
}

Buffer LayerEncoder::exact(const codec::EncodedChart& encoded, const LayerPlaces& places) const {
  std::vector<Point> positions;
  for (const std::uint32_t v : places.vertices) positions.push_back(record_.rounded(exact_[v]));
  return codec::encode_exact(positions, encoded.decoded.positions, record_.lattice, *record_.exact);
}

std::vector<LayerBlob> LayerEncoder::encode(const LayerPlaces& places, const codec::EncodedChart& encoded) const {
  std::vector<LayerBlob> blobs;
  if (record_.exact) blobs.push_back({kExactLayer, exact(encoded, places)});
  if (table_.layers.empty()) return blobs;
  const codec::LayerOrder order(encoded.decoded);
  auto attribute = attributes_.begin();
  for (const Layer& layer : table_.layers) {
    if (layer.coding == LayerCoding::polygons) {
      const codec::Polygons joined = polygons_of(places);
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
