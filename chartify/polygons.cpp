#include "chartify/polygons.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace ramcdb::chartify {

void keep_polygons_whole(std::span<const std::uint32_t> polygon_of_face, Partition& partition) {
  if (polygon_of_face.empty()) return;
  std::vector<std::uint32_t> faces(polygon_of_face.size());
  std::iota(faces.begin(), faces.end(), 0U);
  const auto key = [&](std::uint32_t f) { return std::tuple(polygon_of_face[f], partition.chart_of_face[f], f); };
  std::sort(faces.begin(), faces.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0, end; i < faces.size(); i = end) {
    std::size_t best = i, most = 0;
    for (end = i; end < faces.size() && polygon_of_face[faces[end]] == polygon_of_face[faces[i]];) {
      const std::size_t begin = end;
      while (end < faces.size() && polygon_of_face[faces[end]] == polygon_of_face[faces[i]] &&
             partition.chart_of_face[faces[end]] == partition.chart_of_face[faces[begin]])
        ++end;
      if (end - begin > most) most = end - begin, best = begin;
    }
    const std::uint32_t chart = partition.chart_of_face[faces[best]];
    for (std::size_t k = i; k < end; ++k) {
      std::uint32_t& of_face = partition.chart_of_face[faces[k]];
      --partition.sizes[of_face];
      ++partition.sizes[chart];
      of_face = chart;
    }
  }
}

}  // namespace ramcdb::chartify
