#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/mesh_file/file_bytes.h"

/// What OBJ keeps beside vertices and faces: tables of values that corners point into, and switches between faces.
namespace ramcdb::mesh_file {

/// The `vt` or `vn` lines, and which of them each corner names.
class CornerTable {
 public:
  /// Lines of `least` to `most` (at most 3) numbers; `what` names them in messages, such as "normals (vn)".
  CornerTable(std::string_view what, std::size_t least, std::size_t most)
      : what_(what),
        index_(what_ + ": an index"),
        least_(least),
        most_(most),
        components_(most == 3 && least == 3 ? 3 : 2) {}

  /// Reads what is left of such a line. Numbers that are missing are 0; lines with more are counted.
  void read_line(TextScanner& scan);
  /// The word of the corner at this position of MeshData::corners, in their order; corners may be left out.
  void read_index(const TextScanner& scan, std::string_view word, std::size_t corner);

  /// Whether a corner names one of the lines.
  [[nodiscard]] bool used() const { return !indices_.empty(); }
  /// Adds the attribute, when a corner has a value: of vertices when all corners have one, and those of a vertex the
  /// same; else of corners. Values that no corner names, and corners that name none, are counted.
  void hand_over(std::string_view name, Meaning meaning, MeshData& mesh, DroppedCounter& dropped);

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  [[nodiscard]] std::size_t count() const { return values_.size() / 3; }
  [[nodiscard]] bool same(std::uint32_t a, std::uint32_t b) const;
  void check_indices(std::size_t corners, DroppedCounter& dropped);
  /// The index per vertex, or nothing when there is not one.
  [[nodiscard]] std::vector<std::uint32_t> per_vertex(const MeshData& mesh) const;
  [[nodiscard]] std::vector<double> gather(const std::vector<std::uint32_t>& indices) const;

  std::string what_, index_;  ///< in messages
  std::size_t least_, most_, components_;
  std::vector<double> values_;          ///< three each
  std::vector<std::uint32_t> indices_;  ///< per corner, as far as there are any
  std::uint64_t wrong_ = 0;             ///< corners with an index that cannot be
  std::uint64_t further_ = 0;           ///< lines with more numbers
};

/// A number that holds for all faces behind it.
class FaceSwitch {
 public:
  void set(std::uint32_t value, std::size_t faces_before);
  /// Per face its number; switches without a face are gone.
  [[nodiscard]] std::vector<double> values(std::size_t faces);
  [[nodiscard]] bool used() const { return set_; }
  /// Switches that no face came behind; known after values().
  [[nodiscard]] std::uint64_t unused() const { return unused_; }

 private:
  struct Run {
    std::size_t begin = 0;
    std::uint32_t value = 0;
    bool written = false;  ///< in the file
  };
  std::vector<Run> runs_{Run{}};
  bool set_ = false;
  std::uint64_t unused_ = 0;
};

/// A name that holds for all faces behind it; "" before the first.
class NameSwitch {
 public:
  [[nodiscard]] bool used() const { return newest_.has_value(); }
  void set(std::string_view name, std::size_t faces_before);
  /// Adds the attribute, unless all faces are without a name. `what` counts the lines that no face came behind.
  void hand_over(std::string_view name, Meaning meaning, std::string_view what, MeshData& mesh,
                 DroppedCounter& dropped);

 private:
  /// Takes the newest name in if a face came behind it.
  void settle(std::size_t faces);

  FaceSwitch switch_;
  std::unordered_map<std::string, std::uint32_t> known_{{"", 0}};  ///< looked up only
  std::vector<std::string> names_{""};
  std::optional<std::string> newest_;
  std::size_t newest_begin_ = 0;
  std::uint64_t unused_ = 0;
};

}  // namespace ramcdb::mesh_file
