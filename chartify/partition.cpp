#include "chartify/partition.h"

#include "chartify/half_edge_twins.h"

namespace ramcdb::chartify {

Neighbours find_neighbours(const IndexedMesh& mesh) {
  Neighbours neighbours = find_twins(mesh, group_half_edges(mesh));
  for (std::uint32_t& n : neighbours)
    if (n != kNoTwin) n = face_of(n);
  return neighbours;
}

Components find_components(const Neighbours& neighbours) {
  Components out;
  const std::size_t faces = neighbours.size() / 3;
  out.component_of_face.assign(faces, kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t seed = 0; seed < faces; ++seed) {
    if (out.component_of_face[seed] != kNone) continue;
    const auto component = static_cast<std::uint32_t>(out.sizes.size());
    out.sizes.push_back(0);
    out.component_of_face[seed] = component;
    for (open.assign(1, seed); !open.empty();) {
      const std::uint32_t f = open.back();
      open.pop_back();
      ++out.sizes[component];
      for (std::size_t e = 3 * std::size_t{f}; e < 3 * std::size_t{f} + 3; ++e) {
        const std::uint32_t g = neighbours[e];
        if (g == kNone || out.component_of_face[g] != kNone) continue;
        out.component_of_face[g] = component;
        open.push_back(g);
      }
    }
  }
  return out;
}

void renumber(Partition& partition) {
  std::vector<std::uint32_t> to(partition.sizes.size(), kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t& chart : partition.chart_of_face) {
    if (chart == kNone) continue;
    if (to[chart] == kNone) {
      to[chart] = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    }
    chart = to[chart];
    ++sizes[chart];
  }
  partition.sizes = std::move(sizes);
}

}  // namespace ramcdb::chartify
