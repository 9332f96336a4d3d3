#include "api/mesh_file/gltf_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ramcdb::mesh_file::gltf {
namespace {

enum Mode : std::uint64_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kStrip, kFan };

/// Sums of counts stay far from overflow; read_mesh refuses what is beyond 2^32 - 2.
constexpr std::size_t kMostOfOne = 0xffffffff;

class ScenePlanner {
 public:
  ScenePlanner(const FileBytes& file, const Document& document, Accessors& accessors, DroppedCounter& dropped)
      : file_(file), document_(document), accessors_(accessors), dropped_(dropped) {}

  Scene run() {
    walk_nodes();
    for (Index i = 0; i < scene_.instances.size(); ++i) {
      const Mesh& mesh = document_.meshes[scene_.instances[i].mesh];
      ++copies_[{scene_.instances[i].transform, scene_.instances[i].mesh}];
      for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
        add_piece(i, mesh.primitives[p], fmt::format("mesh {} primitive {}", scene_.instances[i].mesh, p));
    }
    for (Block& block : scene_.blocks) {
      block.first = scene_.vertices;
      scene_.vertices += block.count;
    }
    count_unused();
    return std::move(scene_);
  }

 private:
  /// Parents before children, in the order of the file. A node that is met twice is refused, and with it every cycle.
  void walk_nodes() {
    struct Step {
      Index node;
      Matrix above;
    };
    std::vector<Step> todo;
    std::vector<bool> met(document_.nodes.size());
    const auto push = [&](const std::vector<Index>& nodes, const Matrix& above) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) todo.push_back({*node, above});
    };
    push(document_.roots, identity());
    while (!todo.empty()) {
      const auto [index, above] = todo.back();
      todo.pop_back();
      const std::string part = fmt::format("node {}", index);
      if (index >= met.size()) throw bad_part(file_, part, "there is no such node");
      if (met[index]) throw bad_part(file_, part, "the node is below itself or below two others");
      met[index] = true;
      const Node& node = document_.nodes[index];
      const Matrix matrix = above * node.matrix;
      if (!std::all_of(matrix.begin(), matrix.end(), [](double number) { return std::isfinite(number); }))
        throw bad_part(file_, part, "the transform is not finite");
      if (node.mesh) add_instance(index, node, matrix);
      push(node.children, matrix);
    }
    for (Index i = 0; i < met.size(); ++i)
      if (!met[i]) dropped_.add(fmt::format("node '{}' outside the scene", name_of(i)));
  }

  [[nodiscard]] std::string name_of(Index node) const {
    const std::string& name = document_.nodes[node].name;
    return name.empty() ? fmt::format("{}", node) : shown(name);
  }

  void add_instance(Index index, const Node& node, const Matrix& matrix) {
    if (*node.mesh >= document_.meshes.size())
      throw bad_part(file_, fmt::format("node {}", index),
                     fmt::format("names mesh {}, which does not exist", *node.mesh));
    // glTF places a skinned mesh by its skeleton alone; without one it is as it was made.
    const Matrix& place = node.skinned ? identity() : matrix;
    const auto [known, added] = transform_of_.emplace(place, scene_.transforms.size());
    if (added) scene_.transforms.emplace_back(place);
    const std::string& mesh_name = document_.meshes[*node.mesh].name;
    if (!node.name.empty() && !mesh_name.empty() && node.name != mesh_name)
      dropped_.add("names of meshes whose nodes have names");
    scene_.instances.push_back({index, *node.mesh, known->second, node.name.empty() ? mesh_name : node.name});
  }

  void add_piece(Index instance, const Primitive& primitive, std::string name) {
    if (primitive.mode > kFan) throw bad_part(file_, name, fmt::format("there is no mode {}", primitive.mode));
    if (!primitive.position) return dropped_.add("primitives without positions");
    const Accessor& position = accessors_.checked(*primitive.position);
    if (primitive.draco && !position.view)
      throw bad_part(file_, name,
                     "the mesh is compressed by KHR_draco_mesh_compression, which is not read; save it without");
    if (position.components != 3) throw bad_part(file_, name, "its positions do not have three numbers");
    check_count(position, name);
    for (const auto& [attribute, accessor] : primitive.attributes)
      if (const std::size_t count = accessors_.checked(accessor).count; count != position.count)
        throw bad_part(file_, name,
                       fmt::format("{} has {} values for {} vertices", shown(attribute), count, position.count));
    Piece piece{&primitive,     instance, block_of(instance, primitive, position.count),
                position.count, 0,        std::move(name)};
    if (primitive.indices) {
      const Accessor& indices = accessors_.checked(*primitive.indices);
      check_count(indices, piece.name);
      piece.indices = indices.count;
    }
    count_faces(piece);
    scene_.faces += piece.faces;
    scene_.pieces.push_back(std::move(piece));
  }

  void check_count(const Accessor& accessor, std::string_view part) const {
    if (accessor.count > kMostOfOne)
      throw bad_part(file_, part, fmt::format("{} values are more than a mesh can have", accessor.count));
  }

  void count_faces(Piece& piece) {
    const std::size_t n = piece.indices;
    switch (piece.primitive->mode) {
      case kPoints:
        return dropped_.add("points (their vertices are kept)", n);
      case kLines:
        return dropped_.add("lines (their vertices are kept)", n / 2);
      case kLineLoop:
        return dropped_.add("lines (their vertices are kept)", n);
      case kLineStrip:
        return dropped_.add("lines (their vertices are kept)", n ? n - 1 : 0);
      case kTriangles:
        piece.faces = n / 3;
        return dropped_.add("corners that make no whole triangle", n % 3);
      default:
        piece.faces = n < 3 ? 0 : n - 2;
    }
  }

  /// Blocks that were used last are looked at; a file with more of them on one accessor means no sharing.
  Index block_of(Index instance, const Primitive& primitive, std::size_t count) {
    constexpr std::size_t kMostLooks = 64;
    const Index transform = scene_.instances[instance].transform;
    auto& candidates =
        blocks_of_[{transform, copies_[{transform, scene_.instances[instance].mesh}], *primitive.position}];
    for (std::size_t i = 0; i < std::min(candidates.size(), kMostLooks); ++i) {
      Block& block = scene_.blocks[candidates[candidates.size() - 1 - i]];
      const bool fits =
          std::all_of(primitive.attributes.begin(), primitive.attributes.end(), [&](const auto& attribute) {
            const auto it = block.attributes.find(attribute.first);
            return it == block.attributes.end() || it->second == attribute.second;
          });
      if (!fits) continue;
      block.attributes.insert(primitive.attributes.begin(), primitive.attributes.end());
      return candidates[candidates.size() - 1 - i];
    }
    candidates.push_back(scene_.blocks.size());
    scene_.blocks.push_back(
        {*primitive.position, transform, {primitive.attributes.begin(), primitive.attributes.end()}, 0, count});
    return candidates.back();
  }

  void count_unused() {
    std::vector<bool> used(document_.meshes.size());
    for (const Instance& instance : scene_.instances) used[instance.mesh] = true;
    for (Index m = 0; m < used.size(); ++m)
      if (!used[m]) dropped_.add("meshes that no node of the scene has");
  }

  const FileBytes& file_;
  const Document& document_;
  Accessors& accessors_;
  DroppedCounter& dropped_;
  Scene scene_;
  std::map<Matrix, Index> transform_of_;
  std::map<std::pair<Index, Index>, std::size_t> copies_;  ///< of a mesh in one place
  std::map<std::array<std::size_t, 3>, std::vector<Index>> blocks_of_;
};

}  // namespace

Scene plan_scene(const FileBytes& file, const Document& document, Accessors& accessors, DroppedCounter& dropped) {
  return ScenePlanner(file, document, accessors, dropped).run();
}

}  // namespace ramcdb::mesh_file::gltf
