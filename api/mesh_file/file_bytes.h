#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/error.h"

namespace ramcdb::mesh_file {

using Progress = std::function<void(double)>;

/// The bytes of a file, and what messages call it. They are read once, front to back.
class FileBytes {
 public:
  /// Maps a file for reading.
  explicit FileBytes(const std::filesystem::path& file);
  /// Bytes that are in memory already and outlive this.
  FileBytes(std::string_view bytes, std::string_view name) : name_(name), data_(bytes.data()), size_(bytes.size()) {}
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view text() const { return {data_, size_}; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
};

/// The error of a file that cannot be taken: WHAT (FILE:LINE or FILE, byte N): HOW TO GO ON.
[[nodiscard]] Error bad_line(const FileBytes& file, std::size_t line, std::string_view what);
[[nodiscard]] Error bad_byte(const FileBytes& file, std::size_t offset, std::string_view what);

/// A word of a file for messages and names: its first 40 bytes, what is not printable ASCII as \xNN.
[[nodiscard]] std::string shown(std::string_view word);

/// Vertices or faces that a piece holds.
inline constexpr std::size_t kPiece = 1 << 16;

/// One reader per format; `read_mesh` does the checks that all share. Those that take a sink read in pieces where there
/// is one.
void read_ply(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress);
void read_obj(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress);
void read_off(const FileBytes& file, MeshData& mesh, const Progress& progress);
/// What stands behind the line "OFF BINARY", from byte `offset` on.
void read_binary_off(const FileBytes& file, std::size_t offset, MeshData& mesh);
void read_stl(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress);
void read_gltf(const FileBytes& file, MeshData& mesh, const Progress& progress);

/// Faces of a PLY file by its header; of an STL file by its count, or about as many as its text has.
[[nodiscard]] std::uint64_t count_ply_faces(const FileBytes& file);
[[nodiscard]] std::uint64_t count_stl_faces(const FileBytes& file);

/// Ends a face of so many corners, which are there already. Sizes are kept from the first face on that is no triangle.
inline void end_face(MeshData& mesh, std::uint32_t corners) {
  if (mesh.face_sizes.empty()) {
    if (corners == 3) return;
    mesh.face_sizes.assign((mesh.corners.size() - corners) / 3, 3);
  }
  mesh.face_sizes.push_back(corners);
}

/// Walks text line by line and word by word, without locale and without copying. Lines end with LF or CR LF, or with CR
/// in a text without any LF.
class TextScanner {
 public:
  /// From byte `offset`, before which so many lines stand; 0 steps over a UTF-8 byte order mark.
  explicit TextScanner(const FileBytes& file, std::size_t offset = 0, std::size_t lines_before = 0,
                       const Progress& progress = {});

  /// Goes on to the next line; false at the end of the file. `continued`: a backslash at its end joins the next line,
  /// unless in a comment, which may well end with the name of a folder.
  bool next_line(bool continued = false);
  /// The next word of the line; empty at its end.
  std::string_view word();
  /// What is left of the line, blanks around it taken away.
  std::string_view rest();
  /// The next word, on whatever line it stands; empty at the end of the file.
  std::string_view word_anywhere();

  /// The next word as a number. Throws with the place.
  double number(std::string_view what);
  double number_anywhere(std::string_view what);
  std::int64_t integer(std::string_view what);
  std::int64_t integer_anywhere(std::string_view what);

  /// The next word as a number of this type: whole and in range for integers, the nearest for floats, where `nan` and
  /// `inf` are numbers too. Throws with the place.
  double value_anywhere(NumberType type) { return parse_value(word_anywhere(), type); }

  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::size_t offset() const { return at_; }
  /// Bytes not yet taken, those of the current line with them.
  [[nodiscard]] std::size_t left() const { return rest_.size() + file_.text().size() - at_; }
  [[nodiscard]] Error bad(std::string_view what) const { return bad_line(file_, line_, what); }
  /// What a word starts with that ends the line: the rest is a comment. 0: there are no comments.
  char comment = 0;

  double parse_number(std::string_view word, std::string_view what) const;
  std::int64_t parse_integer(std::string_view word, std::string_view what) const;
  double parse_value(std::string_view word, NumberType type) const;

 private:
  [[nodiscard]] bool has_comment(std::string_view piece) const;

  const FileBytes& file_;
  char line_end_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  std::string_view rest_;
  std::string joined_;
  Progress progress_;
};

/// Counts things by name, in the order in which they first came. A file may make up names: beyond kMostNames they are
/// counted together, so that neither time nor memory follow them.
class DroppedCounter {
 public:
  static constexpr std::size_t kMostNames = 64;

  void add(std::string_view what, std::uint64_t count = 1);
  [[nodiscard]] std::vector<Dropped> take();

 private:
  std::vector<Dropped> dropped_;
};

}  // namespace ramcdb::mesh_file
