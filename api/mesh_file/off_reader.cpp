#include <fmt/format.h>

#include <algorithm>

#include "api/mesh_file/file_bytes.h"

/// OFF and its prefixes: [ST][C][N][4][n]OFF, then counts of vertices, faces and edges, then a line per vertex and per
/// face. What follows the three coordinates, and the corners of a face, is dropped by name.
namespace ramcdb::mesh_file {
namespace {

struct Layout {
  bool texture = false, color = false, normal = false;
};

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
      : scan_(file, 0, 0, progress), mesh_(mesh), size_(file.text().size()) {
    scan_.comment = '#';
  }

  void run() {
    std::string_view first = scan_.word_anywhere();
    Layout layout;
    if (first.size() >= 3 && first.substr(first.size() - 3) == "OFF") {
      layout = parse_keyword(scan_, first);
      first = scan_.word_anywhere();
      if (first == "BINARY") throw scan_.bad("binary OFF is not read: convert it to text OFF or PLY");
    }
    const std::size_t vertices = count(scan_.parse_integer(first, "the number of vertices"), 6);
    const std::size_t faces = count(scan_.integer_anywhere("the number of faces"), 2);
    (void)scan_.word();  // the number of edges, which nobody needs and some leave out
    mesh_.positions.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) read_vertex(layout);
    mesh_.corners.reserve(3 * faces);
    for (std::size_t f = 0; f < faces; ++f) read_face(vertices);
    if (!scan_.word_anywhere().empty()) dropped_.add("text behind the last face");
    dropped_.hand_over(mesh_);
  }

 private:
  /// A count that the file is long enough for: so many bytes each, at least.
  std::size_t count(std::int64_t n, std::size_t bytes_each) const {
    if (n < 0 || static_cast<std::uint64_t>(n) > size_ / bytes_each + 1)
      throw scan_.bad(fmt::format("the file is too short for {} of what it announces", n));
    return static_cast<std::size_t>(n);
  }

  void read_vertex(const Layout& layout) {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scan_.number_anywhere("a coordinate");
    mesh_.positions.push_back(p);
    std::size_t extra = 0;
    while (!scan_.word().empty()) ++extra;
    if (extra == 0) return;
    if (layout.normal) dropped_.add("vertex normals");
    if (layout.color) dropped_.add("vertex colours");
    if (layout.texture) dropped_.add("texture coordinates");
    if (!layout.normal && !layout.color && !layout.texture) dropped_.add("further numbers behind vertices");
  }

  void read_face(std::size_t vertices) {
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
    std::size_t extra = 0;
    while (!scan_.word().empty()) ++extra;
    if (extra) dropped_.add("face colours");
  }

  TextScanner scan_;
  MeshData& mesh_;
  std::size_t size_;
  DroppedCounter dropped_;
};

}  // namespace

void read_off(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  OffReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
