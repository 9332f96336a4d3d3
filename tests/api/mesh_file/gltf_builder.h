#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/api/mesh_file/files.h"

/// glTF files made by hand: JSON, and one buffer.
namespace ramcdb::test {

using Json = nlohmann::ordered_json;

enum ComponentType : int { kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126 };

class GltfBuilder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};

  /// Numbers as bytes of the type, as a view of their own; the index of the view.
  template <class T>
  std::size_t view(const std::vector<T>& values, std::size_t stride = 0) {
    std::string bytes;
    for (const T value : values) bytes += bytes_of(value);
    return view_of_bytes(bytes, stride);
  }
  std::size_t view_of_bytes(const std::string& bytes, std::size_t stride = 0);

  std::size_t accessor(std::size_t view, int type, const char* shape, std::size_t count);

  /// A view and its accessor: the numbers, so many a value.
  template <class T>
  std::size_t add(const std::vector<T>& values, int type, const char* shape) {
    const std::size_t count = values.size() / components(shape);
    return accessor(view(values), type, shape, count);
  }

  /// A mesh of one primitive, and a node with it.
  Json& add_mesh(Json primitive);

  [[nodiscard]] std::string glb() const;
  /// With the buffer in it, or in the file `uri`.
  [[nodiscard]] std::string gltf(const std::string& uri = {}) const;
  [[nodiscard]] const std::string& binary() const { return binary_; }

  static std::size_t components(std::string_view shape);

 private:
  std::string binary_;
};

/// A GLB of chunks as they are, without regard to what they say.
[[nodiscard]] std::string glb_of(const std::string& json_text, const std::string& binary);

[[nodiscard]] std::string base64(std::string_view bytes);

/// A square of four vertices and two triangles, without anything else: positions are accessor 0, indices 1.
[[nodiscard]] GltfBuilder gltf_square();

/// Two nodes, one of them moved and mirrored, on shared vertices, with all kinds of attributes, a strip, a sparse and
/// a strided accessor, materials and an image: 12 vertices, 6 faces.
[[nodiscard]] GltfBuilder gltf_sample();

}  // namespace ramcdb::test
