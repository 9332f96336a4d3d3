#include <fmt/format.h>

#include "api/mesh_file/file_bytes.h"
#include "api/mesh_file/obj_attributes.h"

/// Wavefront OBJ: `v`, `vt`, `vn` and `f` lines, and what switches the state of the faces behind: usemtl, g, o, s. A
/// corner is v, v/t, v//n or v/t/n, counted from 1, or from the newest backwards.
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
      else if (keyword == "vt")
        read_texture();
      else if (keyword == "vn")
        read_normal();
      else
        read_state(keyword);
    }
    if (!mesh_.corners.empty() && largest_ >= mesh_.positions.size())
      throw bad_line(file_, largest_line_,
                     fmt::format("vertex index {} does not exist ({} vertices)", std::uint64_t{largest_} + 1,
                                 mesh_.positions.size()));
    hand_over();
  }

 private:
  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scan_.number("a coordinate");
    mesh_.positions.push_back(p);
    std::string_view word = scan_.word();
    if (word.empty()) return;
    double extra[4] = {};
    std::size_t count = 0;
    for (; !word.empty(); word = scan_.word(), ++count)
      if (count < 4) extra[count] = scan_.parse_number(word, "a colour");
    if (count == 1 || count == 4) dropped_.add("vertex weights");
    if (count < 3) return;
    ++colored_;
    colors_.insert(colors_.end(), extra + (count == 4), extra + 3 + (count == 4));
  }

  void read_texture() {
    double value[3] = {scan_.number("a texture coordinate")};
    for (std::size_t k = 1; k < 3; ++k) {
      const std::string_view word = scan_.word();
      if (word.empty()) break;
      value[k] = scan_.parse_number(word, "a texture coordinate");
    }
    textures_.add(value[0], value[1], value[2]);
  }

  void read_normal() {
    double value[3];
    for (double& number : value) number = scan_.number("a normal");
    normals_.add(value[0], value[1], value[2]);
  }

  void read_face() {
    std::uint32_t corners = 0;
    for (std::string_view word; !(word = scan_.word()).empty(); ++corners) read_corner(word);
    if (corners < 3) throw scan_.bad(fmt::format("a face has {} corners", corners));
    end_face(mesh_, corners);
  }

  void read_corner(std::string_view word) {
    const std::size_t corner = mesh_.corners.size(), slash = word.find('/');
    mesh_.corners.push_back(vertex_index(word.substr(0, slash)));
    if (slash == std::string_view::npos) {
      textures_.set_corner(corner, obj::IndexedValues::kNone, 0);
      normals_.set_corner(corner, obj::IndexedValues::kNone, 0);
      return;
    }
    const std::string_view rest = word.substr(slash + 1);
    const std::size_t second = rest.find('/');
    textures_.set_corner(corner, value_index(rest.substr(0, second), textures_.count()), scan_.line());
    const std::string_view normal = second == std::string_view::npos ? std::string_view() : rest.substr(second + 1);
    normals_.set_corner(corner, value_index(normal, normals_.count()), scan_.line());
  }

  /// Vertices may follow their faces, so that a large index is judged at the end of the file; a relative one is not.
  std::uint32_t index(std::string_view word, std::size_t so_far, const char* what) {
    const std::int64_t i = scan_.parse_integer(word, what);
    const std::int64_t v = i < 0 ? static_cast<std::int64_t>(so_far) + i : i - 1;
    if (i == 0 || v < 0 || v > 0xfffffffd)
      throw scan_.bad(fmt::format("{} {} does not exist ({} so far)", what, i, so_far));
    return static_cast<std::uint32_t>(v);
  }

  std::uint32_t vertex_index(std::string_view word) {
    const std::uint32_t v = index(word, mesh_.positions.size(), "vertex index");
    if (v > largest_ || !largest_line_) {
      largest_ = v;
      largest_line_ = scan_.line();
    }
    return v;
  }

  std::uint32_t value_index(std::string_view word, std::size_t so_far) {
    if (word.empty()) return obj::IndexedValues::kNone;
    if (so_far == 0 && word[0] == '-') return 0;  // dangling, as in files without any values
    return index(word, so_far, "texture or normal index");
  }

  void read_state(std::string_view keyword) {
    const std::size_t faces = mesh_.face_count();
    if (keyword == "usemtl")
      materials_.switch_to(rest_of_line(), faces);
    else if (keyword == "g")
      groups_.switch_to(rest_of_line(), faces);
    else if (keyword == "o")
      objects_.switch_to(rest_of_line(), faces);
    else if (keyword == "s")
      read_smoothing(faces);
    else if (keyword == "mtllib")
      mesh_.references.push_back("mtllib " + rest_of_line());
    else
      dropped_.add(fmt::format("'{}' lines", shown(keyword)));
  }

  void read_smoothing(std::size_t faces) {
    const std::string_view word = scan_.word();
    const std::int64_t number = word == "off" || word.empty() ? 0 : scan_.parse_integer(word, "a smoothing group");
    if (number < 0 || number > 0xffffffff) throw scan_.bad(fmt::format("{} is no smoothing group", number));
    smoothing_.switch_to(static_cast<std::uint32_t>(number), faces);
  }

  std::string rest_of_line() {
    std::string rest;
    for (std::string_view word; !(word = scan_.word()).empty();) rest.append(rest.empty() ? "" : " ").append(word);
    return rest;
  }

  void hand_over() {
    if (colored_ == mesh_.positions.size() && colored_)
      mesh_.attributes.push_back(
          {{"color", AttributeOf::vertex, NumberType::float64, 3, Meaning::color, {}, {}}, std::move(colors_)});
    else if (colored_)
      dropped_.add("vertex colours, which not all vertices have", colored_);
    textures_.hand_over(file_, mesh_, dropped_);
    normals_.hand_over(file_, mesh_, dropped_);
    for (obj::FaceState* state : {&materials_, &groups_, &objects_, &smoothing_}) state->hand_over(mesh_);
    dropped_.hand_over(mesh_);
  }

  const FileBytes& file_;
  TextScanner scan_;
  MeshData& mesh_;
  std::uint32_t largest_ = 0;  ///< vertex index so far, and where it stands
  std::size_t largest_line_ = 0;
  std::size_t colored_ = 0;  ///< vertices with a colour
  std::vector<double> colors_;
  obj::IndexedValues textures_{"texture", Meaning::texture}, normals_{"normal", Meaning::normal};
  obj::FaceState materials_{"material", Meaning::material}, groups_{"group", Meaning::group},
      objects_{"object", Meaning::group}, smoothing_{"smoothing", Meaning::other};
  DroppedCounter dropped_;
};

}  // namespace

void read_obj(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  ObjReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
