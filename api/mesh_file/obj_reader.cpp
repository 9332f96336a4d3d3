#include <fmt/format.h>

#include "api/mesh_file/file_bytes.h"

/// Wavefront OBJ: `v` and `f` lines. A corner is v, v/t, v//n or v/t/n, counted from 1, or from the newest backwards.
namespace ramcdb::mesh_file {
namespace {

class ObjReader {
 public:
  ObjReader(const FileBytes& file, MeshData& mesh, const Progress& progress)
      : file_(file), scan_(file, 0, 0, progress), mesh_(mesh) {
    scan_.comment = '#';
  }

  void run() {
    while (scan_.next_line(true)) {
      const std::string_view keyword = scan_.word();
      if (keyword.empty()) continue;
      if (keyword == "v")
        read_vertex();
      else if (keyword == "f")
        read_face();
      else
        drop(keyword);
    }
    if (!mesh_.corners.empty() && largest_ >= mesh_.positions.size())
      throw bad_line(file_, largest_line_,
                     fmt::format("vertex index {} does not exist ({} vertices)", std::uint64_t{largest_} + 1,
                                 mesh_.positions.size()));
    dropped_.hand_over(mesh_);
  }

 private:
  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scan_.number("a coordinate");
    mesh_.positions.push_back(p);
    std::size_t extra = 0;
    while (!scan_.word().empty()) ++extra;
    if (extra >= 3) dropped_.add("vertex colours");
    if (extra == 1 || extra == 4) dropped_.add("vertex weights");
  }

  void read_face() {
    std::uint32_t corners = 0;
    for (std::string_view word; !(word = scan_.word()).empty(); ++corners) {
      // What follows a slash points into vt and vn lines, which are dropped by name.
      mesh_.corners.push_back(index(word.substr(0, word.find('/'))));
    }
    if (corners < 3) throw scan_.bad(fmt::format("a face has {} corners", corners));
    end_face(mesh_, corners);
  }

  std::uint32_t index(std::string_view word) {
    const std::int64_t i = scan_.parse_integer(word, "a vertex index");
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    const std::int64_t v = i < 0 ? count + i : i - 1;
    // Vertices may follow their faces, so that a large index is judged at the end of the file; a relative one is not.
    if (i == 0 || v < 0 || v > 0xfffffffd)
      throw scan_.bad(fmt::format("vertex index {} does not exist ({} vertices so far)", i, count));
    if (v > largest_ || !largest_line_) {
      largest_ = static_cast<std::uint32_t>(v);
      largest_line_ = scan_.line();
    }
    return static_cast<std::uint32_t>(v);
  }

  void drop(std::string_view keyword) {
    if (keyword == "vn")
      dropped_.add("normals (vn)");
    else if (keyword == "vt")
      dropped_.add("texture coordinates (vt)");
    else if (keyword == "usemtl" || keyword == "mtllib")
      dropped_.add(fmt::format("materials ({})", keyword));
    else if (keyword == "g" || keyword == "o")
      dropped_.add(fmt::format("groups ({})", keyword));
    else
      dropped_.add(fmt::format("'{}' lines", shown(keyword)));
  }

  const FileBytes& file_;
  TextScanner scan_;
  MeshData& mesh_;
  std::uint32_t largest_ = 0;  ///< vertex index so far, and where it stands
  std::size_t largest_line_ = 0;
  DroppedCounter dropped_;
};

}  // namespace

void read_obj(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  ObjReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
