#include <algorithm>
#include <map>
#include <numeric>

#include "api/mesh_file/gltf_plan.h"
#include "api/mesh_file/triangulate.h"

namespace ramcdb::mesh_file::gltf {
namespace {

/// The number behind the last name stands for none.
std::size_t number_of(const AttributeView* attribute, std::size_t face) {
  if (!attribute) return 0;
  const double value = attribute->values[face];
  return value >= 0 ? static_cast<std::size_t>(value) : attribute->info.names.size();
}

class Grouper {
 public:
  Grouper(const MeshOutput& mesh, const Vertices& vertices, const AttributeView* objects,
          const AttributeView* materials)
      : corners_(vertices.of_corner.empty() ? mesh.corners : std::span<const std::uint32_t>(vertices.of_corner)),
        vertex_count_(vertices.count),
        object_(objects),
        material_(materials) {}

  /// Puts triangle t, of face(t), with positions in the list of corners corner(t, 0..2).
  template <class Face, class Corner>
  Groups run(std::size_t triangles, Face face, Corner corner) {
    std::vector<std::uint32_t> part_of(triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      part_of[t] = part(number_of(object_, face(t)), number_of(material_, face(t)));
      ++counts_[part_of[t]];
    }
    order_parts();
    std::vector<std::size_t> next = firsts_;
    groups_.triangles.resize(3 * triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      std::uint32_t* to = groups_.triangles.data() + 3 * next[part_of[t]]++;
      for (std::size_t k = 0; k < 3; ++k) to[k] = corners_[corner(t, k)];
    }
    give_vertices();
    return std::move(groups_);
  }

 private:
  /// Numbers pairs as they come.
  std::uint32_t part(std::size_t object, std::size_t material) {
    if (!keys_.empty() && keys_[last_] == std::pair(object, material)) return last_;
    const auto [known, added] = part_of_.try_emplace({object, material}, static_cast<std::uint32_t>(keys_.size()));
    if (added) {
      keys_.emplace_back(object, material);
      counts_.push_back(0);
    }
    return last_ = known->second;
  }

  /// Objects in order of their numbers, in each the materials as they came.
  void order_parts() {
    std::vector<std::uint32_t> order(keys_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return keys_[a].first < keys_[b].first; });
    const std::vector<std::size_t> material_numbers = number_materials();
    firsts_.resize(keys_.size());
    std::size_t first = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto [object, material] = keys_[order[i]];
      if (i == 0 || keys_[order[i - 1]].first != object) {
        groups_.objects.emplace_back();
        if (object_ && object < object_->info.names.size()) groups_.objects.back().name = object_->info.names[object];
      }
      Part part{std::nullopt, first, counts_[order[i]]};
      const bool named = material < material_numbers.size() && !material_->info.names[material].empty();
      if (named) part.material = material_numbers[material];
      groups_.objects.back().parts.push_back(part);
      firsts_[order[i]] = first;
      first += part.count;
    }
  }

  /// Materials that faces have, in order of their numbers. OBJ calls those "" that have none.
  std::vector<std::size_t> number_materials() {
    if (!material_) return {};
    std::vector<bool> used(material_->info.names.size());
    for (const auto& [object, material] : keys_)
      if (material < used.size()) used[material] = true;
    std::vector<std::size_t> numbers(used.size());
    for (std::size_t m = 0; m < used.size(); ++m) {
      numbers[m] = groups_.materials.size();
      used[m] = used[m] && !material_->info.names[m].empty();
      if (used[m]) groups_.materials.push_back(material_->info.names[m]);
    }
    return numbers;
  }

  void give_vertices() {
    auto& objects = groups_.objects;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;  // least and largest vertex
    for (const Object& object : objects) {
      const auto begin = groups_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * object.parts.front().first);
      const Part& last = object.parts.back();
      const auto end = groups_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * (last.first + last.count));
      const auto [least, most] = std::minmax_element(begin, end);
      ranges.emplace_back(*least, *most);
    }
    std::vector<std::size_t> order(objects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ranges[a] < ranges[b]; });
    bool apart = true;
    for (std::size_t i = 1; i < order.size(); ++i) apart &= ranges[order[i - 1]].second < ranges[order[i]].first;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool ends = !apart || i + 1 == order.size();
      Object& object = objects[order[i]];
      object.first = apart && i ? ranges[order[i]].first : 0;
      object.count = (ends ? vertex_count_ : ranges[order[i + 1]].first) - object.first;
    }
    if (!apart) return;
    std::vector<Object> sorted;
    for (const std::size_t i : order) sorted.push_back(std::move(objects[i]));
    objects = std::move(sorted);
  }

  std::span<const std::uint32_t> corners_;
  std::size_t vertex_count_;
  const AttributeView *object_, *material_;
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> part_of_;
  std::vector<std::pair<std::size_t, std::size_t>> keys_;
  std::vector<std::size_t> counts_, firsts_;
  std::uint32_t last_ = 0;
  Groups groups_;
};

}  // namespace

Groups group_faces(const MeshOutput& mesh, const Vertices& vertices, const AttributeView* objects,
                   const AttributeView* materials, DroppedCounter& dropped) {
  Grouper grouper(mesh, vertices, objects, materials);
  if (mesh.face_sizes.empty())
    return grouper.run(
        mesh.corners.size() / 3, [](std::size_t t) { return t; },
        [](std::size_t t, std::size_t k) { return 3 * t + k; });
  const Triangulation cut = triangulate(mesh.positions, mesh.corners, mesh.face_sizes);
  dropped.add("polygons (cut into triangles)", cut.polygons);
  return grouper.run(
      cut.corners.size(), [&](std::size_t t) { return std::size_t{cut.face[t]}; },
      [&](std::size_t t, std::size_t k) { return std::size_t{cut.corners[t][k]}; });
}

}  // namespace ramcdb::mesh_file::gltf
