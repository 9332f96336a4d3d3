#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/mesh_file/file_bytes.h"

/// What an OBJ file says beside positions and faces.
namespace ramcdb::mesh_file::obj {

/// Values (vt or vn) and which of them the corners name.
class IndexedValues {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  IndexedValues(std::string name, Meaning meaning) : name_(std::move(name)), meaning_(meaning) {}

  void add(double x, double y, double z);
  [[nodiscard]] std::size_t count() const { return values_.size() / 3; }

  /// The value of the next corner, counted from 0, or none. Corners before the first one that names a value have none.
  void set_corner(std::size_t corner, std::uint32_t value, std::size_t line);

  /// Adds an attribute of vertices, where all corners of each vertex have the same value, else of corners. Throws for
  /// values that do not exist, unless the file has none. Counts in `dropped` what is of no use.
  void hand_over(const FileBytes& file, MeshData& mesh, DroppedCounter& dropped);

 private:
  [[nodiscard]] bool are_of_vertices(const MeshData& mesh) const;
  [[nodiscard]] bool equal(std::uint32_t a, std::uint32_t b) const;
  void check(const FileBytes& file) const;

  std::string name_;
  Meaning meaning_;
  std::vector<double> values_;  ///< three each
  std::vector<std::uint32_t> of_corner_;
  std::uint32_t largest_ = 0;
  std::size_t largest_line_ = 0;
};

/// A state that lines switch (usemtl, g, o, s): a number per face.
class FaceState {
 public:
  FaceState(std::string name, Meaning meaning) : name_(std::move(name)), meaning_(meaning) {}

  /// From now on faces have this name.
  void switch_to(std::string_view name, std::size_t faces_so_far);
  /// The same for a state that is a number.
  void switch_to(std::uint32_t number, std::size_t faces_so_far);
  void hand_over(MeshData& mesh);

 private:
  std::string name_;
  Meaning meaning_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  struct Run {
    std::size_t first_face;
    std::uint32_t value;
  };
  std::vector<Run> runs_;
};

}  // namespace ramcdb::mesh_file::obj
