#pragma once

#include <map>
#include <string>
#include <vector>

#include "api/mesh_file/gltf_buffers.h"
#include "api/mesh_file/gltf_transform.h"

/// Which vertices and faces a scene has, planned and counted before memory is taken for them.
namespace ramcdb::mesh_file::gltf {

/// A mesh in its place.
struct Instance {
  Index node = 0, mesh = 0;
  Index transform = 0;  ///< in Scene::transforms
  std::string name;     ///< of the node, else of the mesh; may be empty
};

/// Vertices that are one: those of a POSITION accessor. Primitives share them where their meshes have the same place
/// and their other attributes are the same accessors, or missing in one of both.
struct Block {
  Index position = 0, transform = 0;
  std::map<std::string, Index> attributes;  ///< accessor by name
  std::size_t first = 0, count = 0;         ///< vertices of the mesh that is read
};

/// A primitive in its place.
struct Piece {
  const Primitive* primitive = nullptr;
  Index instance = 0, block = 0;
  std::size_t indices = 0;  ///< or vertices where it has none
  std::size_t faces = 0;
  std::string name;  ///< "mesh 3 primitive 1"
};

struct Scene {
  std::vector<Transform> transforms;
  std::vector<Instance> instances;
  std::vector<Block> blocks;
  std::vector<Piece> pieces;
  std::size_t vertices = 0, faces = 0;
};

/// All accessors that it names are checked. Throws invalid_argument, for nodes that are not trees too.
[[nodiscard]] Scene plan_scene(const FileBytes& file, const Document& document, Accessors& accessors,
                               DroppedCounter& dropped);

}  // namespace ramcdb::mesh_file::gltf
