#include "codec/polygon_codec.h"
#include "tests/fuzz/coder_input.h"

/// Polygons that are decoded are made of the chart's faces, each in one of them, and come back from their own blob.
namespace ramcdb::fuzz {
namespace {

void require_polygons(const codec::Polygons& polygons, const Chart& chart) {
  require(polygons.of_face.size() == chart.faces.size(), "not a polygon per face");
  std::vector<std::uint32_t> faces(polygons.sizes.size());
  for (const std::uint32_t p : polygons.of_face) {
    require(p < faces.size(), "a face of a polygon that is none");
    ++faces[p];
  }
  std::size_t corners = 0;
  for (std::size_t p = 0; p < faces.size(); ++p) {
    require(polygons.sizes[p] == faces[p] + 2 && faces[p] > 0, "a polygon of another size than its faces");
    corners += polygons.sizes[p];
  }
  require(polygons.corners.size() == corners, "another number of corners");
  for (const std::uint32_t c : polygons.corners) require(c < 3 * chart.faces.size(), "a corner that is none");
}

/// All triangles, or pairs over shared edges where neighbours are still free.
codec::Polygons polygons_of(const Chart& chart, const codec::LayerOrder& order, bool pairs) {
  codec::Polygons polygons;
  polygons.of_face.assign(chart.faces.size(), codec::LayerOrder::kNone);
  for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
    if (polygons.of_face[f] != codec::LayerOrder::kNone) continue;
    const auto polygon = static_cast<std::uint32_t>(polygons.sizes.size());
    polygons.of_face[f] = polygon;
    std::vector<std::uint32_t> around{3 * f, 3 * f + 1, 3 * f + 2};
    if (const std::uint32_t twin = order.twin(3 * f);
        pairs && twin != codec::LayerOrder::kNone && polygons.of_face[twin / 3] == codec::LayerOrder::kNone) {
      polygons.of_face[twin / 3] = polygon;
      around.insert(around.begin() + 1, codec::LayerOrder::prev(twin));
    }
    polygons.sizes.push_back(static_cast<std::uint32_t>(around.size()));
    polygons.corners.insert(polygons.corners.end(), around.begin(), around.end());
  }
  return polygons;
}

const codec::LayerOrder& order_of(const Chart& chart) {
  static const std::vector<codec::LayerOrder> all(charts().begin(), charts().end());
  return all[static_cast<std::size_t>(&chart - charts().data())];
}

}  // namespace

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (std::size_t number = 0; number < charts().size(); ++number)
    for (const bool pairs : {false, true}) {
      const Chart& chart = charts()[number];
      all.push_back(CoderSeed().byte(number).named(
          (pairs ? "pairs-" : "triangles-") + std::to_string(number),
          codec::encode_polygons(polygons_of(chart, order_of(chart), pairs), chart, order_of(chart))));
    }
  return all;
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  fuzz::CoderInput input(data, size);
  const Chart& chart = fuzz::chart_of(input.byte());
  const codec::LayerOrder& order = fuzz::order_of(chart);
  codec::Polygons polygons;
  if (fuzz::refuses([&] { polygons = codec::decode_polygons(input.blob(), chart, order); })) return 0;
  fuzz::require_polygons(polygons, chart);
  const auto again = codec::decode_polygons(codec::encode_polygons(polygons, chart, order), chart, order);
  fuzz::require(again.of_face == polygons.of_face && again.sizes == polygons.sizes, "other polygons come back");
  return 0;
}
