#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "api/mesh_file/file_bytes.h"

/// What OFF files hold behind coordinates and corners.
namespace ramcdb::mesh_file {

/// Normals or texture coordinates of vertices, where lines have them.
class OffRows {
 public:
  explicit OffRows(std::uint8_t components) : components_(components) {}

  void set(const TextScanner& scan, std::size_t vertex, std::span<const std::string_view> words);
  /// Adds the attribute if a vertex has a value.
  void hand_over(std::string_view name, Meaning meaning, MeshData& mesh);

 private:
  std::uint8_t components_;
  std::vector<double> values_;  ///< as far as there are any
};

/// Colours of vertices or faces: three or four numbers, 0..255 where all are whole, else 0..1. In a file with both
/// kinds all become 0..1, and whole numbers up to 1 are taken for such.
class OffColors {
 public:
  void set(const TextScanner& scan, std::size_t i, std::span<const std::string_view> words);
  /// Adds the attribute for `count` vertices or faces if one has a colour. Colours without alpha are opaque.
  void hand_over(AttributeOf of, std::size_t count, MeshData& mesh, DroppedCounter& dropped);

 private:
  enum class Kind : std::uint8_t { none, whole_up_to_1, whole, fraction };
  static constexpr std::size_t kRow = 4;

  std::vector<double> values_;  ///< four each, as far as there are any; alpha is NaN where the line has none
  std::vector<Kind> kinds_;
  bool any_alpha_ = false, any_fraction_ = false;
  std::uint64_t wrong_ = 0;  ///< whole numbers beyond 0..255
};

}  // namespace ramcdb::mesh_file
