#include <algorithm>
#include <numeric>
#include <tuple>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {

namespace {

void move_value(Attribute& attribute, std::size_t from, std::size_t to) {
  const std::size_t n = attribute.info.components;
  for (std::size_t c = 0; c < n; ++c) attribute.values[to * n + c] = attribute.values[from * n + c];
}

}  // namespace

void weld_exact(MeshData& mesh) {
  const auto key = [&](std::uint32_t v) {
    const Point& p = mesh.positions[v];
    return std::tuple(p.x + 0.0, p.y + 0.0, p.z + 0.0);  // -0 + 0 is 0
  };
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  // The first of equal vertices stands for all; those that stay keep their order.
  std::vector<std::uint32_t> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  std::vector<Attribute*> attributes;
  for (Attribute& attribute : mesh.attributes)
    if (attribute.info.of == AttributeOf::vertex) attributes.push_back(&attribute);
  std::vector<std::uint32_t> to(order.size());
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] == v) {
      mesh.positions[kept] = mesh.positions[v];
      if (!mesh.vertex_ids.empty()) mesh.vertex_ids[kept] = mesh.vertex_ids[v];
      for (Attribute* attribute : attributes) move_value(*attribute, v, kept);
      to[v] = kept++;
    } else {
      to[v] = to[first[v]];
    }
  }
  mesh.positions.resize(kept);
  if (!mesh.vertex_ids.empty()) mesh.vertex_ids.resize(kept);
  for (Attribute* attribute : attributes) attribute->values.resize(std::size_t{kept} * attribute->info.components);
  for (std::uint32_t& v : mesh.corners) v = to[v];
  mesh.soup = mesh.repeats_vertices = false;
}

}  // namespace ramcdb::mesh_file
