#include <fmt/format.h>

#include <algorithm>

#include "api/mesh_file/file_bytes.h"

/// OFF and its prefixes: [ST][C][N][4][n]OFF, then counts of vertices, faces and edges, then a line per vertex and per
/// face. Behind the three coordinates stand normal, colour and texture coordinates, as the prefixes say, behind the
/// corners of a face its colour: 3 or 4 numbers, whole ones to 255 or others to 1. What else there is, is dropped by
/// name, and so are colours that only some have.
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

/// Values of vertices or faces that have equally many numbers, gathered one after another.
class Column {
 public:
  void begin() { size_ = 0; }
  void add(std::string_view word, double number) {
    values_.push_back(number);
    whole_ &= word.find_first_not_of("0123456789") == std::string_view::npos && number <= 255;
    ++size_;
  }
  /// Values of another length than the first one's are not kept at all.
  void end() {
    if (size_ == 0) return;
    ++count_;
    if (components_ == 0) components_ = size_;
    even_ &= size_ == components_;
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// False when not every one of `expected` has one.
  bool hand_over(MeshData& mesh, std::string name, AttributeOf of, Meaning meaning, std::size_t expected) {
    const bool is_color = meaning == Meaning::color;
    if (count_ != expected || !even_ || (is_color ? components_ < 3 || components_ > 4 : components_ > 4)) return false;
    if (is_color && components_ == 4) drop_full_alpha();
    Attribute attribute;
    attribute.info.name = std::move(name);
    attribute.info.of = of;
    attribute.info.type = is_color && whole_ ? NumberType::uint8 : NumberType::float64;
    attribute.info.components = static_cast<std::uint8_t>(components_);
    attribute.info.meaning = meaning;
    attribute.values = std::move(values_);
    mesh.attributes.push_back(std::move(attribute));
    return true;
  }

 private:
  /// An alpha that is 255 (or 1) everywhere is the format's, not the mesh's.
  void drop_full_alpha() {
    const double full = whole_ ? 255 : 1;
    for (std::size_t i = 3; i < values_.size(); i += 4)
      if (values_[i] != full) return;
    for (std::size_t i = 0; 4 * i < values_.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) values_[3 * i + k] = values_[4 * i + k];
    values_.resize(values_.size() / 4 * 3);
    components_ = 3;
  }

  std::vector<double> values_;
  std::size_t components_ = 0, size_ = 0;
  std::uint64_t count_ = 0;
  bool whole_ = true, even_ = true;
};

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
    const auto keep = [&](Column& column, const char* name, AttributeOf of, Meaning meaning, std::size_t expected,
                          const char* what) {
      if (column.count() && !column.hand_over(mesh_, name, of, meaning, expected)) dropped_.add(what, column.count());
    };
    keep(normals_, "normal", AttributeOf::vertex, Meaning::normal, vertices, "vertex normals");
    keep(colors_, "color", AttributeOf::vertex, Meaning::color, vertices, "vertex colours");
    keep(textures_, "texture", AttributeOf::vertex, Meaning::texture, vertices, "texture coordinates");
    keep(face_colors_, colors_.count() ? "face.color" : "color", AttributeOf::face, Meaning::color, faces,
         "face colours");
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
    std::string_view word = scan_.word();
    if (word.empty()) return;
    if (layout.normal) word = read_numbers(normals_, word, 3);
    if (layout.color) word = read_numbers(colors_, word, layout.texture ? 4 : 99);
    if (layout.texture) word = read_numbers(textures_, word, 99);
    if (word.empty()) return;
    while (!scan_.word().empty()) {
    }
    dropped_.add("further numbers behind vertices");
  }

  /// Up to `most` numbers of the line, from `word` on; returns the word behind them.
  std::string_view read_numbers(Column& column, std::string_view word, std::size_t most) {
    column.begin();
    for (std::size_t n = 0; n < most && !word.empty(); ++n, word = scan_.word())
      column.add(word, scan_.parse_number(word, "a number behind a vertex or face"));
    column.end();
    return word;
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
    const std::string_view word = scan_.word();
    if (!word.empty()) (void)read_numbers(face_colors_, word, 99);
  }

  TextScanner scan_;
  MeshData& mesh_;
  std::size_t size_;
  DroppedCounter dropped_;
  Column normals_, colors_, textures_, face_colors_;
};

}  // namespace

void read_off(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  OffReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
