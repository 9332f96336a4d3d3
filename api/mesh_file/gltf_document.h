#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/mesh_file/file_bytes.h"
#include "ramcdb/attributes.h"

/// What a glTF file says of its geometry, as plain values, before any of it is looked up. Source: Khronos, glTF 2.0.
namespace ramcdb::mesh_file::gltf {

/// Indices into the lists of `Document`; read_document does not check them, whoever follows them does.
using Index = std::size_t;

struct Buffer {
  std::size_t length = 0;
  std::optional<std::string> uri;  ///< none: the binary chunk of a GLB
};

struct BufferView {
  Index buffer = 0;
  std::size_t offset = 0, length = 0;
  std::size_t stride = 0;  ///< 0: values stand close together
  bool compressed = false;
};

struct Sparse {
  std::size_t count = 0;
  Index indices_view = 0, values_view = 0;
  std::size_t indices_offset = 0, values_offset = 0;
  std::optional<NumberType> indices_type;
};

struct Accessor {
  std::optional<Index> view;  ///< none: zeros
  std::size_t offset = 0, count = 0;
  std::optional<NumberType> type;  ///< none: a type that is not known here
  std::size_t components = 0;      ///< 0: likewise
  bool is_matrix = false, normalized = false;
  std::optional<Sparse> sparse;
};

struct Primitive {
  std::uint64_t mode = 4;
  std::optional<Index> indices, material, position;
  std::vector<std::pair<std::string, Index>> attributes;  ///< but for POSITION, in order of names
  bool draco = false;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

/// Column after column, as in the file.
using Matrix = std::array<double, 16>;

struct Node {
  std::string name;
  Matrix matrix{};
  std::vector<Index> children;
  std::optional<Index> mesh;
  bool skinned = false;
};

struct Document {
  std::string_view binary;  ///< chunk of a GLB, of the file's bytes
  std::vector<Buffer> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Index> roots;            ///< nodes of the scene to read
  std::vector<std::string> materials;  ///< names, which may be empty or equal
  std::vector<std::string> references;
};

/// Reads the container and its JSON. What is not kept is counted. Throws invalid_argument with the place.
[[nodiscard]] Document read_document(const FileBytes& file, DroppedCounter& dropped);

/// WHAT (FILE, "accessor 3"): HOW TO GO ON.
[[nodiscard]] Error bad_part(const FileBytes& file, std::string_view part, std::string_view what);

/// The two parts of a GLB, or of a text file its bytes and nothing.
struct Container {
  std::string_view json, binary;
};
[[nodiscard]] Container open_container(const FileBytes& file, DroppedCounter& dropped);

}  // namespace ramcdb::mesh_file::gltf
