#pragma once

#include <cstdint>
#include <vector>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {

/// The `vt` or `vn` lines of a mesh and which of them each corner names: equal values are one line, in the order in
/// which corners first use them. The mirror of CornerTable.
class CornerLines {
 public:
  CornerLines() = default;
  /// Of an attribute of vertices or corners, with 2 or 3 components. Values of vertices without a face are counted.
  CornerLines(const AttributeView& attribute, const MeshOutput& mesh, DroppedCounter& dropped);

  [[nodiscard]] bool empty() const { return !attribute_; }
  void write(NewFile& out, std::string_view keyword) const;
  /// The line that the corner names, from 1; 0: none.
  [[nodiscard]] std::uint32_t line(std::size_t corner, std::uint32_t vertex) const {
    return lines_[attribute_->info.of == AttributeOf::corner ? corner : vertex];
  }

 private:
  const AttributeView* attribute_ = nullptr;
  std::vector<std::uint32_t> lines_;  ///< per corner or vertex
  std::vector<std::size_t> values_;   ///< per line the value that it shows
};

/// Names of faces as OBJ writes them, switched where they change. The mirror of NameSwitch.
class NameLines {
 public:
  NameLines(const AttributeView& attribute, std::string_view keyword, DroppedCounter& dropped);
  void write(NewFile& out, std::size_t face);

 private:
  const AttributeView& attribute_;
  std::string_view keyword_;
  std::vector<std::string> names_;
  std::string_view current_;  ///< no name until the first line
};

}  // namespace ramcdb::mesh_file
