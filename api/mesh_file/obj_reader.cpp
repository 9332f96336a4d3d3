#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/obj_tables.h"

/// Wavefront OBJ. A corner is v, v/t, v//n or v/t/n, counted from 1, or from the newest backwards. Kept: positions and
/// colours of `v`, faces, `vt`, `vn`, materials, groups, objects, smoothing, and the names of material libraries.
namespace ramcdb::mesh_file {
namespace {

class ObjReader {
 public:
  ObjReader(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress)
      : file_(file), scan_(file, 0, 0, progress), mesh_(mesh), sink_(sink) {
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
        textures_.read_line(scan_);
      else if (keyword == "vn")
        normals_.read_line(scan_);
      else
        read_other(keyword);
      if (sink_ && std::max(mesh_.positions.size(), mesh_.corners.size()) >= kPiece) hand_over_piece();
    }
    if (largest_line_ && largest_ >= vertices_)
      throw bad_line(
          file_, largest_line_,
          fmt::format("vertex index {} does not exist ({} vertices)", std::uint64_t{largest_} + 1, vertices_));
    if (sink_) hand_over_piece();
    hand_over();
  }

 private:
  void read_vertex() {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = scan_.number("a coordinate");
    mesh_.positions.push_back(p);
    ++vertices_;
    constexpr std::size_t kColor = 3;
    std::string_view words[kColor];
    std::size_t extra = 0;
    for (std::string_view word; !(word = scan_.word()).empty(); ++extra)
      if (extra < kColor) words[extra] = word;
    if (extra == kColor) return add_color(words);
    if (extra == kColor + 1) dropped_.add("vertex colours");
    if (extra == 1 || extra == kColor + 1)
      dropped_.add("vertex weights");
    else if (extra)
      dropped_.add("further numbers behind coordinates");
  }

  void add_color(const std::string_view (&words)[3]) {
    colors_.resize(3 * (vertices_ - 1), kNone);
    for (const std::string_view word : words) colors_.push_back(scan_.parse_value(word, NumberType::float64));
  }

  void read_face() {
    std::uint32_t corners = 0;
    for (std::string_view word; !(word = scan_.word()).empty(); ++corners) {
      const std::size_t slash = word.find('/');
      mesh_.corners.push_back(index(word.substr(0, slash)));
      ++corners_;
      if (slash != word.npos) read_indices(word.substr(slash + 1));
    }
    if (corners < 3) throw scan_.bad(fmt::format("a face has {} corners", corners));
    end_face(mesh_, corners);
    ++faces_;
  }

  /// "t", "t/n" or "/n" of the newest corner.
  void read_indices(std::string_view words) {
    const std::size_t corner = corners_ - 1, slash = words.find('/');
    if (const auto texture = words.substr(0, slash); !texture.empty()) textures_.read_index(scan_, texture, corner);
    if (slash == words.npos) return;
    const auto normal = words.substr(slash + 1);
    if (normal.find('/') != normal.npos)
      throw scan_.bad(fmt::format("a corner has more than three indices: it ends with '/{}'", shown(words)));
    if (!normal.empty()) normals_.read_index(scan_, normal, corner);
  }

  std::uint32_t index(std::string_view word) {
    const std::int64_t i = scan_.parse_integer(word, "a vertex index");
    const auto count = static_cast<std::int64_t>(vertices_);
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

  void read_other(std::string_view keyword) {
    if (keyword == "usemtl")
      materials_.set(scan_.rest(), faces_);
    else if (keyword == "g")
      groups_.set(scan_.rest(), faces_);
    else if (keyword == "o")
      objects_.set(scan_.rest(), faces_);
    else if (keyword == "s")
      read_smoothing(scan_.rest());
    else if (keyword == "mtllib")
      mesh_.references.push_back(fmt::format("mtllib {}", scan_.rest()));
    else
      dropped_.add(fmt::format("'{}' lines", shown(keyword)));
  }

  void read_smoothing(std::string_view group) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(group.data(), group.data() + group.size(), value);
    if (group == "off" || (error == std::errc() && end == group.data() + group.size()))
      smoothing_.set(value, faces_);
    else
      dropped_.add("'s' lines");
  }

  void hand_over_piece() {
    const bool has_attributes = !colors_.empty() || textures_.used() || normals_.used() || objects_.used() ||
                                groups_.used() || materials_.used() || smoothing_.used();
    if (has_attributes) throw NotInPieces("an OBJ file with more than vertices and faces", file_.name());
    sink_->take(mesh_);
  }

  void hand_over() {
    if (!colors_.empty()) {
      colors_.resize(3 * mesh_.positions.size(), kNone);
      add("color", AttributeOf::vertex, NumberType::float64, 3, Meaning::color).values = std::move(colors_);
    }
    textures_.hand_over("texture", Meaning::texture, mesh_, dropped_);
    normals_.hand_over("normal", Meaning::normal, mesh_, dropped_);
    objects_.hand_over("object", Meaning::group, "objects (o)", mesh_, dropped_);
    groups_.hand_over("group", Meaning::group, "groups (g)", mesh_, dropped_);
    materials_.hand_over("material", Meaning::material, "materials (usemtl)", mesh_, dropped_);
    if (smoothing_.used()) {
      add("smoothing", AttributeOf::face, NumberType::uint32, 1, Meaning::other).values = smoothing_.values(faces_);
      dropped_.add("'s' lines", smoothing_.unused());
    }
    mesh_.dropped = dropped_.take();
  }

  Attribute& add(std::string_view name, AttributeOf of, NumberType type, std::uint8_t components, Meaning meaning) {
    Attribute attribute;
    attribute.info.name = name;
    attribute.info.of = of;
    attribute.info.type = type;
    attribute.info.components = components;
    attribute.info.meaning = meaning;
    mesh_.attributes.push_back(std::move(attribute));
    return mesh_.attributes.back();
  }

  const FileBytes& file_;
  TextScanner scan_;
  MeshData& mesh_;
  MeshSink* sink_;
  std::size_t vertices_ = 0, corners_ = 0;
  std::uint32_t largest_ = 0;  ///< vertex index so far, and where it stands
  std::size_t largest_line_ = 0;
  std::size_t faces_ = 0;
  std::vector<double> colors_;  ///< three per vertex, as far as there are any
  CornerTable textures_{"texture coordinates (vt)", 1, 3}, normals_{"normals (vn)", 3, 3};
  NameSwitch materials_, groups_, objects_;
  FaceSwitch smoothing_;
  DroppedCounter dropped_;
};

}  // namespace

void read_obj(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress) {
  ObjReader(file, mesh, sink, progress).run();
}

}  // namespace ramcdb::mesh_file
