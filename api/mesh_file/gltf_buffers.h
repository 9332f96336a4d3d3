#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/mesh_file/gltf_document.h"

/// The bytes behind buffers and accessors. Nothing is taken from a file before it is checked to be there.
namespace ramcdb::mesh_file::gltf {

/// Bytes of buffers: the GLB's own, base64 in the file, or files beside it, which are opened when first asked for.
class Buffers {
 public:
  Buffers(const FileBytes& file, Document& document);

  /// Throws invalid_argument for a view that is not inside its buffer.
  [[nodiscard]] std::string_view view(Index view);

  /// Of files that were opened.
  [[nodiscard]] std::size_t bytes_beside() const;

 private:
  std::string_view buffer(Index buffer);
  std::string_view from_uri(Index buffer, const std::string& part);

  struct Source {
    bool known = false;
    std::string_view bytes;
    std::string decoded;
    std::unique_ptr<FileBytes> file;
  };
  const FileBytes& file_;
  Document& document_;
  std::vector<Source> sources_;
};

/// Values that stand at regular distances.
struct Strided {
  const char* at = nullptr;  ///< null: all are zero
  std::size_t stride = 0, count = 0;
};

/// Accessors, decoded. Errors name the accessor.
class Accessors {
 public:
  Accessors(const FileBytes& file, Document& document) : file_(file), document_(document), buffers_(file, document) {}

  /// The accessor, checked against its view and buffer, the index with it.
  const Accessor& checked(Index accessor);

  /// Writes `count * components` numbers to `to`: integers as they are, or where `unit`, those that are normalized as
  /// 0..1 or -1..1. The accessor is `checked`.
  void read(Index accessor, bool unit, double* to);
  void read_points(Index accessor, Point* to);
  /// Throws where an index is none of so many vertices; `where` names the primitive.
  [[nodiscard]] std::vector<std::uint32_t> indices(Index accessor, std::size_t vertices, std::string_view where);

  /// Of the file and of those that it was read from, so far.
  [[nodiscard]] std::size_t bytes_there() const { return file_.text().size() + buffers_.bytes_beside(); }

 private:
  [[nodiscard]] Strided dense(Index accessor);
  [[nodiscard]] Strided inside(std::string_view bytes, std::size_t offset, std::size_t count, std::size_t size,
                               std::size_t stride, std::string_view part) const;
  void check_sparse(Index accessor, const Sparse& sparse);
  [[nodiscard]] std::vector<std::uint32_t> sparse_places(Index accessor);

  const FileBytes& file_;
  Document& document_;
  Buffers buffers_;
};

/// The integer as the number that it stands for where normalized: c / 255, max(c / 127, -1) and so on.
[[nodiscard]] double unit_number(double value, NumberType type);

}  // namespace ramcdb::mesh_file::gltf
