#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "api/mesh_file/gltf_plan.h"

namespace ramcdb::mesh_file::gltf {
namespace {

/// glTF knows no corners: a vertex has one value of everything.
class Splitter {
 public:
  Splitter(const MeshOutput& mesh, const std::vector<const AttributeView*>& attributes)
      : mesh_(mesh), attributes_(attributes) {}

  Vertices run() {
    source_.resize(mesh_.positions.size());
    std::iota(source_.begin(), source_.end(), 0U);
    corner_.assign(source_.size(), kNoCorner);
    of_corner_.resize(mesh_.corners.size());
    for (std::uint32_t c = 0; c < of_corner_.size(); ++c) of_corner_[c] = vertex_for(c);
    return in_order();
  }

 private:
  /// The vertex that has the corner's values, a copy if there is none yet.
  std::uint32_t vertex_for(std::uint32_t c) {
    const std::uint32_t v = mesh_.corners[c];
    if (corner_[v] == kNoCorner) corner_[v] = c;
    if (same(corner_[v], c)) return v;
    for (std::uint64_t key = hash(v, c);; ++key) {
      const auto [known, added] = copies_.try_emplace(key, static_cast<std::uint32_t>(source_.size()));
      if (added) {
        source_.push_back(v);
        corner_.push_back(c);
      }
      if (source_[known->second] == v && same(corner_[known->second], c)) return known->second;
    }
  }

  [[nodiscard]] bool same(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    return std::all_of(attributes_.begin(), attributes_.end(), [&](const AttributeView* attribute) {
      const std::size_t n = attribute->info.components;
      const double* values = attribute->values.data();
      return std::equal(values + a * n, values + (a + 1) * n, values + b * n, [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (x != x && y != y);
      });
    });
  }

  [[nodiscard]] std::uint64_t hash(std::uint32_t v, std::uint32_t c) const {
    std::uint64_t h = v;
    const auto mix = [&](std::uint64_t word) {
      h = (h ^ word) * 0x9e3779b97f4a7c15U;
      h ^= h >> 29U;
    };
    for (const AttributeView* attribute : attributes_)
      for (std::size_t k = 0; k < attribute->info.components; ++k) {
        const double x = attribute->values[std::size_t{c} * attribute->info.components + k];
        mix(x != x ? 1 : std::bit_cast<std::uint64_t>(x));
      }
    return h;
  }

  /// Copies behind their vertices, so that what lies together stays together.
  Vertices in_order() {
    Vertices vertices;
    vertices.count = source_.size();
    std::vector<std::uint32_t> order(source_.size()), to(source_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return source_[a] < source_[b]; });
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      to[order[i]] = i;
      vertices.source.push_back(source_[order[i]]);
      vertices.corner.push_back(corner_[order[i]]);
    }
    for (std::uint32_t& v : of_corner_) v = to[v];
    vertices.of_corner = std::move(of_corner_);
    return vertices;
  }

  const MeshOutput& mesh_;
  const std::vector<const AttributeView*>& attributes_;
  std::vector<std::uint32_t> source_, corner_, of_corner_;
  std::unordered_map<std::uint64_t, std::uint32_t> copies_;  ///< looked up only
};

}  // namespace

Vertices split_vertices(const MeshOutput& mesh, const std::vector<const AttributeView*>& attributes,
                        DroppedCounter& dropped) {
  Vertices vertices;
  vertices.count = mesh.positions.size();
  if (!attributes.empty()) vertices = Splitter(mesh, attributes).run();
  dropped.add("vertices with corners that differ (written more than once)", vertices.count - mesh.positions.size());
  return vertices;
}

}  // namespace ramcdb::mesh_file::gltf
