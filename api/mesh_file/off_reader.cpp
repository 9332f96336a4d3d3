#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "api/mesh_file/off_values.h"

/// OFF and its prefixes: [ST][C][N]OFF, then counts of vertices, faces and edges, then a line per vertex and per face.
/// Behind its coordinates a vertex has a normal, a colour and texture coordinates, as the prefixes say; behind its
/// corners a face may have a colour.
namespace ramcdb::mesh_file {
namespace {

struct Layout {
  bool texture = false, color = false, normal = false;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

Layout parse_keyword(const TextScanner& scan, std::string_view keyword) {
  Layout layout;
  std::string_view prefix = keyword.substr(0, keyword.size() - 3);
  if (prefix.substr(0, 2) == "ST") {
    layout.texture = true;
    prefix.remove_prefix(2);
  }
  for (const char c : prefix) {
    if (c == 'C')
      layout.color = true;
    else if (c == 'N')
      layout.normal = true;
    else
      throw scan.bad(fmt::format("'{}' is a kind of OFF that is not read", shown(keyword)));
  }
  return layout;
}

class OffReader {
 public:
  OffReader(const FileBytes& file, MeshData& mesh, const Progress& progress)
      : file_(file), scan_(file, 0, 0, progress), mesh_(mesh), size_(file.text().size()) {
    scan_.comment = '#';
  }

  void run() {
    std::string_view first = scan_.word_anywhere();
    Layout layout;
    if (first.size() >= 3 && first.substr(first.size() - 3) == "OFF") {
      layout = parse_keyword(scan_, first);
      first = scan_.word_anywhere();
      if (first == "BINARY") {
        if (layout.texture || layout.color || layout.normal)
          throw scan_.bad("binary OFF with colours, normals or texture coordinates of vertices is not read");
        return read_binary_off(file_, scan_.offset(), mesh_);
      }
    } else if (first.starts_with("OFF") && is_digit(first[3])) {
      first.remove_prefix(3);  // "OFF490 518 0", as a well-known data set has it
    } else if (!first.empty() && !is_digit(first[0]) && first[0] != '-' && first[0] != '+') {
      throw scan_.bad(fmt::format("this is not OFF: it begins with '{}'", shown(first)));
    }
    const std::size_t vertices = count(scan_.parse_integer(first, "the number of vertices"), 6, "vertices");
    const std::size_t faces = count(scan_.integer_anywhere("the number of faces"), 2, "faces");
    (void)scan_.word();  // the number of edges, which nobody needs and some leave out
    mesh_.positions.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) read_vertex(layout, v);
    mesh_.corners.reserve(3 * faces);
    for (std::size_t f = 0; f < faces; ++f) read_face(vertices, f);
    if (!scan_.word_anywhere().empty()) dropped_.add("text behind the last face");
    hand_over(faces);
  }

 private:
  /// A count that the file is long enough for: so many bytes each, at least.
  std::size_t count(std::int64_t n, std::size_t bytes_each, std::string_view what) const {
    if (n < 0) throw scan_.bad(fmt::format("the number of {} is negative: {}", what, n));
    if (static_cast<std::uint64_t>(n) > size_ / bytes_each + 1)
      throw scan_.bad(fmt::format("the file is too short for {} {}", n, what));
    return static_cast<std::size_t>(n);
  }

  /// What is left of the line, its first kMostWords in words_.
  std::size_t read_words() {
    std::size_t n = 0;
    for (std::string_view word; !(word = scan_.word()).empty(); ++n)
      if (n < kMostWords) words_[n] = word;
    return n;
  }

  void read_vertex(const Layout& layout, std::size_t v) {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scan_.number_anywhere("a coordinate");
    mesh_.positions.push_back(p);
    const std::size_t n = read_words();
    if (n == 0) return;
    const std::size_t normal = layout.normal ? kNormal : 0, texture = layout.texture ? kTexture : 0;
    const std::size_t color = n - std::min(n, normal + texture);
    const bool fits = layout.color ? color == kRgb || color == kRgba : n == normal + texture;
    if (!fits) return dropped_.add("vertices with more or fewer numbers than the file's first word says");
    const std::span<const std::string_view> words(words_);
    if (normal) normals_.set(scan_, v, words.first(normal));
    if (color) colors_.set(scan_, v, words.subspan(normal, color));
    if (texture) textures_.set(scan_, v, words.subspan(normal + color, texture));
  }

  void read_face(std::size_t vertices, std::size_t f) {
    const std::int64_t corners = scan_.integer_anywhere("the number of corners of a face");
    if (corners < 3) throw scan_.bad(fmt::format("a face has {} corners", corners));
    if (static_cast<std::uint64_t>(corners) > size_) throw scan_.bad("a face has more corners than the file has bytes");
    for (std::int64_t c = 0; c < corners; ++c) {
      const std::int64_t v = scan_.integer_anywhere("a vertex index");
      if (v < 0 || static_cast<std::uint64_t>(v) >= vertices)
        throw scan_.bad(fmt::format("vertex index {} does not exist ({} vertices)", v, vertices));
      mesh_.corners.push_back(static_cast<std::uint32_t>(v));
    }
    end_face(mesh_, static_cast<std::uint32_t>(corners));
    const std::size_t n = read_words();
    if (n == kRgb || n == kRgba)
      face_colors_.set(scan_, f, std::span<const std::string_view>(words_).first(n));
    else if (n == 1)
      dropped_.add("face colours that are numbers of a colour map");
    else if (n)
      dropped_.add("further numbers behind faces");
  }

  void hand_over(std::size_t faces) {
    colors_.hand_over(AttributeOf::vertex, mesh_.positions.size(), mesh_, dropped_);
    normals_.hand_over("normal", Meaning::normal, mesh_);
    textures_.hand_over("texture", Meaning::texture, mesh_);
    face_colors_.hand_over(AttributeOf::face, faces, mesh_, dropped_);
    mesh_.dropped = dropped_.take();
  }

  static constexpr std::size_t kNormal = 3, kTexture = 2, kRgb = 3, kRgba = 4;
  static constexpr std::size_t kMostWords = kNormal + kRgba + kTexture;

  const FileBytes& file_;
  TextScanner scan_;
  MeshData& mesh_;
  std::size_t size_;
  std::array<std::string_view, kMostWords> words_;
  OffRows normals_{kNormal}, textures_{kTexture};
  OffColors colors_, face_colors_;
  DroppedCounter dropped_;
};

}  // namespace

void read_off(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  OffReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
